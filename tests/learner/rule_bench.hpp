// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"
#include "modules/learner/core/rules/make_rule.hpp"
#include "modules/learner/core/rules/multi_model.hpp"
#include "tests/learner/samples.hpp"

namespace tread::learner::samples {

inline RuleConfig ruleConfig(Rule rule, double memory = 0.5) {
  RuleConfig config;
  config.rule = rule;
  config.memory = memory;
  return config;
}

/// A rule with a set, which takes executions and returns predictions as poses.
class Pupil {
 public:
  Pupil(const RuleConfig& config, PatternSet set)
      : set_(std::move(set)), rule_(makeRule(config, set_)) {}
  Pupil(const Pupil& other) : set_(other.set_), rule_(other.rule_->clone()) {}
  Pupil& operator=(const Pupil&) = delete;

  LearningRule& rule() { return *rule_; }
  const PatternSet& set() const { return set_; }
  size_t patterns() const { return set_.patterns().size(); }
  const std::vector<Pose2>& shipped(size_t pattern) const {
    return set_.patterns()[pattern].trajectory;
  }

  RuleNote learn(size_t executed, const std::vector<Pose2>& measured, const Context& context = {}) {
    RuleNote note;
    rule_->setContext(context);
    fill(measured, numbers_);
    rule_->learn(executed,
                 ConstTrajectory(numbers_.data(), static_cast<Eigen::Index>(measured.size()), 3),
                 note);
    return note;
  }
  std::vector<Pose2> prediction(size_t pattern) const {
    const auto samples = static_cast<Eigen::Index>(shipped(pattern).size());
    std::vector<double> numbers(static_cast<size_t>(3 * samples));
    rule_->predict(pattern, Trajectory(numbers.data(), samples, 3));
    return posesOf(ConstTrajectory(numbers.data(), samples, 3));
  }
  Pose2 end(size_t pattern) const { return rule_->predictEnd(pattern); }
  /// All predictions of all patterns, number by number.
  std::vector<double> everything() const {
    std::vector<double> all;
    for (size_t p = 0; p < patterns(); ++p)
      for (const Pose2& pose : prediction(p)) all.insert(all.end(), {pose.x, pose.y, pose.yaw});
    return all;
  }

 private:
  PatternSet set_;
  std::unique_ptr<LearningRule> rule_;
  std::vector<double> numbers_;
};

inline double distance(const Pose2& a, const Pose2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// Effect of a ground on every twist of a shipped prediction, the same for all patterns.
struct GroundEffect {
  double forward = 1.0;   ///< [1] factor on v_x
  double yaw = 1.0;       ///< [1] factor on omega
  double sideslip = 0.0;  ///< [s] v_y += sideslip |v| omega
  double crab = 0.0;      ///< [1] v_y += crab v
};

/// Scatter between executions: standard deviations of factors and of crab.
struct EffectSpread {
  double forward = 0.0;
  double yaw = 0.0;
  double crab = 0.0;
};

// Three grounds, and low-noise executions.
inline constexpr EffectSpread kCalm{0.02, 0.05, 0.02};
inline constexpr GroundEffect kMeadow{1.0, 1.0, 0.0, 0.0};
inline constexpr GroundEffect kMud{0.85, 1.5, 0.0, 0.0};
inline constexpr GroundEffect kRoad{1.15, 0.6, 0.1, 0.0};

inline GroundEffect drawn(GroundEffect mean, const EffectSpread& spread, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, 1.0);
  mean.forward *= 1.0 + spread.forward * normal(random);
  mean.yaw *= 1.0 + spread.yaw * normal(random);
  mean.crab += spread.crab * normal(random);
  return mean;
}

/// A trajectory on this ground.
inline std::vector<Pose2> under(const GroundEffect& ground, const std::vector<Pose2>& shipped,
                                double period = 0.05) {
  std::vector<Pose2> driven;
  Pose2 at;
  Pose2 last;
  for (const Pose2& pose : shipped) {
    const Twist2 twist = twistTo(between(last, pose), period);
    last = pose;
    const double v = ground.forward * twist.v_x;
    const double slip =
        ground.sideslip * std::abs(twist.v_x) * twist.omega + ground.crab * twist.v_x;
    at = at * integrate({v, twist.v_y + slip, ground.yaw * twist.omega}, period);
    driven.push_back(at);
  }
  return driven;
}

/// Executes random patterns on a ground; returns the note of the last execution.
inline RuleNote driveAny(Pupil& pupil, const GroundEffect& ground, const EffectSpread& spread,
                         int executions, std::mt19937_64& random) {
  RuleNote note;
  for (int i = 0; i < executions; ++i) {
    const size_t p = random() % pupil.patterns();
    note = pupil.learn(p, under(drawn(ground, spread, random), pupil.shipped(p)));
  }
  return note;
}

/// Indices of richSet().
enum Index : size_t { kAhead, kTurnLeft, kTurnRight, kHardLeft, kHardRight, kTurning, kBack };

/// Straight, left, right, hard left, hard right, in-place turn and reverse; 1 s each.
inline PatternSetContent richContent() {
  PatternSetContent content;
  content.name = "rich";
  content.classes = {{"cruise", {1.0, 0.0, 0.0}, {1.0, 1.0}}};
  content.patterns = {
      pattern(1, "straight", {1.0, 1.0}, arc({1.0, 0.0, 0.0})),
      pattern(2, "left", {0.7, 1.0}, arc({0.9, 0.0, 0.5})),
      pattern(3, "right", {1.0, 0.7}, arc({0.9, 0.0, -0.5})),
      pattern(4, "hard_left", {0.4, 1.0}, arc({0.7, 0.0, 1.0})),
      pattern(5, "hard_right", {1.0, 0.4}, arc({0.7, 0.0, -1.0})),
      pattern(6, "spin", {-0.6, 0.6}, arc({0.0, 0.0, 1.2})),
      pattern(7, "reverse", {-1.0, -1.0}, arc({-0.8, 0.0, 0.0})),
  };
  return content;
}

inline PatternSet richSet() {
  return checked(richContent());
}

/// A pattern with a varying twist.
inline std::vector<Pose2> winding() {
  std::vector<Pose2> poses = arc({0.9, 0.0, 0.8}, 10);
  const Pose2 middle = poses.back();
  for (const Pose2& pose : arc({0.5, 0.02, -0.6}, 15)) poses.push_back(middle * pose);
  return poses;
}

/// richSet() plus the winding one, last.
inline PatternSet windingSet() {
  PatternSetContent content = richContent();
  content.patterns.push_back(pattern(8, "winding", {0.9, 1.0}, winding()));
  return checked(content);
}

/// Mean distance of predicted ends from the ground's ends without scatter [m].
inline double meanEndError(const Pupil& pupil, const GroundEffect& ground) {
  double sum = 0.0;
  for (size_t p = 0; p < pupil.patterns(); ++p)
    sum += distance(pupil.end(p), under(ground, pupil.shipped(p)).back());
  return sum / static_cast<double>(pupil.patterns());
}

/// The same for the end's yaw [rad].
inline double meanYawError(const Pupil& pupil, const GroundEffect& ground) {
  double sum = 0.0;
  for (size_t p = 0; p < pupil.patterns(); ++p)
    sum += std::abs(pupil.end(p).yaw - under(ground, pupil.shipped(p)).back().yaw);
  return sum / static_cast<double>(pupil.patterns());
}

}  // namespace tread::learner::samples
