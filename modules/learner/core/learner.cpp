// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/learner.hpp"

#include <cmath>
#include <stdexcept>

namespace tread::learner {
namespace {

void append(std::string& guards, const std::string& guard) {
  if (!guards.empty()) guards += "; ";
  guards += guard;
}

/// Names the axes of a pattern that hold nothing but noise.
std::string heldAxes(const PatternRole& role) {
  static const char* const kNames[3] = {"x", "y", "yaw"};
  std::string held;
  for (size_t axis = 0; axis < 3; ++axis)
    if (!role.scalable[axis]) held += (held.empty() ? "" : ", ") + std::string(kNames[axis]);
  return held;
}

bool anyScalable(const PatternRole& role) {
  return role.scalable[0] || role.scalable[1] || role.scalable[2];
}

}  // namespace

const char* ruleName(Rule rule) {
  switch (rule) {
    case Rule::kOff:
      return "off";
    case Rule::kSingle:
      return "single";
    case Rule::kCollective:
      return "collective";
  }
  return "off";
}

std::optional<Rule> ruleNamed(const std::string& name) {
  for (const Rule rule : {Rule::kOff, Rule::kSingle, Rule::kCollective})
    if (name == ruleName(rule)) return rule;
  return std::nullopt;
}

Pose2 endError(const Measurement& measurement, const MotionPattern& predicted) {
  const Pose2& m = measurement.trajectory.back();
  const Pose2& r = predicted.end();
  return {m.x - r.x, m.y - r.y, wrapAngle(m.yaw - r.yaw)};
}

Learner::Learner(RuleConfig config, PatternSet shipped)
    : config_(std::move(config)), shipped_(std::move(shipped)), set_(shipped_) {
  if (!(config_.memory >= 0.0 && config_.memory < 1.0))
    throw std::invalid_argument("learner: memory must be in 0 <= memory < 1");
  for (const MotionPattern& pattern : shipped_.patterns()) {
    roles_[pattern.id] = roleOf(pattern, config_.scaling);
    residuals_[pattern.id] = residualsOf(pattern, config_.residuals);
  }
}

void Learner::restore(PatternSet set, ResidualTable residuals) {
  set_ = std::move(set);
  residuals_ = std::move(residuals);
}

void Learner::renumber(int64_t version, int64_t parent) {
  PatternSetContent content = set_.content();
  content.version = version;
  content.parent_version = parent;
  std::string why;
  if (auto renumbered = PatternSet::make(std::move(content), why)) set_ = *renumbered;
}

Correction Learner::learn(int pattern_id, const Measurement& measurement,
                          const std::optional<Pose2>& end_error, int64_t utime) {
  Correction correction;
  const MotionPattern* executed = set_.find(pattern_id);
  if (config_.rule == Rule::kOff || executed == nullptr || !measurement.fair()) return correction;
  std::optional<Axes> factors;
  if (config_.rule == Rule::kCollective)
    factors = scalingFrom(*executed, measurement, correction.guards);
  if (factors) correction.scaling = *factors;

  PatternSetContent content = set_.content();
  EndResiduals residuals = residuals_[pattern_id];
  if (end_error) addResidual(residuals, *end_error, config_.residuals);
  for (MotionPattern& pattern : content.patterns) {
    const std::vector<Pose2> predicted = pattern.trajectory;
    if (pattern.id == pattern_id) {
      pattern.trajectory = smoothed(measurement.trajectory, predicted, config_.memory);
      pattern.end_covariance = covarianceOf(residuals, config_.residuals);
      ++pattern.times_learned;
    } else if (factors && anyScalable(roles_[pattern.id])) {
      const auto derived = scaled(predicted, *factors, roles_[pattern.id]);
      pattern.trajectory = smoothed(derived, predicted, config_.memory);
    }
  }
  content.parent_version = content.version;
  ++content.version;
  content.utime = utime;
  std::string why;
  const auto next = PatternSet::make(std::move(content), why);
  if (!next) {
    append(correction.guards, "not learned, the set would be wrong: " + why);
    return correction;
  }
  set_ = *next;
  residuals_[pattern_id] = residuals;
  correction.changed = true;
  return correction;
}

std::optional<Axes> Learner::scalingFrom(const MotionPattern& pattern,
                                         const Measurement& measurement,
                                         std::string& guards) const {
  const PatternRole& role = roles_.at(pattern.id);
  if (!role.gives_scaling) {
    append(guards, "one-dimensional: own update only");
    return std::nullopt;
  }
  if (turnsTheOtherWay(pattern, measurement.trajectory.back(), guards)) return std::nullopt;
  const std::string held = heldAxes(role);
  if (!held.empty()) append(guards, "no factor for " + held + ": box too small");
  return scalingVector(measurement.trajectory, pattern.trajectory, role, config_.scaling);
}

bool Learner::turnsTheOtherWay(const MotionPattern& pattern, const Pose2& measured_end,
                               std::string& guards) const {
  const PatternRole& role = roles_.at(pattern.id);
  const PoseCovariance known = covarianceOf(residuals_.at(pattern.id), config_.residuals);
  const auto opposite = [&](int axis, double measured, double predicted, double variance) {
    if (!role.scalable[static_cast<size_t>(axis)] || measured * predicted >= 0.0) return false;
    const double assumed =
        config_.relative_noise[axis] * std::abs(predicted) + config_.absolute_noise[axis];
    const double sigma = variance > 0.0 ? std::sqrt(variance) : assumed;
    return std::abs(measured - predicted) > config_.sign_sigmas * sigma;
  };
  const bool back = opposite(0, measured_end.x, pattern.end().x, known[0]);
  const bool turned = opposite(2, measured_end.yaw, pattern.end().yaw, known[5]);
  if (back) append(guards, "moved the other way: own update only, the ground may have changed");
  if (turned) append(guards, "turned the other way: own update only, the ground may have changed");
  return back || turned;
}

}  // namespace tread::learner
