// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/pattern/pattern_file.hpp"
#include "tests/common/pattern/pattern_samples.hpp"

using namespace tread;
using tread::testing::goodContent;

namespace {

const std::string kGood =
    "name: tiny\n"                 // 1
    "kind: power\n"                // 2
    "period_us: 50000\n"           // 3
    "classes:\n"                   // 4
    "  - name: rest\n"             // 5
    "    twist: [0, 0, 0]\n"       // 6
    "    steady: [0, 0]\n"         // 7
    "patterns:\n"                  // 8
    "  - id: 1\n"                  // 9
    "    name: step\n"             // 10
    "    entry: rest\n"            // 11
    "    exit: rest\n"             // 12
    "    commands:\n"              // 13
    "      - [0.5, 0.5, 2]\n"      // 14
    "      - [0, 0, 1]\n"          // 15
    "    trajectory:\n"            // 16
    "      - [0.01, 0, 0]\n"       // 17
    "      - [0.02, 0, 0]\n"       // 18
    "      - [0.03, 0, 0.001]\n";  // 19

std::string errorOf(const std::string& text) {
  try {
    parsePatterns(text, "tiny.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

/// The valid file with one text replaced.
std::string with(const std::string& piece, const std::string& replacement) {
  std::string text = kGood;
  const size_t at = text.find(piece);
  REQUIRE(at != std::string::npos);
  return text.replace(at, piece.size(), replacement);
}

void expectError(const std::string& text, const std::string& place, const std::string& part) {
  const std::string message = errorOf(text);
  INFO(message);
  CHECK(message.find("tiny.yaml:" + place + ": ") == 0);
  CHECK(message.find(part) != std::string::npos);
  CHECK(message.find('\n') == std::string::npos);
}

PatternSetContent awkwardContent(unsigned seed) {
  PatternSetContent content = goodContent();
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  std::uniform_real_distribution<double> tiny(-0.01, 0.01);
  content.name = "true";
  content.version = std::numeric_limits<int64_t>::max();
  content.patterns[0].name = "a: #b, {c} [d]";
  content.patterns[0].commands[0] = {-0.0, 0.0};
  content.patterns[0].commands[1] = {0.0, -0.0};
  content.patterns[0].trajectory[0] = {-0.0, std::numeric_limits<double>::denorm_min(), 1e-300};
  for (Command& command : content.patterns[1].commands) command = {share(random), share(random)};
  for (Pose2& pose : content.patterns[1].trajectory)
    pose = {tiny(random), tiny(random), tiny(random) * 1e-9};
  content.patterns[1].end_covariance[1] = -std::numeric_limits<double>::max();
  return content;
}

bool sameBits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

TEST_CASE("A pattern file comes back bit for bit") {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    std::string why;
    const auto set = PatternSet::make(awkwardContent(seed), why);
    INFO(why);
    REQUIRE(set.has_value());
    const std::string text = formatPatterns(*set);
    const PatternSet again = parsePatterns(text, "again.yaml");
    CHECK(again.checksum() == set->checksum());
    CHECK(again.content().utime == set->content().utime);
    CHECK(formatPatterns(again) == text);
    for (size_t i = 0; i < set->patterns()[1].trajectory.size(); ++i)
      CHECK(sameBits(again.patterns()[1].trajectory[i].yaw, set->patterns()[1].trajectory[i].yaw));
  }
}

TEST_CASE("Commands are written in runs: left, right, samples") {
  const PatternSet set = parsePatterns(kGood, "tiny.yaml");
  REQUIRE(set.patterns()[0].commands.size() == 3);
  CHECK(set.patterns()[0].commands[1][0] == 0.5);
  CHECK(set.patterns()[0].commands[2][0] == 0.0);
  const std::string text = formatPatterns(set);
  CHECK(text.find("- [0.5, 0.5, 2]\n      - [0, 0, 1]\n") != std::string::npos);
}

TEST_CASE("What a file does not say has a plain default") {
  const PatternSet set = parsePatterns(kGood, "tiny.yaml");
  CHECK(set.version() == 1);
  CHECK(set.content().parent_version == 0);
  CHECK(set.patterns()[0].times_learned == 0);
  CHECK(std::isnan(set.patterns()[0].end_covariance[5]));
}

TEST_CASE("Bad pattern files are refused with file, line and what is allowed") {
  expectError(with("    entry:", "    entri:"), "9", "is entri meant");
  expectError(with("    entry:", "    speed: 1\n    entry:"), "11", "speed");
  expectError(with("period_us: 50000", "period_us: 50000\nspeed: 3"), "4", "speed");
  expectError(with("      - [0.03, 0, 0.001]\n", ""), "16", "3 commands but 2 poses");
  expectError(with("0.001]", ".nan]"), "19", "nan");
  expectError(with("[0.02, 0, 0]", "[0.02, 0]"), "18", "2 numbers");
  expectError(with("[0.5, 0.5, 2]", "[0.5, 1.5, 2]"), "13", "command 1.5");
  expectError(with("[0.5, 0.5, 2]", "[0.5, 0.5, 1.5]"), "13", "held for 1.5 samples");
  expectError(with("[0.5, 0.5, 2]", "[0.5, 0.5, 0]"), "13", "held for 0 samples");
  expectError(with("[0.5, 0.5, 2]", "[0.5, 0.5, 1e9]"), "13", "held for");
  expectError(with("kind: power", "kind: speed"), "2", "track_speed");
  expectError(with("exit: rest", "exit: cruise"), "12", "'cruise' is not in the set");
  expectError(with("period_us: 50000", "period_us: 50"), "3", "5000 to 1000000");
  expectError(with("[0.01, 0, 0]", "[9, 0, 0]"), "16", "jumps");
  expectError(with("    steady: [0, 0]\n", ""), "5", "steady");
  expectError(with("name: tiny", "name: [tiny"), "2", "");
}

TEST_CASE("A pattern file that is not there is one clear line") {
  CHECK_THROWS_AS(readPatternFile("no/such/file.yaml"), ConfigError);
}
