// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <tuple>

#include <tread/message_list.hpp>

namespace tread {

/// One line of the channel table: the properties that every user of a channel must agree on.
struct ChannelSpec {
  const char* name;  ///< LCM channel; [A-Z_] only, because LCM reads it as a regular expression
  const char* type;  ///< message type
  const char* publisher;  ///< the process that may publish it
  double rate_hz;         ///< nominal rate; 0 = on demand
  int max_age_ms;         ///< older than this on receipt counts as late; 0 = no limit
  int max_bytes;          ///< largest encoded message; never above 60 kB
};

/// A channel together with its message type, so that nobody can publish the wrong type on it.
template <class Message>
struct Channel : ChannelSpec {};

inline constexpr Channel<ins_t> kIns{{"INS", "ins_t", "ins_driver", 50, 100, 400}};
inline constexpr Channel<ins_t> kScanMatching{
    {"SCAN_MATCHING", "ins_t", "scan_matching", 10, 300, 400}};
inline constexpr Channel<scan_t> kScan{{"SCAN", "scan_t", "lidar_driver", 10, 250, 60000}};
// No maximum age: a tile out of sight is old and still valid.
inline constexpr Channel<map_tile_t> kMap{{"MAP", "map_tile_t", "mapping", 5, 0, 20000}};
inline constexpr Channel<goal_t> kGoal{{"GOAL", "goal_t", "tread-goal", 1, 3000, 200}};
inline constexpr Channel<plan_t> kPlan{{"PLAN", "plan_t", "planner", 5, 1000, 20000}};
inline constexpr Channel<plan_tree_t> kPlanTree{
    {"PLAN_TREE", "plan_tree_t", "planner", 1, 3000, 60000}};
inline constexpr Channel<program_t> kProgram{{"PROGRAM", "program_t", "planner", 20, 200, 20000}};
inline constexpr Channel<motor_t> kMotor{{"MOTOR", "motor_t", "motor_bridge", 20, 150, 500}};
inline constexpr Channel<execution_t> kExecution{
    {"EXECUTION", "execution_t", "motor_bridge", 5, 1000, 2000}};
inline constexpr Channel<stopping_t> kStoppingTime{
    {"STOPPING", "stopping_t", "motor_bridge", 1, 3000, 100}};
inline constexpr Channel<pattern_set_part_t> kPatternSet{
    {"PATTERN_SET", "pattern_set_part_t", "learner", 0.5, 0, 60000}};
inline constexpr Channel<learner_state_t> kLearnerState{
    {"LEARNER_STATE", "learner_state_t", "learner", 0, 0, 60000}};
inline constexpr Channel<learning_t> kLearning{{"LEARNING", "learning_t", "learner", 0, 0, 1000}};
inline constexpr Channel<shock_t> kShock{{"SHOCK", "shock_t", "learner", 1, 3000, 300}};
inline constexpr Channel<grip_t> kGrip{{"GRIP", "grip_t", "learner", 2, 3000, 100}};
inline constexpr Channel<health_t> kHealth{{"HEALTH", "health_t", "every process", 1, 3000, 8000}};
inline constexpr Channel<arm_t> kArm{{"ARM", "arm_t", "tread-arm", 0, 1000, 1000}};
inline constexpr Channel<operator_t> kOperator{
    {"OPERATOR", "operator_t", "every operator program", 5, 1000, 400}};
inline constexpr Channel<manual_t> kManual{{"MANUAL", "manual_t", "tread-drive", 50, 200, 200}};
inline constexpr Channel<estop_t> kEstop{{"ESTOP", "estop_t", "anyone", 0, 0, 1000}};
inline constexpr Channel<fence_t> kFence{{"FENCE", "fence_t", "anyone", 0, 0, 1500}};
inline constexpr Channel<fences_t> kFences{
    {"FENCES", "fences_t", "every keeper of fences", 1, 3000, 15000}};
inline constexpr Channel<mark_t> kMark{{"MARK", "mark_t", "anyone", 0, 0, 1000}};
inline constexpr Channel<config_t> kConfig{{"CONFIG", "config_t", "every process", 0.1, 0, 60000}};

/// Whether a message can only stop the robot. Stopping is always allowed: such a message is
/// accepted from everybody, even unsealed where seals are required.
inline bool stops(const estop_t& message) {
  return message.engaged != 0;
}
inline bool stops(const arm_t& message) {
  return message.armed == 0;
}
inline bool stops(const goal_t& message) {
  return message.goal_id == 0;
}
/// Another fence only restricts the robot.
inline bool stops(const fence_t& message) {
  return message.fence_kind != fence_t::FENCE_REMOVED;
}

/// Removes what an unsealed message claims about its sender.
template <class Message>
void forgetSender(Message& /*message*/) {}
/// Otherwise a stranger's fences would be stored as those of the operator whose name they carry.
inline void forgetSender(fence_t& message) {
  message.fence_by.clear();
}

/// The whole table with its types.
inline constexpr std::tuple kTypedChannels{
    kIns,     kScanMatching, kScan,      kMap,        kGoal,         kPlan,     kPlanTree,
    kProgram, kMotor,        kExecution, kPatternSet, kLearnerState, kLearning, kShock,
    kGrip,    kHealth,       kArm,       kOperator,   kManual,       kEstop,    kStoppingTime,
    kFence,   kFences,       kMark,      kConfig};

/// The same for README, health checks and tests.
inline constexpr auto kChannels = std::apply(
    [](const auto&... channel) { return std::array{static_cast<ChannelSpec>(channel)...}; },
    kTypedChannels);

}  // namespace tread
