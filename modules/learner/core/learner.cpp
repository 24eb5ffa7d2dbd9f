// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/learner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "modules/learner/core/rules/make_rule.hpp"

namespace tread::learner {
namespace {

void append(std::string& text, const std::string& more) {
  if (!text.empty()) text += "; ";
  text += more;
}

/// Residuals needed for a known covariance, and weight of a shipped one in residuals.
constexpr int64_t kFewestResiduals = 3;
constexpr int64_t kShippedCount = 5;
/// [1] of the newest residual, for any number of them.
constexpr double kLeastWeight = 0.10;
/// An execution that begins this soon after another one follows it without a pause [us].
constexpr int64_t kNoPause = 100'000;
/// [s] before an execution when the planner has chosen it, with the knowledge of that time.
constexpr double kChosenBefore = 0.3;

/// The guards of a note in words.
std::string guardsOf(const RuleNote& note) {
  static const char* const kNames[3] = {"x", "y", "yaw"};
  std::string guards;
  if (note.one_dimensional) append(guards, "one-dimensional: own update only");
  if (note.moved_back)
    append(guards, "moved in the opposite direction: own update only, the ground may have changed");
  if (note.turned_back)
    append(guards,
           "turned in the opposite direction: own update only, the ground may have changed");
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
  coasting_ = Coasting(largestSpeed(shipped_));
  ended_ = {};
  watch_.clear();
  if (restoreMemory(memory)) {
    settled_->assign(*rule_);
    return true;
  }
  std::string why;
  if (auto anew = PatternSet::make(predicted(), why)) set_ = *anew;
  return false;
}

/// The rule's memory, then that of the motion: the watch's with its length, and that of coasting.
std::vector<double> Learner::memory() const {
  std::vector<double> memory = settled_->memory();
  if (!rule_->learnsParts()) return memory;
  const auto put = [&memory](const auto& numbers) {
    memory.insert(memory.end(), numbers.begin(), numbers.end());
  };
  const std::vector<double> of_watch = watch_.memory();
  put(of_watch);
  put(std::vector<double>{static_cast<double>(of_watch.size()),
                          static_cast<double>(watched_until_)});
  put(coasting_.memory());
  put(std::vector<double>{static_cast<double>(ended_.utime), ended_.beside[0], ended_.beside[1]});
  return memory;
}

bool Learner::restoreMemory(std::vector<double> memory) {
  const TrajectoryTable table(set_.patterns());
  if (!rule_->learnsParts()) return rule_->restore(table, memory);
  constexpr size_t kAtEnd = Coasting::kNumbers + 5;
  if (memory.size() < kAtEnd ||
      !std::all_of(memory.end() - kAtEnd, memory.end(), [](double n) { return std::isfinite(n); }))
    return false;
  const auto of_watch = memory.end() - kAtEnd;
  const auto of_coasting = of_watch + 2;
  const auto of_end = of_coasting + Coasting::kNumbers;
  // A number of microseconds that a double represents exactly.
  constexpr double kLatest = 9e15;
  const auto isTime = [](double number) { return number >= 0.0 && number < kLatest; };
  const auto left = static_cast<double>(memory.size() - kAtEnd);
  if (!isTime(of_watch[1]) || !isTime(of_end[0]) || of_coasting[1] < 0.0 ||
      !(of_watch[0] >= 0.0 && of_watch[0] <= left))
    return false;
  const auto watch_begins = of_watch - static_cast<std::ptrdiff_t>(of_watch[0]);
  ChangeWatch watch = watch_;
  if (!watch.restore({watch_begins, of_watch})) return false;
  if (!rule_->restore(table, {memory.begin(), watch_begins})) return false;
  watch_ = std::move(watch);
  watched_until_ = static_cast<int64_t>(of_watch[1]);
  coasting_.restore({of_coasting[0], of_coasting[1]});
  ended_ = {static_cast<int64_t>(of_end[0]), {of_end[1], of_end[2]}};
  return true;
}

void Learner::renumber(int64_t version, int64_t parent) {
  // Running executions are published, but not stored.
  if (following_) rule_->assign(*settled_);
  PatternSetContent content = following_ ? predicted() : set_.content();
  following_ = false;
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

PatternSetContent Learner::predicted(const std::optional<Coming>& coming) const {
  PatternSetContent content = set_.content();
  for (size_t p = 0; p < content.patterns.size(); ++p) {
    MotionPattern& pattern = content.patterns[p];
    pattern.trajectory = predictionOf(*rule_, p, pattern.trajectory.size());
    if (coming && pattern.entry_class == coming->entry_class)
      coasting_.add(coming->beside, set_.periodSeconds(), pattern.trajectory);
    if (const auto covariance = rule_->endCovariance(p)) pattern.end_covariance = *covariance;
  }
  return content;
}

/// The measured part of an execution, as the rule learns it: the rest continues as predicted.
Eigen::ArrayX3d Learner::measuredRows(const Measurement& measurement) {
  fill(measurement.trajectory, measured_);
  const auto samples = static_cast<Eigen::Index>(measurement.trajectory.size());
  const ConstTrajectory whole(measured_.data(), samples, 3);
  if (!rule_->learnsParts()) return whole;
  return whole.topRows(static_cast<Eigen::Index>(measurement.covered));
}

/// Updates the earlier rule with this execution, which began at `begun`.
RuleNote Learner::update(size_t executed, const Measurement& measurement, int64_t begun) {
  const Eigen::ArrayX3d rows = measuredRows(measurement);
  const ConstTrajectory measured(rows.data(), rows.rows(), 3);
  Context context = measurement.context;
  changed_after_.reset();
  if (rule_->learnsParts()) {
    ChangeWatch watch = watch_;
    if (std::abs(begun - watched_until_) >= kNoPause) watch.clear();
    settled_->setContext(context);
    if (const auto change = watch.notice(*settled_, executed, measured, set_.periodSeconds()))
      changed_after_ = context.changed_after = change->after;
  }
  rule_->assign(*settled_);
  rule_->setContext(context);
  RuleNote note;
  rule_->learn(executed, measured, note);
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

/// The next execution is compared with the end of this one, unless the ground has already changed.
void Learner::watchEnd(size_t executed, const Measurement& measurement, int64_t utime) {
  watch_.clear();
  watched_until_ = utime;
  if (changed_after_ || !rule_->learnsParts() || !measurement.complete()) return;
  const Eigen::ArrayX3d rows = measuredRows(measurement);
  watch_.follow(*settled_, executed, ConstTrajectory(rows.data(), rows.rows(), 3),
                set_.periodSeconds());
}

/// Learns from the end error relative to the earlier prediction, and from the initial deviation.
void Learner::learnCoasting(size_t executed, const Measurement& measurement, int64_t utime) {
  const Ended before = std::exchange(ended_, Ended{});
  if (!rule_->learnsParts() || !measurement.complete() || changed_after_) return;
  const double period = set_.periodSeconds();
  const MotionPattern& pattern = set_.patterns()[executed];
  const std::vector<Pose2> expected =
      predictionOf(*settled_, executed, measurement.trajectory.size());
  const double seconds = period * static_cast<double>(expected.size());
  const int64_t begun = utime - std::llround(1e6 * seconds);
  if (before.utime > 0 && std::abs(begun - before.utime) < kNoPause &&
      !set_.classNamed(pattern.entry_class).standing()) {
    const Pose2& end = measurement.trajectory.back();
    coasting_.learn(before.beside, {end.x - expected.back().x, end.y - expected.back().y}, seconds);
  }
  const auto unknown = static_cast<size_t>(std::llround(kChosenBefore / period));
  if (unknown >= expected.size()) return;
  if (const auto beside =
          coasting_.beside(measurement.trajectory, expected, expected.size() - unknown, period))
    ended_ = {utime, *beside};
}

std::optional<Learner::Coming> Learner::comingAfter(const MotionPattern& running,
                                                    const Measurement& beginning) const {
  // A vehicle at rest does not coast.
  if (set_.classNamed(running.exit_class).standing()) return std::nullopt;
  const std::vector<Pose2> expected =
      predictionOf(*settled_, index_.at(running.id), running.trajectory.size());
  const auto beside =
      coasting_.beside(beginning.trajectory, expected, beginning.covered, set_.periodSeconds());
  if (!beside) return std::nullopt;
  return Coming{running.exit_class, *beside};
}

bool Learner::follow(int pattern_id, const Measurement& beginning, int64_t part, int64_t utime) {
  const MotionPattern* pattern = set_.find(pattern_id);
  if (!rule_->learnsParts() || pattern == nullptr || !beginning.fair() || beginning.covered == 0)
    return false;
  const int64_t version = settled_version_ + part;
  if (part >= kVersions || version <= set_.version()) return false;
  update(index_.at(pattern_id), beginning,
         utime - std::llround(1e6 * set_.periodSeconds() * static_cast<double>(beginning.covered)));
  // After a change of ground the velocity is that of the new ground, which the rule has just
  // learned.
  const auto coming = changed_after_ ? std::nullopt : comingAfter(*pattern, beginning);
  std::string why;
  const bool adopted = adopt(predicted(coming), version, utime, why);
  if (adopted)
    following_ = true;
  else
    rule_->assign(*settled_);
  return adopted;
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
  const double seconds = set_.periodSeconds() * static_cast<double>(pattern->trajectory.size());
  correction.note = update(executed, measurement, utime - std::llround(1e6 * seconds));
  correction.changed_after = changed_after_;
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
  watchEnd(executed, measurement, utime);
  learnCoasting(executed, measurement, utime);
  settled_->assign(*rule_);
  settled_version_ = set_.version();
  following_ = false;
  residuals_[pattern_id] = residuals;
  correction.changed = true;
  correction.reason = rule_->reason(correction.note);
  if (changed_after_) append(correction.reason, "another ground while it ran");
  return correction;
}

}  // namespace tread::learner
