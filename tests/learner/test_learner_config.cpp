// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <regex>
#include <sstream>

#include "common/config/scalars.hpp"
#include "modules/learner/learner_node.hpp"
#include "tests/helpers.hpp"
#include "tests/learner/rule_bench.hpp"

using namespace tread;
using namespace tread::learner;

namespace {

const std::string kPatterns =
    "patterns: " + std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml\n";

LearnerNodeConfig read(const std::string& text) {
  ConfigReader reader = ConfigReader::fromText(kPatterns + text, "learner.yaml");
  return readLearnerConfig(reader);
}

/// Values by key (SECTION.KEY); numbers in shortest form.
using Values = std::map<std::string, std::string>;

/// "[0.05, 2]" with nine digits, so that 0.2 and 0.19999999999999998 are equal.
std::string plain(const std::string& value) {
  static const std::regex kNumber("[-+0-9.e]+");
  std::string text;
  auto rest = value.begin();
  for (std::sregex_iterator number(value.begin(), value.end(), kNumber), end; number != end;
       ++number) {
    text.append(rest, (*number)[0].first);
    const std::optional<double> parsed = parseNumber(number->str());
    std::ostringstream digits;
    digits.precision(9);
    if (parsed)
      digits << *parsed;
    else
      digits << number->str();
    text += digits.str();
    rest = (*number)[0].second;
  }
  return text.append(rest, value.end());
}

/// Keys that the program reads, with defaults.
Values readKeys() {
  Values values;
  std::istringstream lines(read("").effective());
  static const std::regex kLine("( *)([a-z_]+):(?: (.*))?");
  std::string section;
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    REQUIRE(std::regex_match(line, match, kLine));
    if (match[1].length() == 0) section.clear();
    if (!match[3].matched)
      section = match[2].str() + ".";
    else if (match[2].str().rfind("shipped_", 0) != 0 || !section.empty())
      values[section + match[2].str()] = plain(match[3]);
  }
  return values;
}

/// Keys in the manual's tables, one per section.
Values writtenKeys() {
  Values values;
  std::istringstream lines(
      tread::testing::contentOf(std::string(TREAD_SOURCE_DIR) + "/modules/learner/keys.md"));
  static const std::regex kRow(R"(\| `([a-z_]+)` \| ([^|]*) \| ([^|]*) ?\| [^|]+ \|)");
  static const std::regex kHeading("## ([a-z]+):.*");
  std::string section;
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, match, kHeading)) section = match[1].str() + ".";
    if (!std::regex_match(line, match, kRow)) continue;
    CAPTURE(line);
    CHECK(values.emplace(section + match[1].str(), plain(match[2])).second);
  }
  // File names have no default.
  CHECK(values.erase("patterns") + values.erase("robot") == 2);
  return values;
}

/// All predictions of a rule after executions with a different gain and a turn.
std::vector<double> learned(const RuleConfig& config) {
  learner::samples::Pupil pupil(config, learner::samples::smallSet());
  for (const double gain : {0.8, 0.7, 0.75})
    for (size_t p = 0; p < 3; ++p) {
      std::vector<Pose2> measured = pupil.shipped(p);
      for (Pose2& pose : measured) pose = {gain * pose.x, gain * pose.y, 0.6 * gain * pose.yaw};
      pupil.learn(p, measured);
    }
  return pupil.everything();
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
  // Below 20 ms the set would be sent faster than LCM can handle it.
  REQUIRE_THROWS_WITH(read("period: 0.01\n"), StartsWith("learner.yaml:2: "));
}

TEST_CASE("the manual of the learner's keys names each key that is read, with its default") {
  const Values read = readKeys(), written = writtenKeys();
  CHECK(read.size() > 45);
  for (const auto& [key, value] : read) {
    CAPTURE(key);
    const bool there = written.count(key) == 1;
    CHECK(there);
    if (there) CHECK(written.at(key) == value);
  }
  for (const auto& [key, value] : written) {
    CAPTURE(key);
    CHECK(read.count(key) == 1);
  }
}

TEST_CASE("a rule reads the keys that it is said to read, and no other ones") {
  for (const Rule& rule : ruleNames()) {
    RuleConfig config = learner::samples::ruleConfig(rule);
    const std::vector<double> usual = learned(config);
    std::map<std::string, RuleConfig> changed{{"memory", config}, {"scaling", config}};
    changed["ground"] = config;
    changed["memory"].memory = 0.9;
    changed["scaling"].scaling.min_factor = 0.95;
    changed["ground"].ground.noise.forward = 0.2;
    const std::vector<std::string> keys = keysReadBy(rule);
    for (const auto& [key, other] : changed) {
      CAPTURE(rule, key);
      const bool said = std::find(keys.begin(), keys.end(), key) != keys.end();
      CHECK((learned(other) != usual) == said);
    }
  }
}

TEST_CASE("a key that the rule does not read is a warning that names the rules that would") {
  CHECK(read("rule: single\nmemory: 0.3\n").warnings.empty());
  CHECK(read("rule: collective\nscaling: {max_factor: 1.5}\n").warnings.empty());
  CHECK(read("").warnings.empty());
  const std::vector<std::string> lines =
      read("rule: single\nmemory: 0.3\nground: {sure: 0.8}\nscaling: {max_factor: 1.5}\n").warnings;
  REQUIRE(lines.size() == 2);
  CHECK(lines[0] ==
        "learner.yaml:5: scaling: rule single does not read it, collective, telescoping would; "
        "take it out");
  CHECK_THAT(lines[1], Catch::StartsWith("learner.yaml:4: ground: rule single does not read it, "));
  CHECK(read("rule: off\nmemory: 0.3\n").warnings.size() == 1);
}

TEST_CASE("a key of an earlier version is read without effect, and a warning says so") {
  const std::string retired = "scaling: {min_turn: 0.05}\nground: {recorded: 0.2, far: 3.0}\n";
  const auto config = read("rule: collective\n" + retired);
  CHECK(config.effective() == read("rule: collective\nscaling: {}\nground: {}\n").effective());
  REQUIRE(config.warnings.size() == 4);
  CHECK(config.warnings[1] ==
        "learner.yaml:3: scaling.min_turn: has no effect any more; take it out");
  CHECK_THROWS_WITH(read("scaling: {min_turns: 0.05}\n"), !Catch::Contains("is min_turn meant"));
}

TEST_CASE("the effective configuration is itself YAML and names the shipped set") {
  const std::string text = read("").effective();
  REQUIRE(text.find("shipped_set: teodor\n") == 0);
  REQUIRE_NOTHROW(ConfigReader::fromText(text, "effective"));
}
