// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/tools/robot/patterns/patterns_program.hpp"
#include "tools/robot/patterns/recipe.hpp"

using namespace tread;

namespace {

using patterns::kit::kConfigFolder;
using patterns::kit::shipped;

std::set<std::string> reachableFrom(const std::string& first) {
  std::set<std::string> reached{first};
  for (size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const MotionPattern& pattern : shipped().patterns())
      if (reached.count(pattern.entry_class) > 0) reached.insert(pattern.exit_class);
  }
  return reached;
}

double secondsHeldAtEnd(const MotionPattern& pattern) {
  const Command steady = shipped().classNamed(pattern.exit_class).steady;
  size_t held = 0;
  for (size_t i = pattern.commands.size(); i > 0; --i, ++held)
    if (pattern.commands[i - 1] != steady) break;
  return static_cast<double>(held) * shipped().periodSeconds();
}

}  // namespace

TEST_CASE("The shipped patterns are what the recipe and the tarmac model make") {
  const PatternSet made =
      patterns::makeSet(ConfigReader::fromFile(kConfigFolder + "patterns/recipes/teodor.yaml"),
                        readModelFile(kConfigFolder + "models/teodor_tarmac.yaml"));
  std::ifstream file(kConfigFolder + "patterns/teodor.yaml");
  std::ostringstream text;
  text << file.rdbuf();
  CHECK(formatPatterns(made) == text.str());
}

TEST_CASE("Each shipped pattern holds its exit class's command for half a second at its end") {
  for (const MotionPattern& pattern : shipped().patterns()) {
    INFO(pattern.name);
    CHECK(secondsHeldAtEnd(pattern) >= 0.5 - 1e-9);
  }
}

TEST_CASE("Each shipped pattern has settled into the twist of its exit class at its end") {
  for (const MotionPattern& pattern : shipped().patterns()) {
    INFO(pattern.name);
    const size_t last = pattern.trajectory.size() - 1;
    const Twist2 twist = twistTo(between(pattern.trajectory[last - 1], pattern.trajectory[last]),
                                 shipped().periodSeconds());
    const Twist2& wanted = shipped().classNamed(pattern.exit_class).twist;
    CHECK(std::abs(twist.v_x - wanted.v_x) < 0.05);
    CHECK(std::abs(twist.v_y - wanted.v_y) < 0.01);
    CHECK(std::abs(twist.omega - wanted.omega) < 0.08);
  }
}

TEST_CASE("From every motion class every other can be reached with the shipped patterns") {
  CHECK(shipped().content().classes.size() == 3);
  for (const MotionClass& motion : shipped().content().classes)
    CHECK(reachableFrom(motion.name) == std::set<std::string>{"rest", "cruise", "reverse"});
}

TEST_CASE("The paper's five are shipped, and what standing and tight places need") {
  for (const char* name : {"straight", "left", "right", "hard_left", "hard_right", "start", "stop",
                           "reverse", "turn_left_90", "turn_right_90", "sharp_left", "nudge_left"})
    CHECK(shipped().findByName(name) != nullptr);
  CHECK(shipped().findByName("left")->end().yaw > 0.3);
  CHECK(shipped().findByName("turn_left_90")->end().yaw == Approx(kPi / 2.0).epsilon(0.02));
  CHECK(shipped().findByName("turn_left_45")->end().yaw == Approx(kPi / 4.0).epsilon(0.02));
  CHECK(shipped().findByName("step_back")->end().x == Approx(-0.6).epsilon(0.05));
}

TEST_CASE("Shipped pairs of left and right are exact mirror images") {
  int pairs = 0;
  for (const MotionPattern& left : shipped().patterns()) {
    const size_t at = left.name.find("left");
    if (at == std::string::npos) continue;
    std::string name = left.name;
    const MotionPattern* right = shipped().findByName(name.replace(at, 4, "right"));
    REQUIRE(right != nullptr);
    REQUIRE(right->trajectory.size() == left.trajectory.size());
    for (size_t i = 0; i < left.trajectory.size(); ++i) {
      CHECK(right->commands[i][0] == left.commands[i][1]);
      CHECK(right->trajectory[i].x == left.trajectory[i].x);
      CHECK(right->trajectory[i].y == -left.trajectory[i].y);
      CHECK(right->trajectory[i].yaw == -left.trajectory[i].yaw);
    }
    ++pairs;
  }
  CHECK(pairs == 7);
}
