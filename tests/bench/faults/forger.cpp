// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/forger.hpp"

#include "common/messages/blank.hpp"
#include "common/messages/fence_messages.hpp"
#include "common/messages/pattern_messages.hpp"

namespace tread::faults {

/// A set with turns and speeds that differ from the vehicle's.
std::optional<PatternSet> wrongSet(const PatternSet& shipped, double strength, int64_t version) {
  PatternSetContent content = shipped.content();
  content.parent_version = content.version;
  content.version = version;
  const double turn = 0.4 + 1.2 * strength;
  for (MotionPattern& pattern : content.patterns)
    for (Pose2& pose : pattern.trajectory) pose = {pose.x, turn * pose.y, turn * pose.yaw};
  std::string why;
  return PatternSet::make(content, why);
}

void Forger::send(const std::string& channel, double strength) {
  ++count_;
  if (channel == "ARM") return arm();
  if (channel == "GOAL") return goal(strength);
  if (channel == "PROGRAM") return program(strength);
  if (channel == "PATTERN_SET") return patternSet(strength);
  if (channel == "ESTOP") return clearing();
  if (channel == "MAP") return map(strength);
  if (channel == "INS") return ins(strength);
  if (channel == "MANUAL") return manual(strength);
  if (channel == "FENCE") return fence(strength);
  if (channel == "STOPPING") return stopping(strength);
  notice();
}

template <class Message>
void Forger::inject(const Channel<Message>& channel, Message& message, int64_t utime) {
  message.utime = utime;
  message.seq = 1'000'000 + count_;
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  bus_.inject(channel.name, bytes.data(), bytes.size());
}

void Forger::arm() {
  auto message = blank<arm_t>();
  message.armed = true;
  message.armed_by = "mission operator";
  inject(kArm, message, bus_.now());
}

void Forger::goal(double strength) {
  auto message = blank<goal_t>();
  message.goal_id = 4711;
  message.goal_pose[0] = T_map_goal_.x + 10.0 * strength;
  message.goal_pose[1] = T_map_goal_.y - 10.0;
  message.goal_pose[2] = 0.0;
  message.position_tolerance = 0.5;
  message.yaw_tolerance = 4.0;
  inject(kGoal, message, bus_.now());
}

void Forger::program(double strength) {
  auto message = blank<program_t>();
  message.run_id = 99;
  message.lease = 200'000;
  message.running.execution_id = 1;
  message.running.slot_pattern_id = 1;
  message.running.slot_set_version = 1;
  message.running.num_channels = 2;
  message.running.channel_kind.assign(2, program_slot_t::KIND_POWER);
  message.running.period = 50'000;
  message.running.num_commands = 40;
  message.running.command.assign(40, {strength < 0.1 ? 2.0F : 1.0F, 1.0F});
  message.next = blank<program_slot_t>();
  inject(kProgram, message, bus_.now());
}

void Forger::patternSet(double strength) {
  const auto set = wrongSet(shipped_, strength, 1'000'000);
  if (!set) return;
  for (pattern_set_part_t part : toMessages(*set)) inject(kPatternSet, part, part.utime);
}

void Forger::clearing() {
  auto message = blank<estop_t>();
  message.engaged = false;
  message.estop_by = "stranger";
  inject(kEstop, message, bus_.now());
}

void Forger::map(double strength) {
  auto message = blank<map_tile_t>();
  message.tile_cells = 32;
  message.cell_size = strength < 0.2 ? 0.05 : 0.1;
  message.tile_x = static_cast<int32_t>(count_ % 7) - 3;
  message.tile_y = static_cast<int32_t>(count_ / 7 % 7) - 3;
  message.num_cells = message.tile_cells * message.tile_cells;
  message.cells.assign(static_cast<size_t>(message.num_cells), strength < 0.6 ? 0 : 254);
  inject(kMap, message, bus_.now() + 40'000);
}

void Forger::ins(double strength) {
  auto message = blank<ins_t>();
  message.position[0] = 5.0 * strength;
  message.position[1] = message.position[2] = 0.0;
  for (double& number : message.orientation) number = 0.0;
  message.orientation[0] = 1.0;
  message.ins_status = 0;
  inject(kIns, message, bus_.now());
}

void Forger::notice() {
  auto message = blank<operator_t>();
  message.station = 4712;
  message.operator_name = name();
  message.allowed = operator_t::ALLOW_DRIVING;
  message.seen_utime = bus_.now();
  inject(kOperator, message, bus_.now());
}

void Forger::manual(double strength) {
  auto message = blank<manual_t>();
  message.station = strength < 0.3 ? 1 : 4711;
  message.operator_name = name();
  message.seen_utime = bus_.now();
  message.hold = strength < 0.7;
  message.give_back = strength > 0.85;
  const bool moves = count_ % 4 != 0;
  message.hand_left = moves ? static_cast<float>(2.2 * strength - 1.0) : 0.0F;
  message.hand_right = moves ? 0.5F : 0.0F;
  inject(kManual, message, bus_.now());
}

void Forger::fence(double strength) {
  FenceRequest request{name(), strength < 0.4, {strength < 0.2 ? "across" : "forged", true, {}}};
  const double x = T_map_goal_.x * strength, y = T_map_goal_.y * strength;
  const double size = strength > 0.9 ? 1e9 : 1.0 + static_cast<double>(count_ % 3);
  if (!request.removes) request.fence.corners = {{x, y}, {x + size, y}, {x, y + size}};
  fence_t message = toMessage(request);
  inject(kFence, message, bus_.now());
}

void Forger::stopping(double strength) {
  constexpr double kTimes[] = {0.0, 0.05, 0.3, 2.0, 5.0, 1e9, -1.0, -0.5};
  auto message = blank<stopping_t>();
  message.stopping_time = kTimes[static_cast<size_t>(7.99 * strength)];
  message.stops = 4711;
  inject(kStoppingTime, message, bus_.now());
}

std::string Forger::name() const {
  return count_ % 2 == 0 ? "mission operator" : "stranger";
}

}  // namespace tread::faults
