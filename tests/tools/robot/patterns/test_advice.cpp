// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/pattern/pattern_file.hpp"
#include "tests/tools/robot/patterns/few_patterns.hpp"
#include "tests/tools/robot/patterns/patterns_program.hpp"
#include "tools/robot/patterns/set_text.hpp"

using namespace tread;
using namespace tread::patterns;

namespace {

using kit::shipped;

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace

TEST_CASE("The shipped patterns need no advice") {
  CHECK(joined(adviceFor(shipped())) == "");
}

TEST_CASE("Advice: a turn without its mirror image") {
  CHECK(joined(adviceFor(kit::setOf(
            {kit::pattern(1, "left", {0.4, 0.5}, {0.5, 0.0, 0.1}),
             kit::pattern(2, "start", {0.5, 0.5}, {0.5, 0.0, 0.0}, "rest", "cruise"),
             kit::pattern(3, "stop", {0.0, 0.0}, {0.0, 0.0, 0.0}, "cruise", "rest")},
            true))) == "pattern 'left' has no mirror image; add it with tread-patterns mirror\n");
}

TEST_CASE("Advice: a class that nobody stands in, reaches or leaves") {
  const auto straight = kit::pattern(1, "straight", {0.5, 0.5}, {0.5, 0.0, 0.0});
  CHECK(joined(adviceFor(kit::setOf({straight}))).find("no class stands still") == 0);
  const auto start = kit::pattern(2, "start", {0.5, 0.5}, {0.5, 0.0, 0.0}, "rest", "cruise");
  CHECK(joined(adviceFor(kit::setOf({straight, start}, true)))
            .find("class 'cruise' cannot be left") == 0);
  const auto stop = kit::pattern(3, "stop", {0.0, 0.0}, {0.0, 0.0, 0.0}, "cruise", "rest");
  CHECK(joined(adviceFor(kit::setOf({straight, stop}, true)))
            .find("class 'cruise' cannot be reached") == 0);
}

TEST_CASE("Advice: a trajectory that does not end in its exit class's twist") {
  auto fast = kit::pattern(1, "fast", {0.5, 0.5}, {0.7, 0.0, 0.0});
  const std::string advice = joined(adviceFor(kit::setOf({fast})));
  CHECK(advice.find("pattern 'fast' ends with 0.70 m/s") != std::string::npos);
}

TEST_CASE("Advice: end covariances that nobody knows") {
  auto straight = kit::pattern(1, "straight", {0.5, 0.5}, {0.5, 0.0, 0.0});
  auto other = kit::pattern(2, "other", {0.5, 0.5}, {0.5, 0.0, 0.0});
  other.end_covariance = kUnknownCovariance;
  CHECK(
      joined(adviceFor(kit::setOf({straight, other}))).find("unknown end covariance of 'other'") !=
      std::string::npos);
}

TEST_CASE("Two sets are compared by name, and the words name the pattern that differs most") {
  const PatternSet a = kit::withoutRight();
  PatternSetContent content = a.content();
  content.patterns[0].trajectory.back().x += 0.02;
  content.patterns[1].trajectory.back().yaw += 0.1;
  content.patterns[2].commands[0] = {0.4, 0.4};
  content.patterns[2].trajectory.back().x += 0.05;
  content.patterns[3].name = "halt";
  std::string why;
  const PatternSet b = *PatternSet::make(content, why);
  const std::string text = comparison(a, "a.yaml", b, "b.yaml");
  INFO(text);
  CHECK(text.find("position differs most in 'start': b ends 0.050 m from a") != std::string::npos);
  CHECK(text.find("heading differs most in 'left': a turns 5.7 deg, b 11.5 deg") !=
        std::string::npos);
  CHECK(text.find("'start' has other commands") != std::string::npos);
  CHECK(text.find("'stop' is only in a.yaml") != std::string::npos);
  CHECK(text.find("'halt' is only in b.yaml") != std::string::npos);
  CHECK(comparison(a, "a", a, "a").find("Both predict the same ends") != std::string::npos);
}
