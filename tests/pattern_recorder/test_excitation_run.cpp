// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/pattern/pattern_file.hpp"
#include "modules/pattern_recorder/core/recording_drive.hpp"
#include "tests/tools/robot/patterns/few_patterns.hpp"

using namespace tread;
using namespace tread::pattern_recorder;

namespace {

PatternSet shipped() {
  return readPatternFile(std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml");
}

/// Result of a drive that follows the predictions exactly.
struct Driven {
  std::vector<std::string> names;
  std::map<std::string, int> counts;
  double farthest = 0.0;
  std::string ends_in;
};

/// Drives until done, at most 2000 patterns.
Driven drivenBy(const PatternSet& set, double room, int executions, const Pose2& start = {}) {
  const ExcitationPlanner excitation(set, room);
  std::vector<int> needed(set.patterns().size(), executions);
  Pose2 T_home_body = start;
  Driven driven;
  driven.ends_in = excitation.standing();
  while (driven.names.size() < 2000) {
    const auto next = excitation.next(driven.ends_in, T_home_body, needed);
    if (!next) break;
    const MotionPattern& pattern = set.patterns()[*next];
    REQUIRE(pattern.entry_class == driven.ends_in);
    driven.names.push_back(pattern.name);
    ++driven.counts[pattern.name];
    --needed[*next];
    T_home_body = T_home_body * pattern.end();
    driven.farthest = std::max(driven.farthest, std::hypot(T_home_body.x, T_home_body.y));
    driven.ends_in = pattern.exit_class;
  }
  return driven;
}

}  // namespace

TEST_CASE(
    "An excitation run drives every shipped pattern often enough, stays near, and ends standing") {
  const PatternSet set = shipped();
  const Driven driven = drivenBy(set, 4.0, 10);
  for (const MotionPattern& pattern : set.patterns()) {
    INFO(pattern.name);
    CHECK(driven.counts.at(pattern.name) >= 10);
  }
  CHECK(driven.farthest < 4.0);
  CHECK(driven.ends_in == "rest");
  // Few patterns are driven without being recorded.
  CHECK(driven.names.size() < 250);
}

TEST_CASE("In an excitation run left and right take turns") {
  const Driven driven = drivenBy(shipped(), 6.0, 10);
  int balance = 0;
  for (const std::string& name : driven.names) {
    if (name == "hard_left") ++balance;
    if (name == "hard_right") --balance;
    CHECK(std::abs(balance) <= 3);
  }
}

TEST_CASE("An excitation run that began too far away leads back") {
  const Driven driven = drivenBy(shipped(), 4.0, 3, {7.0, 0.0, 0.0});
  CHECK(driven.farthest <= 7.7);
  CHECK(driven.counts.at("straight") >= 3);
}

TEST_CASE("An excitation run that stands just outside turns back, though turning leads farther") {
  // "Ahead" leads away, and each turn in place moves the vehicle by 2 cm.
  const auto ahead =
      tread::patterns::kit::pattern(1, "ahead", {0.5, 0.5}, {1.0, 0.0, 0.0}, "rest", "rest");
  const auto turn =
      tread::patterns::kit::pattern(2, "turn", {-0.5, 0.5}, {0.0, 0.02, 0.5 * kPi}, "rest", "rest");
  const auto start =
      tread::patterns::kit::pattern(3, "start", {0.5, 0.5}, {0.5, 0.0, 0.0}, "rest", "cruise");
  const auto stop =
      tread::patterns::kit::pattern(4, "stop", {0.0, 0.0}, {0.1, 0.0, 0.0}, "cruise", "rest");
  const PatternSet set = tread::patterns::kit::setOf({ahead, turn, start, stop}, true);
  const Driven driven = drivenBy(set, 4.0, 5, {0.0, 4.01, 0.0});
  CHECK(driven.counts.at("ahead") >= 5);
  CHECK(driven.farthest < 4.1);
}

TEST_CASE(
    "Where nothing that is needed fits into the room any more, an excitation run ends standing") {
  const Driven driven = drivenBy(tread::patterns::kit::withoutRight(), 5.0, 30);
  CHECK(driven.names.size() < 20);
  CHECK(driven.farthest <= 5.0);
  CHECK(driven.ends_in == "rest");
}

TEST_CASE("A set without a way from standing and back is refused") {
  const auto straight = tread::patterns::kit::pattern(1, "straight", {0.5, 0.5}, {0.5, 0.0, 0.0});
  CHECK_THROWS_WITH(ExcitationPlanner(tread::patterns::kit::setOf({straight}), 5.0),
                    Catch::Contains("stands still"));
  const auto start =
      tread::patterns::kit::pattern(2, "start", {0.5, 0.5}, {0.5, 0.0, 0.0}, "rest", "cruise");
  CHECK_THROWS_WITH(ExcitationPlanner(tread::patterns::kit::setOf({straight, start}, true), 5.0),
                    Catch::Contains("class 'cruise' of set 'few' cannot be left"));
  const auto stop =
      tread::patterns::kit::pattern(3, "stop", {0.0, 0.0}, {0.0, 0.0, 0.0}, "cruise", "rest");
  CHECK_THROWS_WITH(ExcitationPlanner(tread::patterns::kit::setOf({straight, stop}, true), 5.0),
                    Catch::Contains("class 'cruise' of set 'few' cannot be reached"));
}
