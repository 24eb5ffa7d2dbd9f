// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/driving_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "modules/planner/core/search/swept_footprint.hpp"

namespace tread::planner {
namespace {

using Level = Preconditions::Level;

std::string oldAs(const char* what, int64_t age) {
  return std::string(what) + " is " + std::to_string(age / 1000) + " ms old";
}

Preconditions waiting(Level level, const Reason& reason) {
  return {level, PlanStatus::kWaiting, reason};
}

/// Problems that empty the program at once, except those of the bridge and the operator.
Preconditions checkSensors(const PlannerInputs& s, const MapAndSet& supplies,
                           const AgeLimits& limits) {
  if (!s.bar.empty()) return waiting(Level::kStop, s.bar);
  if (!s.pose) return waiting(Level::kStop, StopReason::kNoUsableIns);
  if (s.now - s.pose->utime > limits.pose)
    return waiting(Level::kStop, {StopReason::kInsStale, oldAs("INS", s.now - s.pose->utime)});
  if (!s.map_fault.empty()) return waiting(Level::kStop, s.map_fault);
  if (supplies.map_utime == 0) return waiting(Level::kStop, StopReason::kNoMap);
  if (s.now - supplies.map_utime > limits.map_stop)
    return waiting(Level::kStop, {StopReason::kMapStale, oldAs("MAP", s.now - supplies.map_utime)});
  if (!supplies.set_defect.empty())
    return waiting(Level::kStop, {StopReason::kBadPatterns, supplies.set_defect});
  return {};
}

/// Problems after which the vehicle finishes its pattern and stops.
Preconditions checkSupplies(const PlannerInputs& s, const MapAndSet& supplies,
                            const AgeLimits& limits, OperatorLost lost) {
  const bool at_once = !s.goal_lost.empty() && lost != OperatorLost::kFinish;
  if (!s.goal) return {at_once ? Level::kStop : Level::kFinish, PlanStatus::kIdle, s.goal_lost};
  if (s.now - supplies.map_utime > limits.map_slow)
    return waiting(Level::kFinish,
                   {StopReason::kMapStale, oldAs("MAP", s.now - supplies.map_utime)});
  if (s.now - s.set_received > limits.pattern_set)
    return waiting(Level::kFinish,
                   {StopReason::kLearnerLost,
                    "the learner is lost: " + oldAs("PATTERN_SET", s.now - s.set_received)});
  return {};
}

Preconditions checkPermission(const PlannerInputs& s, const MapAndSet& supplies,
                              const AgeLimits& limits) {
  if (s.estopped) return {Level::kStop, PlanStatus::kStopped, StopReason::kEstopEngaged};
  if (!s.bridge) return waiting(Level::kStop, StopReason::kNoMotor);
  if (s.now - s.bridge->utime > limits.bridge)
    return waiting(Level::kStop,
                   {StopReason::kMotorStale, oldAs("MOTOR", s.now - s.bridge->utime)});
  if (!s.bridge->armed())
    return {Level::kStop,
            supplies.was_armed ? PlanStatus::kStopped : PlanStatus::kWaiting,
            {s.bridge->reason.code, "motor_bridge: " + s.bridge->reason.words}};
  if (!s.armed_by_operator) return waiting(Level::kStop, StopReason::kNotArmedSince);
  return {};
}

/// Motion that may be noise or a short disturbance [m, rad].
constexpr double kWayDoubt = 0.3;
constexpr double kTurnDoubt = 0.15;
constexpr double kLeastRatio = 0.6;
constexpr double kMostRatio = 1.6;

/// Why the running or the next pattern ends at rest; none if neither does.
Reason stopAhead(const PlannedExecution& running, const CurrentPlan& plan,
                 const PatternTable& table) {
  size_t after = 0;  // index in the plan of the first step after standstill
  if (!leadsToRest(running, table)) {
    if (plan.steps.empty() || plan.steps.front().exit_class != table.restClass()) return {};
    after = 1;
  }
  if (after >= plan.steps.size())
    return {StopReason::kPlannedStop, plan.end == SearchEnd::kGoal
                                          ? "stopping at the goal"
                                          : "stopping: the plan ends there"};
  const TablePattern& next = *table.find(plan.steps[after].pattern_id);
  if (next.reverses) return {StopReason::kPlannedStop, "stopping to back up"};
  const Pose2& end = next.end().pose;
  if (std::abs(end.yaw) > std::hypot(end.x, end.y))
    return {StopReason::kPlannedStop, "stopping to turn on the spot"};
  return {StopReason::kPlannedStop, next.exit == table.restClass() ? "stopping for a small step"
                                                                   : "stopping to set off anew"};
}

}  // namespace

Preconditions checkPreconditions(const PlannerInputs& inputs, const MapAndSet& supplies,
                                 const AgeLimits& limits, OperatorLost lost) {
  Preconditions found = checkSensors(inputs, supplies, limits);
  if (found.level == Level::kGo) found = checkPermission(inputs, supplies, limits);
  if (found.level == Level::kGo) found = checkSupplies(inputs, supplies, limits, lost);
  return found;
}

MotionRatio motionRatio(const Pose2& T_start_now, double time, const TablePattern& pattern,
                        double period) {
  const Pose2 expected = poseAlong(pattern.pattern->trajectory, period, time);
  const auto ratio = [](double measured, double promised, double doubt) {
    return std::clamp((measured + doubt) / (promised + doubt), kLeastRatio, kMostRatio);
  };
  MotionRatio so_far;
  // Along the expected path: sideways slip does not lengthen it.
  const double length = std::hypot(expected.x, expected.y);
  const double along =
      length > 0.0 ? (T_start_now.x * expected.x + T_start_now.y * expected.y) / length : 0.0;
  so_far.way = ratio(along, length, kWayDoubt);
  const double sign = expected.yaw < 0.0 ? -1.0 : 1.0;
  so_far.turn = ratio(sign * T_start_now.yaw, sign * expected.yaw, kTurnDoubt);
  return so_far;
}

Prediction predict(const Pose2& T_map_body, double time, const TablePattern& pattern,
                   const PatternTable& table, const MotionRatio& so_far) {
  Prediction prediction;
  Pose2 pose = T_map_body;
  if (time < 0.0) pose = pose * integrate(table.motionClass(pattern.entry).twist, -time);
  const double period = table.set().periodSeconds();
  Pose2 before = poseAlong(pattern.pattern->trajectory, period, time);
  for (const SweptPose& at : pattern.swept_poses) {
    if (at.time <= time) continue;
    const Pose2 step = between(before, at.pose);
    pose = pose * Pose2{so_far.way * step.x, so_far.way * step.y, so_far.turn * step.yaw};
    before = at.pose;
    prediction.ahead.push_back({pose, at.time - time});
  }
  prediction.T_map_end = pose;
  prediction.time_left = pattern.duration - time;
  const double share = std::clamp(prediction.time_left / pattern.duration, 0.0, 1.0);
  prediction.uncertainty = scaled(pattern.uncertainty, share, T_map_body.yaw);
  return prediction;
}

std::optional<double> firstConflict(const CollisionChecker& collision_checker,
                                    const std::vector<ExpectedPose>& poses, int level) {
  for (const ExpectedPose& at : poses)
    if (!collision_checker.isFree(at.T_map_body, level)) return at.time;
  return std::nullopt;
}

bool leftCorridor(const Prediction& then, const Prediction& now) {
  constexpr double kSigmas = 3.0;
  constexpr double kLeastWay = 0.1;   // [m]
  constexpr double kLeastTurn = 0.1;  // [rad]
  const Pose2 off = between(then.T_map_end, now.T_map_end);
  const double way = kSigmas * std::sqrt(static_cast<double>(then.uncertainty.position()));
  const double turn = kSigmas * std::sqrt(static_cast<double>(then.uncertainty.yawyaw));
  return std::hypot(off.x, off.y) > std::max(kLeastWay, way) ||
         std::abs(wrapAngle(off.yaw)) > std::max(kLeastTurn, turn);
}

bool leadsToRest(const PlannedExecution& slot, const PatternTable& table) {
  return slot.pattern().exit_class == table.motionClass(table.restClass()).name;
}

bool ActiveSet::offer(const PatternSet& set, const ExecutionTracker& tracker) {
  waiting_ = std::make_shared<const PatternTable>(set, sweep_, sigma_, topSpeedOf(set));
  return retry(tracker);
}

double ActiveSet::topSpeedOf(const PatternSet& set) const {
  constexpr double kDrives = 0.05;  // [m/s] slower is not driving
  constexpr double kRoom =
      1.2;  // [1] by which the learner may make a pattern faster than its class
  std::optional<double> slowest[2];  // forwards and backwards
  for (const MotionPattern& pattern : set.patterns()) {
    const MotionClass& to = set.classNamed(pattern.exit_class);
    const double speed = std::hypot(to.twist.v_x, to.twist.v_y);
    if (speed < kDrives || !set.classNamed(pattern.entry_class).standing()) continue;
    std::optional<double>& least = slowest[to.twist.v_x < 0.0 ? 1 : 0];
    least = std::min(speed, least.value_or(speed));
  }
  const double needed = kRoom * std::max(slowest[0].value_or(0.0), slowest[1].value_or(0.0));
  return std::min(top_speed_, std::max(limit_, needed));
}

bool ActiveSet::limitSpeed(double speed) {
  constexpr double kSame = 0.1;  // [1] of itself: smaller changes do not justify another table
  if (std::abs(speed - limit_) <= kSame * limit_) return false;
  const double before = std::exchange(limit_, speed);
  bool changed = false;
  for (auto* table : {&table_, &waiting_}) {
    if (!*table) continue;
    const PatternSet& set = (*table)->set();
    const double top = topSpeedOf(set);
    limit_ = before;
    const bool same = topSpeedOf(set) == top;
    limit_ = speed;
    if (same) continue;
    auto limited = std::make_shared<const PatternTable>(set, sweep_, sigma_, top);
    // An unusable one would stop the vehicle.
    if (!limited->defect().empty()) continue;
    *table = std::move(limited);
    changed = true;
  }
  return changed;
}

bool ActiveSet::retry(const ExecutionTracker& tracker) {
  if (!waiting_) return false;
  refusal_ = tracker.conflictWith(waiting_->set());
  // Such a set would stop the vehicle without an apparent reason.
  const std::string defect = waiting_->defect();
  if (refusal_.empty() && !tracker.running().empty() && !defect.empty())
    refusal_ =
        "PATTERN_SET version " + std::to_string(waiting_->set().version()) + " waits: " + defect;
  if (!refusal_.empty()) return false;
  table_ = std::move(waiting_);
  waiting_.reset();
  return true;
}

const TablePattern* DrivingState::runningPattern() const {
  if (tracker.running().empty()) return nullptr;  // a set may have id 0
  const TablePattern* newest = table().find(tracker.running().pattern_id);
  // The learner changes trajectories, never commands: another length is another pattern.
  const bool same = newest != nullptr &&
                    newest->pattern->commands.size() == tracker.running().pattern().commands.size();
  return same ? newest : nullptr;
}

double DrivingState::coastTime(const Twist2& twist) const {
  return std::max(config.policy.coast_time, grip.slidingTime(std::hypot(twist.v_x, twist.v_y)));
}

PlannedWay DrivingState::search(int64_t now, const PlanStep& start, int expansions) {
  const bool may_keep_next = runningPattern() != nullptr;
  const double reaction = kReactionDelay + coastTime(table().motionClass(start.exit_class).twist);
  PlannedWay result = planner.plan({set.table(), map, groundCost(), start, plan.steps, plan.end,
                                    may_keep_next, grip.deceleration, reaction},
                                   expansions, counters);
  if (result.end == SearchEnd::kNothing && grip.gave_way)
    result.reason.words +=
        ", on ground that stops it with only " + withTenths(grip.deceleration) + " m/s2";
  plan.made = now;
  status.changed = true;
  plan.expansions = result.expansions;
  plan.risk = result.risk;
  plan.end = result.end;
  plan.time_to_go = result.end == SearchEnd::kNothing ? std::numeric_limits<double>::quiet_NaN()
                                                      : result.time_to_go;
  return result;
}

const GroundCost* DrivingState::groundCost() {
  if (config.search.shock.weight <= 0.0) return nullptr;
  if (!ground || ground_table != set.table()) {
    ground_table = set.table();
    ground.emplace(config.search.shock, shock, *ground_table);
    map.setSlowness(ground->slowness());
  }
  return &*ground;
}

bool DrivingState::sayUnreachable() {
  const std::string& why =
      map.fencedGoal().empty() ? map.distanceToGoal().problem() : map.fencedGoal();
  if (why.empty()) return false;
  plan.time_to_go = std::numeric_limits<double>::quiet_NaN();
  status.say(PlanStatus::kUnreachable, {map.whyUnreachable(), why});
  return true;
}

void DrivingState::sayDriving(int64_t now) {
  const std::string& reason = map.goalSubstitutionReason();
  status.sayDriving(now, reason.empty() ? stopAhead(tracker.running(), plan, table())
                                        : Reason(StopReason::kCloseAsPossible, reason));
}

void DrivingState::halt(int64_t now, const Reason& why) {
  tracker.stop();
  settle(now);
  status.changed = true;
  ++counters["stopped at once"];
  status.say(PlanStatus::kBlocked, {why.code, "stopped at once: " + why.words});
}

}  // namespace tread::planner
