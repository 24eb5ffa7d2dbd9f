// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/planner/kit/sample_patterns.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace tread::planner::testkit {
namespace {

constexpr int64_t kPeriodUs = 50'000;
constexpr double kPeriod = 0.05;
constexpr double kFine = 0.005;

/// A part of a command series with a constant command.
struct Phase {
  Command command;
  double time;
};

const MotionClass& classOf(const PatternSetContent& content, const std::string& name) {
  for (const MotionClass& motion : content.classes)
    if (motion.name == name) return motion;
  throw std::logic_error("no class " + name);
}

void add(PatternSetContent& content, const std::string& name, const std::string& entry,
         const std::string& exit, const std::vector<Phase>& phases, double turn_error) {
  MotionPattern pattern;
  pattern.id = static_cast<int>(content.patterns.size()) + 1;
  pattern.name = name;
  pattern.entry_class = entry;
  pattern.exit_class = exit;
  pattern.end_covariance.fill(std::numeric_limits<double>::quiet_NaN());
  const TrackModel model;
  TrackState state;
  state.left = classOf(content, entry).steady[0] * model.top_speed;
  state.right = classOf(content, entry).steady[1] * model.top_speed;
  for (const Phase& phase : phases) {
    for (int i = 0; i < static_cast<int>(std::lround(phase.time / kPeriod)); ++i) {
      for (int k = 0; k < static_cast<int>(std::lround(kPeriod / kFine)); ++k)
        state = moveOn(state, phase.command, kFine, model, 1.0, turn_error);
      pattern.commands.push_back(phase.command);
      pattern.trajectory.push_back(state.pose);
    }
  }
  content.patterns.push_back(pattern);
}

PatternSet checked(PatternSetContent content) {
  std::string why;
  const std::optional<PatternSet> set = PatternSet::make(std::move(content), why);
  if (!set) throw std::logic_error(why);
  return *set;
}

void addCruise(PatternSetContent& content, double error) {
  const Command full{1.0, 1.0};
  const auto turn = [&](const std::string& name, Command command) {
    add(content, name, "cruise", "cruise", {{command, 0.55}, {full, 0.45}}, error);
  };
  add(content, "straight", "cruise", "cruise", {{full, 1.0}}, error);
  add(content, "straight_short", "cruise", "cruise", {{full, 0.5}}, error);
  turn("left", {0.8, 1.0});
  turn("right", {1.0, 0.8});
  turn("hard_left", {0.55, 1.0});
  turn("hard_right", {1.0, 0.55});
  add(content, "start", "rest", "cruise", {{full, 1.0}}, error);
  add(content, "stop", "cruise", "rest", {{{0.0, 0.0}, 0.7}}, error);
}

void addSlow(PatternSetContent& content, double error) {
  const Command back{-0.5, -0.5};
  const Command zero{0.0, 0.0};
  add(content, "back", "rest", "reverse", {{back, 0.8}}, error);
  add(content, "reverse", "reverse", "reverse", {{back, 1.0}}, error);
  add(content, "reverse_left", "reverse", "reverse", {{{-0.35, -0.5}, 0.55}, {back, 0.45}}, error);
  add(content, "reverse_right", "reverse", "reverse", {{{-0.5, -0.35}, 0.55}, {back, 0.45}}, error);
  add(content, "reverse_stop", "reverse", "rest", {{zero, 0.6}}, error);
  const auto spot = [&](const std::string& name, double power, double time) {
    add(content, name, "rest", "rest", {{{-power, power}, time}, {zero, 0.5}}, error);
  };
  spot("turn_left", 0.5, 0.6);
  spot("turn_right", -0.5, 0.6);
  spot("turn_left_little", 0.4, 0.2);
  spot("turn_right_little", -0.4, 0.2);
  add(content, "creep", "rest", "rest", {{{0.5, 0.5}, 0.5}, {zero, 0.5}}, error);
}

}  // namespace

TrackState moveOn(TrackState state, Command power, double dt, const TrackModel& model, double gain,
                  double turn_gain, double drift) {
  const double follow = 1.0 - std::exp(-dt / model.lag);
  state.left += follow * (model.top_speed * power[0] - state.left);
  state.right += follow * (model.top_speed * power[1] - state.right);
  const double speed = gain * (state.left + state.right) / 2.0;
  const Twist2 twist{speed, speed * std::tan(drift),
                     turn_gain * (state.right - state.left) / model.gauge};
  state.pose = state.pose * integrate(twist, dt);
  return state;
}

PatternSet samplePatterns(int64_t version, double turn_error) {
  PatternSetContent content;
  content.name = "sample";
  content.version = version;
  content.period_us = kPeriodUs;
  content.classes = {{"rest", {0.0, 0.0, 0.0}, {0.0, 0.0}},
                     {"cruise", {1.1, 0.0, 0.0}, {1.0, 1.0}},
                     {"reverse", {-0.55, 0.0, 0.0}, {-0.5, -0.5}}};
  addCruise(content, turn_error);
  addSlow(content, turn_error);
  return checked(std::move(content));
}

PatternSet latticePatterns() {
  PatternSetContent content;
  content.name = "lattice";
  content.period_us = 100'000;
  content.classes = {{"rest", {0.0, 0.0, 0.0}, {0.0, 0.0}}};
  const Twist2 moves[3] = {{1.0, 0.0, 0.0}, {0.0, 0.0, kPi / 2.0}, {0.0, 0.0, -kPi / 2.0}};
  const char* names[3] = {"ahead", "left", "right"};
  for (int k = 0; k < 3; ++k) {
    MotionPattern pattern;
    pattern.id = k + 1;
    pattern.name = names[k];
    pattern.entry_class = pattern.exit_class = "rest";
    pattern.end_covariance.fill(0.0);
    for (int i = 1; i <= 10; ++i) {
      pattern.commands.push_back({k == 1 ? -0.5 : 0.5, k == 2 ? -0.5 : 0.5});
      pattern.trajectory.push_back(integrate(moves[k], 0.1 * i));
    }
    content.patterns.push_back(pattern);
  }
  return checked(std::move(content));
}

}  // namespace tread::planner::testkit
