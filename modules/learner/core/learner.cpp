// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/learner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tread::learner {
namespace {

void append(std::string& text, const std::string& more) {
  if (!text.empty()) text += "; ";
  text += more;
}

/// Residuals before a covariance is called known, and those that a shipped covariance counts for.
constexpr int64_t kFewestResiduals = 3;
constexpr int64_t kShippedCount = 5;
/// [1] of the newest residual, however many there were.
constexpr double kLeastWeight = 0.10;
/// An execution that begins so soon after another follows it without a pause [us].
constexpr int64_t kNoPause = 100'000;
/// [s] before an execution the planner has chosen it.
constexpr double kChosenBefore = 0.25;

/// The guards of a note in words.
std::string guardsOf(const RuleNote& note) {
  static const char* const kNames[3] = {"x", "y", "yaw"};
  std::string guards;
  if (note.one_dimensional) append(guards, "one-dimensional: own update only");
  if (note.moved_back)
    append(guards, "moved the other way: own update only, the ground may have changed");
  if (note.turned_back)
    append(guards, "turned the other way: own update only, the ground may have changed");
  std::string held;
  for (size_t axis = 0; axis < 3; ++axis)
    if (note.held[axis]) held += (held.empty() ? "" : ", ") + std::string(kNames[axis]);
  if (!held.empty()) append(guards, "no factor for " + held + ": box too small");
  return guards;
}

}  // namespace

EndResiduals residualsOf(const MotionPattern& shipped) {
  if (!isKnown(shipped.end_covariance)) return {};
  return {kShippedCount, shipped.end_covariance};
}

void addResidual(EndResiduals& residuals, const Pose2& error) {
  const PoseCovariance square{error.x * error.x, error.x * error.y,   error.x * error.yaw,
                              error.y * error.y, error.y * error.yaw, error.yaw * error.yaw};
  ++residuals.count;
  const double weight = std::max(1.0 / static_cast<double>(residuals.count), kLeastWeight);
  for (size_t i = 0; i < square.size(); ++i)
    residuals.mean[i] += weight * (square[i] - residuals.mean[i]);
}

PoseCovariance covarianceOf(const EndResiduals& residuals) {
  if (residuals.count >= kFewestResiduals) return residuals.mean;
  return kUnknownCovariance;
}

Pose2 endError(const Measurement& measurement, const MotionPattern& predicted) {
  const Pose2& m = measurement.trajectory.back();
  const Pose2& r = predicted.end();
  return {m.x - r.x, m.y - r.y, wrapAngle(m.yaw - r.yaw)};
}

Learner::Learner(const RuleConfig& config, PatternSet shipped)
    : shipped_(std::move(shipped)),
      set_(shipped_),
      rule_(makeRule(config, shipped_)),
      settled_version_(set_.version()),
      settled_(rule_->clone()),
      coasting_(largestSpeed(shipped_)) {
  for (const MotionPattern& pattern : shipped_.patterns()) {
    index_.emplace(pattern.id, index_.size());
    residuals_[pattern.id] = residualsOf(pattern);
  }
}

bool Learner::restore(PatternSet set, ResidualTable residuals, const std::vector<double>& memory) {
  set_ = std::move(set);
  settled_version_ = set_.version();
  residuals_ = std::move(residuals);
  if (rule_->restore(TrajectoryTable(set_.patterns()), memory)) {
    settled_->assign(*rule_);
    return true;
  }
  std::string why;
  if (auto anew = PatternSet::make(predicted(), why)) set_ = *anew;
  return false;
}

void Learner::renumber(int64_t version, int64_t parent) {
  PatternSetContent content = set_.content();
  content.version = version;
  content.parent_version = parent;
  std::string why;
  if (auto renumbered = PatternSet::make(std::move(content), why)) set_ = *renumbered;
  settled_version_ = set_.version();
}

std::vector<Pose2> Learner::predictionOf(const LearningRule& rule, size_t pattern,
                                         size_t samples) const {
  std::vector<double> numbers(3 * samples);
  const auto rows = static_cast<Eigen::Index>(samples);
  rule.predict(pattern, Trajectory(numbers.data(), rows, 3));
  return posesOf(ConstTrajectory(numbers.data(), rows, 3));
}

PatternSetContent Learner::predicted(const std::optional<Eigen::Vector2d>& beside) const {
  PatternSetContent content = set_.content();
  for (size_t p = 0; p < content.patterns.size(); ++p) {
    MotionPattern& pattern = content.patterns[p];
    pattern.trajectory = predictionOf(*rule_, p, pattern.trajectory.size());
    if (beside) coasting_.add(*beside, set_.periodSeconds(), pattern.trajectory);
    if (const auto covariance = rule_->endCovariance(p)) pattern.end_covariance = *covariance;
  }
  return content;
}

/// The rule as it was, and this execution.
RuleNote Learner::update(size_t executed, const Measurement& measurement) {
  rule_->assign(*settled_);
  fill(measurement.trajectory, measured_);
  const auto samples = static_cast<Eigen::Index>(measurement.trajectory.size());
  const ConstTrajectory whole(measured_.data(), samples, 3);
  RuleNote note;
  rule_->setContext(measurement.context);
  if (!rule_->learnsParts() || measurement.complete()) {
    rule_->learn(executed, whole, note);
    return note;
  }
  const Eigen::ArrayX3d beginning = whole.topRows(static_cast<Eigen::Index>(measurement.covered));
  rule_->learn(executed, ConstTrajectory(beginning.data(), beginning.rows(), 3), note);
  return note;
}

bool Learner::adopt(PatternSetContent content, int64_t version, int64_t utime, std::string& why) {
  content.parent_version = settled_version_;
  content.version = version;
  content.utime = utime;
  auto next = PatternSet::make(std::move(content), why);
  if (next) set_ = *next;
  return next.has_value();
}

/// From how far it ended beside what was predicted before it, and with what it began.
void Learner::learnCoasting(size_t executed, const Measurement& measurement, int64_t utime) {
  const std::optional<Ended> before = std::exchange(ended_, std::nullopt);
  if (!rule_->learnsParts() || !measurement.complete()) return;
  const double period = set_.periodSeconds();
  const std::vector<Pose2> expected =
      predictionOf(*settled_, executed, measurement.trajectory.size());
  const double seconds = period * static_cast<double>(expected.size());
  const int64_t pause = utime - std::llround(1e6 * seconds) - (before ? before->utime : 0);
  if (before && std::abs(pause) < kNoPause) {
    const Pose2& end = measurement.trajectory.back();
    coasting_.learn(before->beside, {end.x - expected.back().x, end.y - expected.back().y},
                    seconds);
  }
  // As late as a part of it that is known when the next one is chosen.
  const auto known = static_cast<size_t>(std::llround(kChosenBefore / period));
  if (known >= expected.size()) return;
  if (const auto beside =
          coasting_.beside(measurement.trajectory, expected, expected.size() - known, period))
    ended_ = {utime, *beside};
}

bool Learner::follow(int pattern_id, const Measurement& beginning, int64_t part, int64_t utime) {
  const MotionPattern* pattern = set_.find(pattern_id);
  if (!rule_->learnsParts() || pattern == nullptr || !beginning.fair() || beginning.covered == 0)
    return false;
  const int64_t version = settled_version_ + part;
  if (part >= kVersions || version <= set_.version()) return false;
  const size_t executed = index_.at(pattern_id);
  const size_t samples = pattern->trajectory.size();
  const auto beside =
      coasting_.beside(beginning.trajectory, predictionOf(*settled_, executed, samples),
                       beginning.covered, set_.periodSeconds());
  update(executed, beginning);
  std::string why;
  following_ = adopt(predicted(beside), version, utime, why);
  if (!following_) rule_->assign(*settled_);
  return following_;
}

bool Learner::unfollow(int64_t utime) {
  if (!following_) return false;
  following_ = false;
  rule_->assign(*settled_);
  std::string why;
  if (!adopt(predicted(), nextVersion(), utime, why)) return false;
  settled_version_ = set_.version();
  return true;
}

Correction Learner::learn(int pattern_id, const Measurement& measurement,
                          const std::optional<Pose2>& end_error, int64_t utime) {
  Correction correction;
  const MotionPattern* pattern = set_.find(pattern_id);
  if (!rule_->learns() || pattern == nullptr || !measurement.fair()) return correction;
  if (measurement.trajectory.size() != pattern->trajectory.size()) return correction;
  const size_t executed = index_.at(pattern_id);
  learnCoasting(executed, measurement, utime);
  correction.note = update(executed, measurement);
  correction.guards = guardsOf(correction.note);

  EndResiduals residuals = residuals_[pattern_id];
  if (end_error) addResidual(residuals, *end_error);
  PatternSetContent content = predicted();
  MotionPattern& learned = content.patterns[executed];
  ++learned.times_learned;
  if (!rule_->endCovariance(executed)) learned.end_covariance = covarianceOf(residuals);
  std::string why;
  if (!adopt(std::move(content), nextVersion(), utime, why)) {
    rule_->assign(*settled_);
    append(correction.guards, "not learned, the set would be wrong: " + why);
    return correction;
  }
  settled_->assign(*rule_);
  settled_version_ = set_.version();
  following_ = false;
  residuals_[pattern_id] = residuals;
  correction.changed = true;
  correction.reason = rule_->reason(correction.note);
  return correction;
}

}  // namespace tread::learner
