// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <string>

#include "modules/planner/planner_node.hpp"

using namespace tread;
using namespace tread::planner;

namespace {

/// As if it were next to the shipped files.
const std::string kHere = TREAD_SOURCE_DIR "/config/robots/teodor/planner.yaml";

}  // namespace

TEST_CASE("A configuration is read with its ranges, and mistakes are named at file and line") {
  ConfigReader good = ConfigReader::fromText(
      "search: {horizon: 6}\npolicy: {patience: 12}\nside_hysteresis: {gain: 2.5}\n", kHere);
  const PlannerConfig config = readPlannerConfig(good);
  CHECK(config.map.footprint.half_width == 0.415);
  CHECK(config.map.field.inflation == 0.415);
  CHECK(config.search.horizon == 6.0);
  CHECK(config.policy.patience == 12'000'000);
  CHECK(config.side_hysteresis.gain == 2.5);
  CHECK(config.effective.find("near_penalty") != std::string::npos);
  const auto refusal = [](const std::string& text) {
    ConfigReader reader = ConfigReader::fromText(text, kHere);
    try {
      readPlannerConfig(reader);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal("search: {horizn: 6}\n").find(kHere + ":1") == 0);
  CHECK(refusal("margins:\n  plan: -1\n").find(kHere + ":2") == 0);
  CHECK(refusal("margins:\n  check: 0.3\n").find("must not be more than plan") !=
        std::string::npos);
}

TEST_CASE("A short vehicle's patterns are checked at poses as close as it is short") {
  ConfigReader reader =
      ConfigReader::fromText("footprint: {front: 0.05, rear: 0.05, half_width: 0.05}\n", kHere);
  const PlannerConfig config = readPlannerConfig(reader);
  CHECK(config.sweep.distance < 0.05);
  CHECK(config.sweep.covered < 0.05);
  CHECK(config.search.frontier < 0.2);
  CHECK(config.map.field.wide < 0.1);
  const Margins& margins = config.map.margins;
  CHECK(config.sweep.outline.front == Approx(0.05 + std::max(margins.plan, margins.largest)));
}

TEST_CASE("In a log's CONFIG keys of older versions are ignored, in a file they are mistakes") {
  const std::string old = "search: {horizon: 6, cell: 0.2}\npolicy: {freeze: 0.2}\n";
  ConfigReader log = ConfigReader::fromText(old, kHere);
  CHECK(readLoggedPlannerConfig(log).search.horizon == 6.0);
  ConfigReader file = ConfigReader::fromText(old, kHere);
  CHECK_THROWS_AS(readPlannerConfig(file), ConfigError);
}
