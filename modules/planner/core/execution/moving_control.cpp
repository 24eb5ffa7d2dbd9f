// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/moving_control.hpp"

#include "modules/planner/core/execution/standing_control.hpp"

#include <algorithm>

#include "modules/planner/core/execution/slide.hpp"

namespace tread::planner {
namespace {

constexpr double kMicro = 1e-6;
/// Longest gap between interpolated poses [us].
constexpr int64_t kTrackGap = 150'000;
/// Time step of the coasting check [s].
constexpr double kCoastStep = 0.1;

/// Poses of a vehicle that keeps its twist for `duration` [s] from `begin` [s] on.
std::vector<ExpectedPose> coasting(const Pose2& T_map_body, const Twist2& twist, double begin,
                                   double duration) {
  std::vector<ExpectedPose> poses;
  for (double t = kCoastStep; t <= duration + 1e-9; t += kCoastStep)
    poses.push_back({T_map_body * integrate(twist, t), begin + t});
  return poses;
}

}  // namespace

void MovingControl::drive(const PlannerInputs& s, const Preconditions& ready) {
  if (state_.runningPattern() == nullptr) return state_.halt(s.now, StopReason::kPatternGone);
  state_.prediction = predictRunning(s);
  // The rest was planned from a place that the vehicle will not reach: plan again now.
  if (state_.plan.based_on && leftCorridor(*state_.plan.based_on, *state_.prediction)) {
    state_.plan.expire();
    ++state_.counters["left the predicted corridor"];
  }
  if (answerSlide(s, ready, *state_.prediction)) return;
  planNext(s, ready, *state_.prediction);
  keepClear(s, *state_.prediction);
}

Prediction MovingControl::predictRunning(const PlannerInputs& s) const {
  const TablePattern& pattern = *state_.runningPattern();
  const Pose2& here = s.pose->T_map_body;
  if (!state_.tracker.confirmed()) return predict(here, 0.0, pattern, state_.table());
  const double time = static_cast<double>(s.pose->utime - state_.tracker.started()) * kMicro;
  const std::optional<Pose2> start = state_.track.at(state_.tracker.started(), kTrackGap);
  const std::optional<Pose2> now = state_.track.at(s.pose->utime, kTrackGap);
  MotionRatio so_far;
  if (start && now && time > 0.0)
    so_far =
        motionRatio(between(*start, *now), time, pattern, state_.table().set().periodSeconds());
  return predict(here, time, pattern, state_.table(), so_far);
}

bool MovingControl::frozen(const PlannerInputs& s) const {
  return state_.tracker.confirmed() && state_.tracker.ends() - s.now < state_.config.policy.freeze;
}

std::optional<double> MovingControl::conflict(const Pose2& here,
                                              const std::vector<ExpectedPose>& poses) const {
  const CollisionChecker& around = state_.map.collisionChecker();
  const int level = around.freeLevel(here, CollisionChecker::kCheck);
  if (level >= 0) return firstConflict(around, poses, level);
  // Already on blocked ground: it must not become worse.
  const Overlap now = around.overlap(here);
  for (const ExpectedPose& at : poses)
    if (!around.overlap(at.T_map_body).within(now)) return at.time;
  return std::nullopt;
}

std::vector<ExpectedPose> MovingControl::posesAfter(const Prediction& running) const {
  std::vector<ExpectedPose> poses;
  const TablePattern* next = state_.tracker.next().empty()
                                 ? nullptr
                                 : state_.table().find(state_.tracker.next().pattern_id);
  // Where the ground gave way a stopping pattern does not stop: the vehicle slides on.
  const bool slides =
      state_.grip.gave_way && next != nullptr && next->exit == state_.table().restClass();
  if (next != nullptr && !slides) {
    for (const SweptPose& at : next->swept_poses)
      poses.push_back({running.T_map_end * at.pose, running.time_left + at.time});
    return poses;
  }
  // Nothing follows: the series ends, and the vehicle coasts.
  const Twist2& twist = state_.table().motionClass(state_.runningPattern()->exit).twist;
  return coasting(running.T_map_end, twist, running.time_left, state_.coastTime(twist));
}

bool MovingControl::nextCollides(const Prediction& running) const {
  if (state_.tracker.next().empty()) return false;
  return conflict(running.T_map_end, posesAfter(running)).has_value();
}

void MovingControl::planNext(const PlannerInputs& s, const Preconditions& ready,
                             const Prediction& running) {
  if (frozen(s)) return;
  const bool waits = !state_.tracker.confirmed() && !state_.tracker.next().empty();
  const bool due = state_.plan.due(s.now, state_.config.policy.plan_period) && !waits;
  if (!due && !nextCollides(running)) return;
  if (ready.level == Preconditions::Level::kGo) return searchNext(s, running);
  state_.plan.made = s.now;
  state_.status.changed = true;
  stopNext(running);
  state_.status.say(ready.status, ready.reason);
}

/// The expected end of the running pattern, as the start of the next one.
PlanStep MovingControl::endOf(const Prediction& running) const {
  return {state_.runningPattern()->id(), running.T_map_end, state_.runningPattern()->exit, 0.0,
          running.uncertainty};
}

void MovingControl::searchNext(const PlannerInputs& s, const Prediction& running) {
  state_.plan.based_on = running;
  if (state_.sayUnreachable()) {
    state_.plan.made = s.now;
    stopNext(running);
    return;
  }
  const SearchResult result =
      state_.search(s.now, endOf(running), state_.config.policy.driving_expansions);
  if (result.end == SearchEnd::kNothing) {
    const bool stops = stopNext(running);
    ++state_.counters["no plan while driving"];
    return state_.status.say(
        PlanStatus::kBlocked,
        {result.reason.code, (stops ? "stopping: " : "") + result.reason.words});
  }
  state_.plan.steps = result.steps;
  state_.planner.side().take(result.steps, state_.table());
  if (result.steps.empty())
    state_.tracker.clearNext();
  else
    state_.tracker.setNext(state_.table().set(), state_.plan.steps.front().pattern_id);
  state_.sayDriving(s.now);
}

bool MovingControl::stopNext(const Prediction& running) {
  const CollisionChecker& around = state_.map.collisionChecker();
  const int motion_class = state_.runningPattern()->exit;
  const TablePattern* best = nullptr;
  const int level = around.freeLevel(running.T_map_end, CollisionChecker::kCheck);
  if (motion_class != state_.table().restClass()) {
    for (const TablePattern* stop : state_.table().stopsFrom(motion_class)) {
      if (best != nullptr && best->duration <= stop->duration) continue;
      const bool free =
          level >= 0 ? around.sweepFree(running.T_map_end, *stop, level)
                     : around.escape(running.T_map_end, around.overlap(running.T_map_end), *stop)
                           .has_value();
      if (free) best = stop;
    }
  }
  // A stop is no plan that leads on and that a later search would keep.
  state_.plan.end = SearchEnd::kNothing;
  state_.plan.risk = {};
  state_.plan.steps.clear();
  if (best == nullptr) {
    state_.tracker.clearNext();
    return motion_class == state_.table().restClass();
  }
  state_.tracker.setNext(state_.table().set(), best->id());
  state_.plan.steps.push_back(stepAfter(endOf(running), *best));
  return true;
}

/// Whether stopping now keeps more margin than continuing. Obstacles within the stopping distance
/// may be reached either way; then the option with more clearance is better, and at equal margin
/// stopping is.
bool MovingControl::stoppingIsBetter(const PlannerInputs& s,
                                     const std::vector<ExpectedPose>& poses) const {
  if (!s.pose->twist) return true;
  const CollisionChecker& around = state_.map.collisionChecker();
  const auto worst = [&](const std::vector<ExpectedPose>& way) {
    int level = CollisionChecker::kCheck;
    for (const ExpectedPose& at : way)
      level = std::min(level, around.freeLevel(at.T_map_body, level));
    return level;
  };
  return worst(coasting(s.pose->T_map_body, *s.pose->twist, 0.0,
                        state_.coastTime(*s.pose->twist))) >= worst(poses);
}

/// For the first moment on ground that gives way, before the learner reports it. True if the
/// present motion was replaced.
bool MovingControl::answerSlide(const PlannerInputs& s, const Preconditions& ready,
                                const Prediction& running) {
  if (state_.grip.gave_way || !s.pose->twist || !state_.tracker.confirmed()) return false;
  constexpr double kUnknown = 1.0;  // [m/s2] the learner's value before any evidence
  const TablePattern& pattern = *state_.runningPattern();
  const double period = state_.table().set().periodSeconds();
  const double time = static_cast<double>(s.pose->utime - state_.tracker.started()) * kMicro;
  SlideChoices choices;
  choices.rest = askedFrom(*pattern.pattern, period, time);
  const Twist2& v = *s.pose->twist;
  if (choices.rest.empty() || !slides(v, choices.rest.front().v_body)) return false;
  if (!state_.tracker.next().empty())
    choices.next = state_.table().find(state_.tracker.next().pattern_id);
  if (!frozen(s))
    choices.followers = ready.level == Preconditions::Level::kGo
                            ? state_.table().from(pattern.exit)
                            : state_.table().stopsFrom(pattern.exit);
  const Pose2& here = s.pose->T_map_body;
  const Sliding vehicle{here, Pose2{0.0, 0.0, here.yaw} * Eigen::Vector2d(v.v_x, v.v_y),
                        std::min(kUnknown, state_.grip.deceleration)};
  const SlideAnswer answer = answerToSlide(state_.map.collisionChecker(), vehicle, choices, period);
  if (answer.kind == SlideAnswer::Kind::kGoOn) return false;
  if (answer.kind == SlideAnswer::Kind::kStop) {
    state_.halt(s.now, StopReason::kGroundGivesWay);
    return true;
  }
  // No plan that leads on and that a later search would keep.
  state_.plan.end = SearchEnd::kNothing;
  state_.plan.steps = {stepAfter(endOf(running), *answer.follower)};
  state_.plan.made = s.now;
  state_.plan.risk = {};
  state_.plan.time_to_go = std::numeric_limits<double>::quiet_NaN();
  state_.tracker.setNext(state_.table().set(), answer.follower->id());
  ++state_.counters["steered because a stop would have slid on"];
  return true;
}

void MovingControl::keepClear(const PlannerInputs& s, const Prediction& running) {
  const double age = static_cast<double>(s.now - s.pose->utime) * kMicro;
  double lead = static_cast<double>(state_.config.policy.stop_lead) * kMicro;
  if (s.pose->twist) lead = std::max(lead, state_.coastTime(*s.pose->twist) + kReactionDelay);
  std::vector<ExpectedPose> poses = running.ahead;
  const std::vector<ExpectedPose> after = posesAfter(running);
  poses.insert(poses.end(), after.begin(), after.end());
  const std::optional<double> found = conflict(s.pose->T_map_body, poses);
  if (!found || *found - age > lead) return;
  if (!stoppingIsBetter(s, poses)) {
    ++state_.counters["went on: a stop would have kept less clear"];
    return;
  }
  state_.halt(s.now,
              {StopReason::kObstacleAhead,
               "something is in the way in " + withTenths(std::max(0.0, *found - age)) + " s"});
}

}  // namespace tread::planner
