// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/calls.hpp"

#include <cmath>
#include <utility>

#include "common/messages/blank.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/report/text.hpp"

namespace tread::operators {
namespace {

constexpr int64_t kArmRepeat = 100'000;   // [us]
constexpr int64_t kStopRepeat = 50'000;   // [us]
constexpr int64_t kHandOver = 3'000'000;  // [us] for which a hand-over is repeated, at most
constexpr int64_t kTold = 1'500'000;      // [us] within which HEALTH names the holder
constexpr int64_t kAnswerAge = 500'000;   // [us] older MOTOR messages are ignored
/// An answer counts only after this long: what came before the call is no answer.
constexpr int64_t kSettle = 200'000;  // [us]

// [us] age limit of messages that progress is reported from
constexpr int64_t kFreshAge = 1'000'000;
constexpr int64_t kGoalRepeat = 1'000'000;  // [us]

constexpr int64_t kNoRobot = 5'000'000;  // [us] without any MOTOR until a goal is given up
/// After losing its permission on the way the robot does not continue by itself [us].
constexpr int64_t kDisarmedPatience = 2'000'000;
/// The planner confirms a goal within this time; a goal that it has ended does not come back [us].
constexpr int64_t kGoalPatience = 1'500'000;

bool isStuck(int16_t status) {
  return status == plan_t::PLAN_BLOCKED || status == plan_t::PLAN_UNREACHABLE;
}

std::string heldBy(const std::string& holder, const std::string& name) {
  return holder + " holds the robot (" + holder + " can hand it over: tread-arm --hand-over " +
         name + ")";
}

}  // namespace

// A robot with a key ignores a program without one.
std::string keyWords(const Bus& bus) {
  if (bus.hearsTwoSessions())
    return "; two robots are received with this key: one of them is a recording";
  return bus.statistics().sealed_unread ? "; the robot has a key: give it with --key" : "";
}

PermissionCall::PermissionCall(Bus& bus, const std::string& operator_name, double patience,
                               Request request)
    : bus_(bus),
      beacon_(bus, operator_name),
      request_(std::move(request)),
      patience_(static_cast<int64_t>(patience * 1e6)),
      motor_(bus, kMotor) {}

bool PermissionCall::shown(int64_t utime) const {
  return motor_.any() && motor_.age(utime) < kAnswerAge && !bus_.hearsTwoSessions() &&
         request_.served(motor_.message().bridge_state);
}

CallResult PermissionCall::step(int64_t utime) {
  if (!started_) started_ = utime;
  if (utime - *started_ > kSettle && shown(utime)) return CallResult::kDone;
  if (utime - *started_ > patience_) return CallResult::kRefused;
  if (utime < next_ || (request_.permits && !beacon_.hearsRobot())) return CallResult::kPending;
  next_ = utime + request_.repeat;
  if (seq_ == 0) was_so_ = shown(utime);
  request_.send(beacon_.robotTime(utime), seq_++);
  return CallResult::kPending;
}

std::string PermissionCall::describe(int64_t utime) const {
  if (shown(utime)) return request_.text_if_served;
  const std::string words = request_.text_if_not + keyWords(bus_) + "; ";
  if (!motor_.any()) return words + kNoMotor;
  if (motor_.age(utime) > kAnswerAge)
    return words + "MOTOR has fallen silent: look at tread-motor-bridge";
  const std::string& reason = motor_.message().state_reason;
  return words + "the motor bridge says: " + (reason.empty() ? "nothing" : reason);
}

void sendArm(Bus& bus, const Requester& requester, bool arm, int64_t utime, int64_t seq) {
  auto message = blank<arm_t>();
  message.utime = utime;
  message.seq = seq;
  message.armed = arm;
  message.armed_by = requester.signature();
  message.arm_reason = requester.why;
  bus.publish(kArm, message);
}

ArmCall::ArmCall(Bus& bus, const Requester& requester, const ArmOptions& request, double patience)
    : PermissionCall(
          bus, requester.operator_name, patience,
          {[&bus, requester, arm = request.arm](int64_t utime, int64_t seq) {
             sendArm(bus, requester, arm, utime, seq);
           },
           [arm = request.arm](int16_t bridge_state) { return mayDrive(bridge_state) == arm; },
           request.arm ? "armed" : "disarmed", request.arm ? "not armed" : "not disarmed",
           kArmRepeat, request.arm}),
      requester_(requester),
      request_(request),
      holder_(bus) {
  beacon_.handOverTo(request.hand_over_to);
}

CallResult ArmCall::handOver(int64_t utime) {
  if (holder_.since(beacon_.robotTime(*began_)) == request_.hand_over_to) return CallResult::kDone;
  return utime - *began_ > kHandOver ? CallResult::kRefused : CallResult::kPending;
}

std::string ArmCall::otherHolder() const {
  const std::string holder = holder_.since(beacon_.robotTime(began_.value_or(0))).value_or("");
  return holder == beacon_.name() ? "" : holder;
}

CallResult ArmCall::step(int64_t utime) {
  began_ = began_.value_or(utime);
  if (request_.arm) beacon_.step(utime);
  if (!request_.hand_over_to.empty()) return handOver(utime);
  // `waits_`: another operator has disarmed the robot meanwhile, so it must not be armed for this
  // one.
  if (waits_ && !shown(utime)) return CallResult::kRefused;
  if (!armed_) {
    const CallResult result = PermissionCall::step(utime);
    // The bridge may refuse a second operator, who must not believe that he holds the robot.
    const bool before = request_.arm && result == CallResult::kDone && wasSo();
    waits_ = before && request_.hold && !otherHolder().empty();
    if (waits_) return CallResult::kPending;
    if (before && !otherHolder().empty()) return CallResult::kRefused;
    const bool told = holder_.since(beacon_.robotTime(*began_)).has_value();
    if (before && !told && utime - *began_ < kTold) return CallResult::kPending;
    if (result != CallResult::kDone || !request_.hold) return result;
    armed_ = utime;
  }
  return shown(utime) ? CallResult::kPending : CallResult::kRefused;
}

std::string ArmCall::notice() const {
  if (armed_) return "armed and held: Ctrl-C disarms";
  return waits_ ? heldBy(otherHolder(), beacon_.name()) + ": waiting" : "";
}

std::string ArmCall::describe(int64_t utime) const {
  const std::string other = otherHolder();
  if (!request_.hand_over_to.empty()) {
    if (other == request_.hand_over_to) return "handed over to " + other;
    return "not handed over: " +
           (!other.empty()
                ? other + " holds the robot, not " + beacon_.name()
                : "does " + beacon_.name() + " hold it, and does a program of " +
                      request_.hand_over_to + " run (tread-arm --hold)?" + keyWords(bus_));
  }
  if (armed_ && !shown(utime)) return "not armed any more: " + bridgeReason();
  if (request_.arm && shown(utime) && wasSo() && !other.empty())
    return "armed, but not for " + beacon_.name() + ": " + heldBy(other, beacon_.name());
  const std::string before =
      shown(utime) && wasSo() ? " since before this call: " + bridgeReason() : "";
  return PermissionCall::describe(utime) + before + (armed_ ? " and held: Ctrl-C disarms" : "") +
         (request_.arm && estopped() ? "; tread-stop --clear first" : "") + beacon_.clockWords() +
         (request_.arm ? beacon_.namesakeWords(utime) : "");
}

void ArmCall::cancel(int64_t utime) {
  if (!armed_) return;
  for (int i = 0; i < 3; ++i) sendArm(bus_, requester_, false, beacon_.robotTime(utime), i);
}

StopCall::StopCall(Bus& bus, const Requester& requester, bool engage, double patience)
    : PermissionCall(bus, requester.operator_name, patience,
                     {[&bus, requester, engage](int64_t utime, int64_t seq) {
                        auto message = blank<estop_t>();
                        message.utime = utime;
                        message.seq = seq;
                        message.engaged = engage;
                        message.estop_by = requester.signature();
                        message.estop_reason = requester.why;
                        bus.publish(kEstop, message);
                      },
                      [engage](int16_t bridge_state) {
                        return (bridge_state == motor_t::STATE_ESTOP) == engage;
                      },
                      engage ? "stopped; tread-stop --clear, then tread-arm, to go on"
                             : "emergency stop cleared; tread-arm to go on",
                      engage ? "NOBODY CONFIRMS THE STOP" : "not cleared", kStopRepeat, !engage}),
      engage_(engage) {}

std::string StopCall::describe(int64_t utime) const {
  return !engage_ && wasSo() && shown(utime) ? "no emergency stop is engaged"
                                             : PermissionCall::describe(utime);
}

std::string statusWord(int16_t plan_status) {
  switch (plan_status) {
    case plan_t::PLAN_IDLE:
      return "idle";
    case plan_t::PLAN_DRIVING:
      return "driving";
    case plan_t::PLAN_ARRIVED:
      return "arrived";
    case plan_t::PLAN_WAITING:
      return "waiting";
    case plan_t::PLAN_BLOCKED:
      return "blocked";
    case plan_t::PLAN_UNREACHABLE:
      return "unreachable";
    case plan_t::PLAN_STOPPED:
      return "stopped";
    default:
      return "status " + std::to_string(plan_status);
  }
}

std::string GoalCall::patternName(int32_t id) const {
  const auto found = names_.find(id);
  return found == names_.end() ? "pattern " + std::to_string(id) : found->second;
}

std::string GoalCall::progress(int64_t utime) const {
  if (!(ins_.any() && plan_.any()) && utime - started_.value_or(0) < kFreshAge)
    return "listening to the robot";
  if (!beacon_.hearsRobot()) return kNoMotor + keyWords(bus_);
  if (ins_.age(utime) > kFreshAge) return "no INS: is tread-ins-driver running?";
  if (plan_.age(utime) > kFreshAge) return "no PLAN: is tread-planner running?";
  const plan_t& plan = plan_.message();
  const auto& place = ins_.message().position;
  const double to_go =
      std::hypot(request_.T_map_goal.x - place[0], request_.T_map_goal.y - place[1]);
  std::string text = formatted("to go %5.1f m  ", to_go) + statusWord(plan.plan_status);
  if (!plan.reason.empty()) text += " (" + plan.reason + ")";
  if (motor_.any() && motor_.message().execution_id != 0 && execution_.any() &&
      !execution_.message().records.empty())
    text += "  " + patternName(execution_.message().records.back().record_pattern_id);
  if (surface_names_) text += " on " + surface_names_({place[0], place[1]});
  if (learning_.any() && std::isfinite(learning_.message().error_position)) {
    const learning_t& learned = learning_.message();
    text += formatted("  last error %.2f m", learned.error_position) +
            formatted(" %.1f deg", std::abs(learned.error_yaw) * 180.0 / kPi);
  }
  return text + "  set " + std::to_string(plan.set_version);
}

GoalCall::GoalCall(Bus& bus, const GoalRequest& request, const std::string& operator_name,
                   int64_t goal_id, SurfaceNames surface_names)
    : bus_(bus),
      request_(request),
      goal_id_(goal_id),
      surface_names_(std::move(surface_names)),
      beacon_(bus, operator_name),
      holder_(bus),
      ins_(bus, kIns),
      plan_(bus, kPlan),
      motor_(bus, kMotor),
      execution_(bus, kExecution),
      learning_(bus, kLearning) {
  bus.subscribe<pattern_set_part_t>(kPatternSet, [this](const pattern_set_part_t& part) {
    names_[part.set_pattern_id] = part.pattern_name;
  });
  beacon_.standFor(goal_id);
}

void GoalCall::send(int64_t utime, int64_t goal_id) {
  auto goal = blank<goal_t>();
  goal.utime = beacon_.robotTime(utime);
  goal.seq = seq_++;
  goal.goal_id = goal_id;
  goal.goal_pose[0] = request_.T_map_goal.x;
  goal.goal_pose[1] = request_.T_map_goal.y;
  goal.goal_pose[2] = request_.T_map_goal.yaw;
  goal.position_tolerance = request_.position_tolerance;
  goal.yaw_tolerance = request_.yaw_tolerance;
  bus_.publish(kGoal, goal);
}

CallResult GoalCall::step(int64_t utime) {
  if (!started_) started_ = utime;
  beacon_.step(utime);
  if (utime >= next_ && beacon_.hearsRobot()) {
    send(utime, goal_id_);
    next_ = utime + kGoalRepeat;
  }
  if (!beacon_.hearsRobot() && utime - *started_ > kNoRobot) return CallResult::kRefused;
  if (lostPermission(utime) || lostGoal(utime)) return CallResult::kRefused;
  if (!plan_.any() || plan_.message().goal_id != goal_id_) return CallResult::kPending;
  const int16_t status = plan_.message().plan_status;
  if (status == plan_t::PLAN_ARRIVED) return CallResult::kDone;
  if (!isStuck(status)) stuck_since_.reset();
  if (isStuck(status) && !stuck_since_) stuck_since_ = utime;
  const auto patience = static_cast<int64_t>(request_.patience * 1e6);
  return stuck_since_ && utime - *stuck_since_ > patience ? CallResult::kRefused
                                                          : CallResult::kPending;
}

/// Disarmed for longer than the patience. A goal given before arming is void.
bool GoalCall::lostPermission(int64_t utime) {
  if (!motor_.any()) return false;
  const bool may = mayDrive(motor_.message().bridge_state);
  was_armed_ = was_armed_ || may;
  if (may) disarmed_since_.reset();
  if (!may && !disarmed_since_) disarmed_since_ = utime;
  return disarmed_since_ && utime - *disarmed_since_ > kDisarmedPatience;
}

/// The planner has dropped this goal or does not accept it.
bool GoalCall::lostGoal(int64_t utime) {
  if (!plan_.any()) return false;
  const bool has = plan_.message().goal_id == goal_id_;
  was_goal_ = was_goal_ || has;
  if (has) lost_since_.reset();
  if (!has && !lost_since_) lost_since_ = utime;
  return lost_since_ && utime - *lost_since_ > (was_goal_ ? kGoalPatience : 2 * kGoalPatience);
}

std::string GoalCall::describe(int64_t utime) const {
  std::string words = progress(utime);
  if (started_)
    words = formatted("%5.0f s  ", static_cast<double>(utime - *started_) * 1e-6) + words;
  return words + lossWords();
}

std::string GoalCall::lossWords() const {
  if (disarmed_since_) {
    const bool estopped = motor_.message().bridge_state == motor_t::STATE_ESTOP;
    return std::string(was_armed_ ? "; not armed any more (" : "; not armed (") +
           motor_.message().state_reason +
           (estopped ? "): tread-stop --clear, tread-arm" : "): tread-arm") + ", then again";
  }
  if (!lost_since_) return "";
  if (was_goal_)
    return plan_.message().goal_id != 0 ? "; another goal has replaced it"
                                        : "; the planner has dropped this goal: give it again";
  const std::string holder = holder_.since(beacon_.robotTime(*started_)).value_or("");
  return "; the planner does not take this goal; " +
         (holder.empty() || holder == beacon_.name()
              ? "the motor bridge says: " + motor_.message().state_reason + keyWords(bus_)
              : heldBy(holder, beacon_.name()));
}

void GoalCall::cancel(int64_t utime) {
  const int64_t followed = plan_.any() ? plan_.message().goal_id : 0;
  if (followed == 0 || followed == goal_id_) send(utime, 0);
}

}  // namespace tread::operators
