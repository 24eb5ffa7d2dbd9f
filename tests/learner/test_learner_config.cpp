// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/learner/learner_node.hpp"

using namespace tread;
using namespace tread::learner;

namespace {

const std::string kPatterns =
    "patterns: " + std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml\n";

LearnerNodeConfig read(const std::string& text) {
  ConfigReader reader = ConfigReader::fromText(kPatterns + text, "learner.yaml");
  return readLearnerConfig(reader);
}

}  // namespace

TEST_CASE("a learner configuration needs only its patterns, the rest has defaults") {
  const LearnerNodeConfig config = read("");
  REQUIRE(config.shipped.content().name == "teodor");
  REQUIRE(config.rule.rule == "multi_model");
  REQUIRE(config.rule.memory == 0.5);
  REQUIRE(config.limits.max_gap_us == 300'000);
}

TEST_CASE("every key of a learner configuration is read") {
  const LearnerNodeConfig config = read(
      "rule: single\nmemory: 0.3\nsettle: 0.1\n"
      "scaling: {min_box: [0.1, 0.04, 0.06], max_factor: 1.5}\n"
      "gates: {max_gap: 0.5, max_speed: 2.0, entry_yaw_rate: 0.7}\n");
  REQUIRE(config.rule.rule == "single");
  REQUIRE(config.rule.memory == 0.3);
  REQUIRE(config.settle_us == 100'000);
  REQUIRE(config.rule.scaling.min_box[1] == 0.04);
  REQUIRE(config.rule.scaling.max_factor == 1.5);
  REQUIRE(config.limits.max_gap_us == 500'000);
  REQUIRE(config.limits.entry_yaw_rate == 0.7);
}

TEST_CASE("a mistyped key, rule or value of the learner is one line with file and line") {
  using Catch::StartsWith;
  REQUIRE_THROWS_WITH(read("memry: 0.3\n"), StartsWith("learner.yaml:2: unknown key memry"));
  REQUIRE_THROWS_WITH(read("rule: colective\n"), StartsWith("learner.yaml:2: "));
  REQUIRE_THROWS_WITH(read("memory: 1.0\n"), StartsWith("learner.yaml:2: "));
  // Below 20 ms the set would be sent faster than LCM can take it.
  REQUIRE_THROWS_WITH(read("period: 0.01\n"), StartsWith("learner.yaml:2: "));
}

TEST_CASE("the effective configuration is itself YAML and names the shipped set") {
  const std::string text = read("").effective();
  REQUIRE(text.find("shipped_set: teodor\n") == 0);
  REQUIRE_NOTHROW(ConfigReader::fromText(text, "effective"));
}
