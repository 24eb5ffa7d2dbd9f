// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "modules/planner/core/execution/supervisor.hpp"
#include "modules/planner/core/map/local_map.hpp"

namespace tread::planner {
namespace {

constexpr double kMicro = 1e-6;
/// Poses this far apart are still interpolated [us].
constexpr int64_t kTrackGap = 150'000;
/// Steps in which coasting on is checked [s].
constexpr double kCoastStep = 0.1;

}  // namespace

void Supervisor::drive(const PlannerInputs& s, const Preconditions& ready) {
  if (runningPattern() == nullptr) return halt(s, "the running pattern is gone from the set");
  prediction_ = predictRunning(s);
  watchCorridor();
  planNext(s, ready, *prediction_);
  keepClear(s, *prediction_);
}

Prediction Supervisor::predictRunning(const PlannerInputs& s) const {
  const TablePattern& pattern = *runningPattern();
  const Pose2& here = s.pose->T_map_body;
  if (!tracker_.confirmed()) return predict(here, 0.0, pattern, *table_);
  const double time = static_cast<double>(s.pose->utime - tracker_.started()) * kMicro;
  const std::optional<Pose2> start = track_.at(tracker_.started(), kTrackGap);
  const std::optional<Pose2> now = track_.at(s.pose->utime, kTrackGap);
  MotionRatio so_far;
  if (start && now && time > 0.0)
    so_far = motionRatio(between(*start, *now), time, pattern, table_->set().periodSeconds());
  return predict(here, time, pattern, *table_, so_far);
}

/// What follows was planned from another place than the vehicle will come to: plan again now.
void Supervisor::watchCorridor() {
  if (!planned_on_ || !leftCorridor(*planned_on_, *prediction_)) return;
  planned_on_.reset();
  last_plan_ = 0;
  ++counters_["left the predicted corridor"];
}

bool Supervisor::frozen(const PlannerInputs& s) const {
  return tracker_.confirmed() && tracker_.ends() - s.now < config_.policy.freeze;
}

std::optional<double> Supervisor::conflict(const Pose2& here,
                                           const std::vector<ExpectedPose>& poses) const {
  const CollisionChecker& around = local_map_.collisionChecker();
  const int level = around.freeLevel(here, CollisionChecker::kCheck);
  if (level >= 0) return firstConflict(around, poses, level);
  // On blocked ground already: it must not become worse.
  const Overlap now = around.overlap(here);
  for (const ExpectedPose& at : poses)
    if (!around.overlap(at.T_map_body).within(now)) return at.time;
  return std::nullopt;
}

std::vector<ExpectedPose> Supervisor::posesAfter(const Prediction& running) const {
  std::vector<ExpectedPose> poses;
  const TablePattern* next =
      tracker_.next().empty() ? nullptr : table_->find(tracker_.next().pattern_id);
  if (next != nullptr) {
    for (const SweptPose& at : next->swept_poses)
      poses.push_back({running.T_map_end * at.pose, running.time_left + at.time});
    return poses;
  }
  // Nothing follows: the series ends, and the vehicle coasts.
  const Twist2& twist = table_->motionClass(runningPattern()->exit).twist;
  for (double t = kCoastStep; t <= config_.policy.coast_time + 1e-9; t += kCoastStep)
    poses.push_back({running.T_map_end * integrate(twist, t), running.time_left + t});
  return poses;
}

bool Supervisor::nextCollides(const Prediction& running) const {
  if (tracker_.next().empty()) return false;
  return conflict(running.T_map_end, posesAfter(running)).has_value();
}

void Supervisor::planNext(const PlannerInputs& s, const Preconditions& ready,
                          const Prediction& running) {
  if (frozen(s)) return;
  const bool waits = !tracker_.confirmed() && !tracker_.next().empty();
  const bool due = s.now - last_plan_ >= config_.policy.plan_period && !waits;
  if (!due && !nextCollides(running)) return;
  if (ready.level == Preconditions::Level::kGo) return searchNext(s, running);
  last_plan_ = s.now;
  planned_ = true;
  stopNext(running);
  say(ready.status, ready.reason);
}

/// Where the running pattern is expected to end, as the start of what follows.
PlanStep Supervisor::endOf(const Prediction& running) const {
  return {runningPattern()->id(), running.T_map_end, runningPattern()->exit, 0.0,
          running.uncertainty};
}

void Supervisor::searchNext(const PlannerInputs& s, const Prediction& running) {
  planned_on_ = running;
  if (sayUnreachable()) {
    last_plan_ = s.now;
    stopNext(running);
    return;
  }
  const SearchResult result = searchFrom(s, endOf(running), config_.policy.driving_expansions);
  if (result.end == SearchEnd::kNothing) {
    const bool stops = stopNext(running);
    ++counters_["no plan while driving"];
    return say(PlanStatus::kBlocked, stops ? "stopping: " + result.reason : result.reason);
  }
  plan_ = result.steps;
  hysteresis_.take(plan_, *table_);
  if (plan_.empty())
    tracker_.clearNext();
  else
    tracker_.setNext(table_->set(), plan_.front().pattern_id);
  sayDriving(s);
}

bool Supervisor::stopNext(const Prediction& running) {
  const CollisionChecker& around = local_map_.collisionChecker();
  const int motion_class = runningPattern()->exit;
  const TablePattern* best = nullptr;
  const int level = around.freeLevel(running.T_map_end, CollisionChecker::kCheck);
  if (motion_class != table_->restClass()) {
    for (const TablePattern* stop : table_->stopsFrom(motion_class)) {
      if (best != nullptr && best->duration <= stop->duration) continue;
      const bool free =
          level >= 0 ? around.sweepFree(running.T_map_end, *stop, level)
                     : around.escape(running.T_map_end, around.overlap(running.T_map_end), *stop)
                           .has_value();
      if (free) best = stop;
    }
  }
  plan_.clear();
  if (best == nullptr) {
    tracker_.clearNext();
    return motion_class == table_->restClass();
  }
  tracker_.setNext(table_->set(), best->id());
  plan_.push_back(stepAfter(endOf(running), *best));
  return true;
}

/// Whether a stop now keeps more margin than going on. What is nearer than the stopping distance
/// may be reached either way; then the better way is the one that keeps clear, and at equal margin
/// to stand is better.
bool Supervisor::stoppingIsBetter(const PlannerInputs& s,
                                  const std::vector<ExpectedPose>& poses) const {
  if (!s.pose->twist) return true;
  const CollisionChecker& around = local_map_.collisionChecker();
  const auto worst = [&](const std::vector<ExpectedPose>& way) {
    int level = CollisionChecker::kCheck;
    for (const ExpectedPose& at : way)
      level = std::min(level, around.freeLevel(at.T_map_body, level));
    return level;
  };
  std::vector<ExpectedPose> coast;
  for (double t = kCoastStep; t <= config_.policy.coast_time + 1e-9; t += kCoastStep)
    coast.push_back({s.pose->T_map_body * integrate(*s.pose->twist, t), t});
  return worst(coast) >= worst(poses);
}

void Supervisor::keepClear(const PlannerInputs& s, const Prediction& running) {
  const double age = static_cast<double>(s.now - s.pose->utime) * kMicro;
  const double lead = static_cast<double>(config_.policy.stop_lead) * kMicro;
  std::vector<ExpectedPose> poses = running.ahead;
  const std::vector<ExpectedPose> after = posesAfter(running);
  poses.insert(poses.end(), after.begin(), after.end());
  const std::optional<double> found = conflict(s.pose->T_map_body, poses);
  if (!found || *found - age > lead) return;
  if (!stoppingIsBetter(s, poses)) {
    ++counters_["went on: a stop would have kept less clear"];
    return;
  }
  halt(s, "something is in the way in " + withTenths(std::max(0.0, *found - age)) + " s");
}

}  // namespace tread::planner
