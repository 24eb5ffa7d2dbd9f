// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "common/bus/channels.hpp"

namespace tread::testing {

/// A message with a value in every field, the same on every platform. One specialization per type.
template <class Message>
Message sampleOf();

template <>
inline arm_t sampleOf<arm_t>() {
  arm_t m{};
  m.utime = 1'000'001;
  m.seq = 1;
  m.armed = 1;
  m.armed_by = "operator";
  m.arm_reason = "ready";
  return m;
}

template <>
inline config_t sampleOf<config_t>() {
  config_t m{};
  m.utime = 1'000'002;
  m.seq = 2;
  m.config_process = "planner";
  m.config_boot_id = 999;
  m.config_text = "lease: 0.2\n";
  return m;
}

template <>
inline counter_t sampleOf<counter_t>() {
  counter_t m{};
  m.counter_name = "checksum";
  m.counted = 1LL << 40;
  return m;
}

template <>
inline estop_t sampleOf<estop_t>() {
  estop_t m{};
  m.utime = 1'000'003;
  m.seq = 3;
  m.engaged = 1;
  m.estop_by = "tread-stop";
  m.estop_reason = "child on the field";
  return m;
}

template <>
inline execution_record_t sampleOf<execution_record_t>() {
  execution_record_t m{};
  m.record_run_id = 11;
  m.record_execution_id = 12;
  m.record_pattern_id = 13;
  m.record_set_version = 14;
  m.started = 5'000'000;
  m.ended = -1;
  m.commands_played = 15;
  m.commands_total = 40;
  m.outcome = execution_record_t::OUTCOME_ABORTED;
  m.outcome_code = 71;
  m.outcome_reason = "lease expired";
  return m;
}

template <>
inline execution_t sampleOf<execution_t>() {
  execution_t m{};
  m.utime = 1'000'004;
  m.seq = 4;
  m.num_records = 2;
  m.records = {sampleOf<execution_record_t>(), sampleOf<execution_record_t>()};
  m.records[1].record_execution_id = 99;
  return m;
}

template <>
inline goal_t sampleOf<goal_t>() {
  goal_t m{};
  m.utime = 1'000'005;
  m.seq = 5;
  m.goal_id = 77;
  m.goal_pose[0] = 12.5;
  m.goal_pose[1] = -3.25;
  m.goal_pose[2] = 1.5;
  m.position_tolerance = 0.5;
  m.yaw_tolerance = 3.5;
  return m;
}

template <>
inline health_t sampleOf<health_t>() {
  health_t m{};
  m.utime = 1'000'006;
  m.seq = 6;
  m.utc = 1'700'000'000'000'000;
  m.process = "mapping";
  m.boot_id = 555;
  m.health_state = health_t::HEALTH_DEGRADED;
  m.health_reason = "no scan for 1.2 s";
  m.received = 100;
  m.undecodable = 1;
  m.lost = 2;
  m.late = 3;
  m.cycle_mean = 1500;
  m.cycle_max = 9000;
  m.num_counters = 2;
  m.counters = {sampleOf<counter_t>(), sampleOf<counter_t>()};
  return m;
}

template <>
inline ins_t sampleOf<ins_t>() {
  ins_t m{};
  m.utime = 1'000'007;
  m.seq = 7;
  m.device_utc = 1'700'000'000'123'456;
  for (int i = 0; i < 3; ++i) {
    m.position[i] = 1.5 + i;
    m.velocity[i] = -0.5 * i;
    m.rate[i] = 0.125 * i;
    m.position_std[i] = 0.0625;
    m.attitude_std[i] = std::numeric_limits<double>::quiet_NaN();
  }
  m.orientation[0] = 1.0;
  m.orientation[3] = -0.0;
  m.ins_status = ins_t::STATUS_GAP | ins_t::STATUS_NO_ATTITUDE;
  m.satellites = -1;
  return m;
}

template <>
inline learner_state_t sampleOf<learner_state_t>() {
  learner_state_t m{};
  m.utime = 1'000'008;
  m.seq = 8;
  m.state_version = 42;
  m.state_part = 1;
  m.state_part_count = 2;
  m.rule_name = "collective";
  m.state_bytes = {0, 1, 127, 128, 255};
  m.num_bytes = 5;
  return m;
}

template <>
inline learning_t sampleOf<learning_t>() {
  learning_t m{};
  m.utime = 1'000'009;
  m.seq = 9;
  m.learned_run_id = 21;
  m.learned_execution_id = 22;
  m.learned_pattern_id = 23;
  m.learned_pattern_name = "left";
  m.learning_rule = "single";
  m.accepted = 1;
  m.changed = 1;
  m.gate_code = 11;
  m.gate_reason = "entry twist";
  m.scored_version = 24;
  m.result_version = 25;
  m.error_position = 0.25;
  m.error_yaw = -0.5;
  m.error_position_after = 0.125;
  m.error_yaw_after = 0.0625;
  for (int i = 0; i < 3; ++i) {
    m.measured_end[i] = 2.0 + i;
    m.predicted_end[i] = 2.5 + i;
    m.scaling[i] = 0.75 + i;
    m.measured_entry[i] = -1.0 * i;
  }
  m.path_length = 2.75;
  m.change_reason = "as surface 2";
  m.ground_changed = 0.625;
  m.surface = 2;
  m.surface_probability = 0.875;
  m.slope = 0.03125;
  return m;
}

template <>
inline map_tile_t sampleOf<map_tile_t>() {
  map_tile_t m{};
  m.utime = 1'000'010;
  m.seq = 10;
  m.tile_x = -3;
  m.tile_y = 4;
  m.tile_cells = 2;
  m.cell_size = 0.1;
  m.num_cells = 4;
  m.cells = {map_tile_t::CELL_FREE, map_tile_t::CELL_COST_MAX,
             static_cast<uint8_t>(map_tile_t::CELL_OBSTACLE),
             static_cast<uint8_t>(map_tile_t::CELL_UNKNOWN)};
  return m;
}

template <>
inline mark_t sampleOf<mark_t>() {
  mark_t m{};
  m.utime = 1'000'011;
  m.seq = 11;
  m.mark_kind = "surface";
  m.mark_value = "wet grass";
  return m;
}

template <>
inline motor_t sampleOf<motor_t>() {
  motor_t m{};
  m.utime = 1'000'012;
  m.seq = 12;
  m.motor_run_id = 31;
  m.execution_id = 32;
  m.command_index = 33;
  m.bridge_state = motor_t::STATE_DRIVING;
  m.holder = "ada";
  m.state_code = 1002;
  m.state_reason = "playing";
  m.channel_kind[0] = m.channel_kind[1] = program_slot_t::KIND_POWER;
  m.command[0] = 0.5F;
  m.command[1] = -0.25F;
  m.device_fault = 16;
  m.battery_voltage = 24.5F;
  m.current[0] = 3.5F;
  m.current[1] = -1.5F;
  m.measured[0] = std::numeric_limits<float>::quiet_NaN();
  m.measured[1] = 1.25F;
  return m;
}

template <>
inline manual_t sampleOf<manual_t>() {
  manual_t m{};
  m.utime = 1'000'018;
  m.seq = 18;
  m.station = 777;
  m.operator_name = "ada@station";
  m.seen_utime = 1'000'015;
  m.hold = true;
  m.give_back = false;
  m.hand_left = 0.5F;
  m.hand_right = -0.25F;
  return m;
}

template <>
inline fence_t sampleOf<fence_t>() {
  fence_t m{};
  m.utime = 1'000'019;
  m.seq = 19;
  m.fence_by = "ada@station";
  m.fence_name = "yard";
  m.fence_kind = fence_t::FENCE_KEEP_OUT;
  m.num_corners = 3;
  m.corners = {{1.0, -2.0}, {3.5, -2.0}, {3.5, 4.0}};
  return m;
}

template <>
inline fences_t sampleOf<fences_t>() {
  fences_t m{};
  m.utime = 1'000'025;
  m.seq = 25;
  m.keeper = "planner";
  m.num_own = 1;
  m.num_fences = 2;
  m.fences = {sampleOf<fence_t>(), sampleOf<fence_t>()};
  return m;
}

template <>
inline shock_t sampleOf<shock_t>() {
  shock_t m{};
  m.utime = 1'000'024;
  m.seq = 24;
  for (int i = 0; i < 3; ++i) m.shock_weights[i] = -1.0 + 1.5 * i;
  for (int i = 0; i < 6; ++i) m.shock_covariance[i] = 0.125 * (i + 1);
  m.shock_variance = 0.25;
  m.shock_pairs = 77;
  m.here_shock = 0.015625;
  m.felt_shock = 0.75;
  m.felt_peak = 2.25;
  m.felt_pitch_rate = 0.1875;
  m.felt_speed = 1.0625;
  return m;
}

template <>
inline grip_t sampleOf<grip_t>() {
  grip_t m{};
  m.utime = 1'000'025;
  m.seq = 25;
  m.deceleration = 0.625;
  m.gave_way = 1;
  m.grip_signs = 5;
  return m;
}

template <>
inline stopping_t sampleOf<stopping_t>() {
  stopping_t m{};
  m.utime = 1'000'020;
  m.seq = 20;
  m.stopping_time = 0.375;
  m.stops = 7;
  return m;
}

template <>
inline operator_t sampleOf<operator_t>() {
  operator_t m{};
  m.utime = 1'000'017;
  m.seq = 17;
  m.station = 777;
  m.operator_name = "ada@station";
  m.allowed = operator_t::ALLOW_DRIVING;
  m.seen_utime = 1'000'015;
  m.stands_for = 5;
  m.hand_over_to = "bob";
  return m;
}

template <>
inline pattern_set_part_t sampleOf<pattern_set_part_t>() {
  pattern_set_part_t m{};
  m.utime = 1'000'013;
  m.seq = 13;
  m.set_version = 8;
  m.parent_version = 7;
  m.set_checksum = 0x1234567890abcdef;
  m.set_name = "shipped";
  m.part = 1;
  m.part_count = 3;
  m.set_pattern_id = 5;
  m.pattern_name = "left";
  m.num_channels = 2;
  m.channel_name = {"throttle", "steering"};
  m.channel_kind = {program_slot_t::KIND_TRACK_SPEED, program_slot_t::KIND_STEERING_ANGLE};
  m.channel_lowest = {-1.0, -0.5};
  m.channel_highest = {2.0, 0.5};
  m.set_period = 50'000;
  m.entry_class = "cruise";
  m.exit_class = "rest";
  for (int i = 0; i < 3; ++i) m.entry_twist[i] = 1.0 + i;
  for (int i = 0; i < 3; ++i) m.exit_twist[i] = 0.5 * i;
  m.entry_steady = {0.75, 1.75};
  m.exit_steady = {0.0, 0.25};
  m.num_samples = 2;
  m.command = {{0.5, 1.0}, {-0.5, 0.25}};
  m.trajectory = {{0.125, 0.0, 0.25}, {0.25, 0.0625, 0.5}};
  for (int i = 0; i < 6; ++i) m.end_covariance[i] = 0.001953125 * i;
  m.times_learned = 6;
  return m;
}

template <>
inline plan_t sampleOf<plan_t>() {
  plan_t m{};
  m.utime = 1'000'014;
  m.seq = 14;
  m.goal_id = 77;
  m.set_version = 8;
  m.plan_status = plan_t::PLAN_BLOCKED;
  m.reason_code = 161;
  m.reason = "no free pattern";
  m.time_to_go = 12.5;
  m.risk = 0.002;
  m.risk_per_metre = 0.0005;
  m.expansions = 1234;
  m.search_time = 25'000;
  m.num_patterns = 2;
  m.execution_id = {41, 0};
  m.pattern_id = {3, 4};
  m.pose = {{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  m.covariance = {{0.5, 0.0, 0.0, 0.5, 0.0, 0.25}, {1.0, 0.0, 0.0, 1.0, 0.0, 0.5}};
  return m;
}

template <>
inline plan_tree_t sampleOf<plan_tree_t>() {
  plan_tree_t m{};
  m.utime = 1'000'015;
  m.seq = 15;
  m.num_nodes = 2;
  m.parent = {-1, 0};
  m.by_pattern = {-1, 7};
  m.node_pose = {{0.0F, 0.0F, 0.0F}, {1.5F, 0.5F, -0.25F}};
  m.time_at = {0.0F, 2.0F};
  m.num_best = 2;
  m.best = {0, 1};
  return m;
}

template <>
inline program_slot_t sampleOf<program_slot_t>() {
  program_slot_t m{};
  m.execution_id = 51;
  m.slot_pattern_id = 52;
  m.slot_set_version = 53;
  m.num_channels = 2;
  m.channel_kind = {program_slot_t::KIND_POWER, program_slot_t::KIND_STEERING_ANGLE};
  m.period = 50'000;
  m.num_commands = 3;
  m.command = {{0.5F, -0.5F}, {0.75F, -0.75F}, {1.0F, -1.0F}};
  return m;
}

template <>
inline program_t sampleOf<program_t>() {
  program_t m{};
  m.utime = 1'000'016;
  m.seq = 16;
  m.run_id = 61;
  m.lease = 200'000;
  m.running = sampleOf<program_slot_t>();
  m.next = sampleOf<program_slot_t>();
  m.next.execution_id = 62;
  m.inputs_heard = 63;
  m.newest_input = "INS";
  m.newest_input_utime = 1'000'012;
  m.newest_input_seq = 12;
  return m;
}

template <>
inline scan_t sampleOf<scan_t>() {
  scan_t m{};
  m.utime = 1'000'017;
  m.seq = 17;
  m.sensor_position[0] = 0.25;
  m.sensor_orientation[0] = 1.0;
  m.duration = 25'000;
  m.angle_first = -2.25;
  m.angle_step = 0.0078125;
  m.range_min = 0.0625;
  m.range_max = 30.0;
  m.num_beams = 3;
  m.ranges = {1.5F, std::numeric_limits<float>::infinity(),
              std::numeric_limits<float>::quiet_NaN()};
  m.num_points = 1;
  m.points = {{1.0F, -2.0F, 0.5F}};
  return m;
}

/// Calls `visit` with a sample of each type.
template <class Visitor>
void forEachType(Visitor&& visit) {
  const auto visitAll = [&](const auto&... samples) { (visit(samples), ...); };
  visitAll(sampleOf<arm_t>(), sampleOf<config_t>(), sampleOf<counter_t>(), sampleOf<estop_t>(),
           sampleOf<execution_record_t>(), sampleOf<execution_t>(), sampleOf<fence_t>(),
           sampleOf<fences_t>(), sampleOf<goal_t>(), sampleOf<health_t>(), sampleOf<ins_t>(),
           sampleOf<learner_state_t>(), sampleOf<learning_t>(), sampleOf<map_tile_t>(),
           sampleOf<mark_t>(), sampleOf<motor_t>(), sampleOf<operator_t>(), sampleOf<manual_t>(),
           sampleOf<pattern_set_part_t>(), sampleOf<plan_t>(), sampleOf<plan_tree_t>(),
           sampleOf<program_slot_t>(), sampleOf<program_t>(), sampleOf<scan_t>(),
           sampleOf<shock_t>(), sampleOf<stopping_t>(), sampleOf<grip_t>());
}

/// Calls `visit` with each typed channel and a sample of its type.
template <class Visitor>
void forEachChannel(Visitor&& visit) {
  const auto visitOne = [&](const auto& channel, const auto& sample) { visit(channel, sample); };
  visitOne(kIns, sampleOf<ins_t>());
  visitOne(kScanMatching, sampleOf<ins_t>());
  visitOne(kScan, sampleOf<scan_t>());
  visitOne(kMap, sampleOf<map_tile_t>());
  visitOne(kGoal, sampleOf<goal_t>());
  visitOne(kPlan, sampleOf<plan_t>());
  visitOne(kPlanTree, sampleOf<plan_tree_t>());
  visitOne(kProgram, sampleOf<program_t>());
  visitOne(kMotor, sampleOf<motor_t>());
  visitOne(kExecution, sampleOf<execution_t>());
  visitOne(kShock, sampleOf<shock_t>());
  visitOne(kGrip, sampleOf<grip_t>());
  visitOne(kStoppingTime, sampleOf<stopping_t>());
  visitOne(kPatternSet, sampleOf<pattern_set_part_t>());
  visitOne(kLearnerState, sampleOf<learner_state_t>());
  visitOne(kLearning, sampleOf<learning_t>());
  visitOne(kHealth, sampleOf<health_t>());
  visitOne(kArm, sampleOf<arm_t>());
  visitOne(kOperator, sampleOf<operator_t>());
  visitOne(kEstop, sampleOf<estop_t>());
  visitOne(kFence, sampleOf<fence_t>());
  visitOne(kFences, sampleOf<fences_t>());
  visitOne(kMark, sampleOf<mark_t>());
  visitOne(kConfig, sampleOf<config_t>());
  visitOne(kManual, sampleOf<manual_t>());
}

template <class Message>
std::vector<uint8_t> encode(const Message& message) {
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  const int size = static_cast<int>(bytes.size());
  if (message.encode(bytes.data(), 0, size) != size) bytes.clear();
  return bytes;
}

/// Whether these bytes decode completely as a message.
// Not inlined: g++ 12 reports a variable of the generated code as uninitialized otherwise.
template <class Message>
[[gnu::noinline]] bool decode(const std::vector<uint8_t>& bytes, Message& message) {
  const int size = static_cast<int>(bytes.size());
  return message.decode(bytes.data(), 0, size) == size;
}

}  // namespace tread::testing
