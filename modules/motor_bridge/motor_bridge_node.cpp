// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/motor_bridge_node.hpp"

#include <array>
#include <cmath>

#include "common/messages/blank.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/messages/operator_beacon.hpp"

namespace tread::motor {
namespace {

void readTimes(ConfigReader& reader, BridgeConfig& bridge) {
  reader.seconds("step", bridge.step_us, {0.001, 0.02});
  reader.seconds("command_interval", bridge.command_interval_us, {0.01, 0.05});
  reader.seconds("lease", bridge.gate.lease_us, {0.05, 0.2});
  reader.seconds("ins_period", bridge.ins.period_us, {0.002, 0.1});
  reader.seconds("ins_max_latency", bridge.ins.max_latency_us, {0.0, 0.5});
  if (bridge.command_interval_us % bridge.step_us != 0)
    throw reader.error("command_interval", "must be a multiple of step");
  bridge.gate.slot.step_us = bridge.step_us;
}

/// Limits from the robot's description, and from the section.
MotionLimits readMotion(ConfigReader section, const RobotDescription& robot) {
  MotionLimits motion;
  const bool power = robot.drive.kind == CommandKind::kPower;
  motion.gauge = robot.gauge;
  motion.wheelbase = robot.drive.wheelbase;
  motion.wheels = robot.drive.wheels;
  motion.full_speed = robot.drive.topSpeed();
  motion.speed_per_command = power ? robot.drive.full_speed : 1.0;
  motion.dead_band = power ? 0.15 : 0.05;
  section.number("dead_band", motion.dead_band, {0.0, 0.4}, "of full_speed");
  section.number("delay", motion.delay, {0.05, 0.6}, "s");
  section.number("lag", motion.lag, {0.05, 1.0}, "s");
  section.number("acceleration", motion.acceleration, {0.5, 20.0}, "m/s2");
  section.number("least_travel", motion.least_travel, {0.2, 0.9}, "1");
  section.number("least_turn", motion.least_turn, {0.1, 0.9}, "1");
  section.number("pull", motion.pull, {0.05, 0.5}, "1");
  section.number("time_error", motion.time_error, {0.01, 0.3}, "s");
  return motion;
}

ManualLimits readManual(ConfigReader section, const RobotDescription& robot) {
  const DriveDescription& drive = robot.drive;
  ManualLimits manual;
  manual.wheels = drive.wheels;
  manual.gauge = robot.gauge;
  manual.max_command = 0.5 * drive.max_command;
  manual.slew = drive.max_command;
  manual.max_steering = drive.max_steering;
  section.seconds("lease", manual.lease_us, {0.05, 0.2});
  section.number("max_command", manual.max_command, {0.0, drive.max_command}, "of the drive");
  section.number("slew", manual.slew, {0.05 * drive.max_command, 5.0 * drive.max_command}, "per s");
  return manual;
}

/// Keeps MOTOR and EXECUTION below their size limits, for any operator's reason.
constexpr size_t kMaxReason = 120;

ProgramSlot fromMessage(const program_slot_t& message) {
  ProgramSlot slot;
  slot.execution_id = message.execution_id;
  slot.pattern_id = message.slot_pattern_id;
  slot.set_version = message.slot_set_version;
  for (const int16_t kind : message.channel_kind)
    slot.kinds.push_back(static_cast<CommandKind>(kind));
  slot.period_us = message.period;
  slot.series.reserve(message.command.size());
  for (const std::vector<float>& values : message.command) {
    Command& command = slot.series.emplace_back();
    // Surplus channels are refused by their kinds.
    for (size_t i = 0; i < std::min(values.size(), Command::kMaxChannels); ++i)
      command[i] = static_cast<double>(values[i]);
  }
  return slot;
}

std::string reasonOf(const FailsafeOutputs& failsafe) {
  const std::string reason = failsafe.standing_said
                                 ? failsafe.reason
                                 : failsafe.reason + "; now: " + failsafe.standing_fault.words;
  return reason.substr(0, kMaxReason);
}

constexpr int64_t kMotorPeriod = 50'000;       // 20 Hz, and on every change
constexpr int64_t kExecutionPeriod = 200'000;  // 5 Hz, and on every change
constexpr int64_t kCounterPeriod = 500'000;
constexpr int64_t kStoppingPeriod = 1'000'000;
/// A line that accepted no bytes is tried again after this time [us].
constexpr int64_t kFullLinePause = 100'000;
/// The bytes of a flooding device are cut off here until the next step.
constexpr size_t kMaxBytesPerStep = 16384;
constexpr int kShutdownZeros = 3;

const std::string kShutdown = "the end of motor_bridge";

bool sameToReaders(const BridgeOutput& a, const BridgeOutput& b) {
  return !a.failsafe.changed && a.command == b.command && a.execution_id == b.execution_id &&
         a.command_index == b.command_index && a.failsafe.state == b.failsafe.state &&
         a.failsafe.reason == b.failsafe.reason;
}

}  // namespace

MotorBridgeConfig readMotorBridgeConfig(ConfigReader& reader) {
  MotorBridgeConfig config;
  reader.text("address", config.address);
  readTimes(reader, config.bridge);
  const RobotDescription robot = readRobot(reader);
  const DriveDescription& drive = robot.drive;
  config.bridge.operators = robot.operators;
  config.bridge.tilt = robot.tilt;
  config.bridge.fences = {robot.fences, robot.outline, robot.stopping_time};
  config.bridge.motion = readMotion(reader.section("motion_monitor"), robot);
  config.bridge.manual = readManual(reader.section("manual"), robot);
  config.bridge.gate.slot.channels = drive.channels();
  config.make_controller = readMotorController(reader, drive, config.controller);
  reader.finish();
  config.effective = reader.effective();
  return config;
}

Program fromMessage(const program_t& message) {
  Program program;
  program.utime = message.utime;
  program.seq = message.seq;
  program.run_id = message.run_id;
  program.lease_us = message.lease;
  program.running = fromMessage(message.running);
  program.next = fromMessage(message.next);
  return program;
}

namespace {

InsTilt tiltOf(const ins_t& message, const YawPitchRoll& attitude) {
  InsTilt tilt;
  tilt.utime = message.utime;
  // A quaternion of another length is no attitude: it would seem level.
  const bool unit = std::abs(Eigen::Vector4d(message.orientation).norm() - 1.0) < 1e-3;
  if (!unit || (message.ins_status & ins_t::STATUS_NO_ATTITUDE) != 0) return tilt;
  tilt.roll = attitude.roll;
  tilt.pitch = attitude.pitch;
  tilt.roll_rate = message.rate[0];
  tilt.pitch_rate = message.rate[1];
  return tilt;
}

}  // namespace

InsNotice fromMessage(const ins_t& message) {
  const auto& q = message.orientation;
  const Eigen::Quaterniond R_map_body(q[0], q[1], q[2], q[3]);
  const YawPitchRoll attitude = yawPitchRoll(R_map_body.normalized());
  const InsMotion motion{message.utime,   message.position[0],   message.position[1],
                         attitude.yaw,    message.velocity[0],   message.velocity[1],
                         message.rate[2], horizontalStd(message)};
  return {message.utime, planarPose(message).has_value(), motion, message.seq,
          tiltOf(message, attitude)};
}

ManualNotice fromMessage(const manual_t& message) {
  return {message.station,   message.operator_name,  message.seq,       message.seen_utime,
          message.hold != 0, message.give_back != 0, message.hand_left, message.hand_right};
}

execution_record_t toMessage(const ExecutionRecord& record) {
  auto message = blank<execution_record_t>();
  message.record_run_id = record.run_id;
  message.record_execution_id = record.execution_id;
  message.record_pattern_id = record.pattern_id;
  message.record_set_version = record.set_version;
  message.started = record.started;
  message.ended = record.ended;
  message.commands_played = record.commands_played;
  message.commands_total = record.commands_total;
  message.outcome = static_cast<int16_t>(record.outcome);
  message.outcome_code = static_cast<int16_t>(record.reason.code);
  message.outcome_reason = record.reason.words.substr(0, kMaxReason);
  return message;
}

motor_t toMessage(const BridgeOutput& output, const MotorTelemetry& telemetry, size_t channels) {
  auto message = blank<motor_t>();
  message.motor_run_id = output.run_id;
  message.execution_id = output.execution_id;
  message.command_index = output.command_index;
  message.bridge_state = static_cast<int16_t>(output.failsafe.state);
  message.state_code = static_cast<int16_t>(output.failsafe.cause.code);
  message.state_reason = reasonOf(output.failsafe);
  for (size_t i = 0; i < output.kinds.size(); ++i)
    message.channel_kind[i] = static_cast<int16_t>(output.kinds[i]);
  for (size_t i = 0; i < channels; ++i) {
    message.command[i] = static_cast<float>(output.command[i]);
    message.current[i] = static_cast<float>(telemetry.current[i]);
    message.measured[i] = static_cast<float>(telemetry.measured[i]);
  }
  message.device_fault = telemetry.device_flags;
  message.battery_voltage = static_cast<float>(telemetry.battery_voltage);
  return message;
}

MotorBridgeNode::MotorBridgeNode(const MotorBridgeConfig& config, Bus& bus, Link& link)
    : config_(config),
      bus_(bus),
      link_(link),
      bridge_(config.bridge),
      controller_(config.make_controller()),
      health_(bus, "motor_bridge", config.effective),
      fence_exchange_(bus, "motor_bridge", "planner", [this](const FenceRequest& request) {
        bridge_.receive(request, bus_.now());
      }) {
  listen();
}

void MotorBridgeNode::listen() {
  health_.watchNamesakes();
  bus_.subscribe<program_t>(kProgram, [this](const program_t& message) {
    bridge_.receive(fromMessage(message), bus_.now());
  });
  bus_.subscribe<ins_t>(
      kIns, [this](const ins_t& message) { bridge_.receive(fromMessage(message), bus_.now()); });
  bus_.subscribe<operator_t>(kOperator, [this](const operator_t& message) { take(message); });
  bus_.subscribe<manual_t>(kManual, [this](const manual_t& message) {
    bridge_.receive(fromMessage(message), bus_.now());
  });
  bus_.subscribe<arm_t>(kArm, [this](const arm_t& message) {
    bridge_.receive(
        ArmRequest{message.utime, message.armed != 0, message.armed_by, message.arm_reason},
        bus_.now());
  });
  bus_.subscribe<fence_t>(kFence, [this](const fence_t& message) {
    bridge_.receive(requestFrom(message), bus_.now());
  });
  bus_.subscribe<estop_t>(kEstop, [this](const estop_t& message) {
    bridge_.receive(
        EstopRequest{message.utime, message.engaged != 0, message.estop_by, message.estop_reason},
        bus_.now());
  });
}

void MotorBridgeNode::take(const operator_t& message) {
  const std::optional<OperatorNotice> notice = noticeFrom(message);
  if (!notice)
    return health_.addToCounter("OPERATOR ignored: its name is empty, too long or no text");
  bridge_.receive(*notice, bus_.now());
}

void MotorBridgeNode::step(int64_t utime) {
  readLink(utime);
  drive(utime);
  publishMotor(utime);
  publishExecutions(utime);
  publishStopping(utime);
  fence_exchange_.step(bridge_.fences());
  reportHealth();
  reportCounters(utime);
  health_.step(utime);
}

void MotorBridgeNode::readLink(int64_t utime) {
  if (!link_.isOpen()) {
    controller_->close(link_.problem());
    if (!link_.reopen(utime)) return;
  }
  if (!controller_->isOpen() && utime >= next_open_) controller_->open();
  std::array<uint8_t, 1024> buffer;
  for (size_t total = 0; total < kMaxBytesPerStep;) {
    const std::optional<size_t> size = link_.read(buffer.data(), buffer.size());
    if (!size) {
      controller_->close(link_.problem());
      return;
    }
    if (*size == 0) return;
    controller_->receive({reinterpret_cast<const char*>(buffer.data()), *size}, utime);
    total += *size;
  }
}

void MotorBridgeNode::drive(int64_t utime) {
  bridge_.receive(controller_->telemetry());
  output_ = bridge_.step(utime, controller_->report(utime));
  controller_->holdStop(output_.hold_device_stop);
  if (output_.release_device_stop) controller_->releaseStop(utime);
  if (output_.send) {
    controller_->command(output_.command, utime);
    periods_.sent(utime);
  }
  writeLink(controller_->poll(utime), utime);
}

void MotorBridgeNode::writeLink(const std::string& bytes, int64_t utime) {
  if (bytes.empty() || link_.write(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()))
    return;
  controller_->close(link_.isOpen() ? "nobody reads the line" : link_.problem());
  next_open_ = utime + kFullLinePause;
}

void MotorBridgeNode::publishMotor(int64_t utime) {
  if (utime < next_motor_ && sameToReaders(output_, published_) && holder_ == bridge_.holder())
    return;
  motor_t message =
      toMessage(output_, controller_->telemetry(), config_.bridge.gate.slot.channels.size());
  message.utime = utime;
  message.seq = seq_motor_++;
  message.holder = holder_ = bridge_.holder();
  bus_.publish(kMotor, message);
  published_ = output_;
  next_motor_ = utime + kMotorPeriod;
}

void MotorBridgeNode::publishExecutions(int64_t utime) {
  const ExecutionLog& log = bridge_.executions();
  if (utime < next_execution_ && log.revision() == published_revision_) return;
  auto message = blank<execution_t>();
  message.utime = utime;
  message.seq = seq_execution_++;
  for (const ExecutionRecord& record : log.records()) message.records.push_back(toMessage(record));
  message.num_records = static_cast<int32_t>(message.records.size());
  bus_.publish(kExecution, message);
  published_revision_ = log.revision();
  next_execution_ = utime + kExecutionPeriod;
}

void MotorBridgeNode::publishStopping(int64_t utime) {
  if (utime < next_stopping_) return;
  next_stopping_ = utime + kStoppingPeriod;
  auto message = blank<stopping_t>();
  message.utime = utime;
  message.seq = seq_stopping_++;
  message.stopping_time = bridge_.stopping().seconds();
  message.stops = bridge_.stopping().count();
  bus_.publish(kStoppingTime, message);
}

void MotorBridgeNode::reportHealth() {
  const FailsafeOutputs& failsafe = output_.failsafe;
  if (!controller_->ready()) {
    health_.setState(health_t::HEALTH_FAILED,
                     link_.address() + ": " + failsafe.standing_fault.words);
  } else if (!failsafe.standing_fault.empty()) {
    health_.setState(health_t::HEALTH_DEGRADED, failsafe.standing_fault.words);
  } else if (failsafe.state == BridgeState::kFault || failsafe.state == BridgeState::kEstop) {
    health_.setState(health_t::HEALTH_DEGRADED, failsafe.reason);
  } else if (const std::string line = controller_->lineProblem(); !line.empty()) {
    health_.setState(health_t::HEALTH_DEGRADED, link_.address() + ": " + line);
  } else {
    health_.setState(health_t::HEALTH_OK, "");
  }
}

void MotorBridgeNode::reportCounters(int64_t utime) {
  if (utime < next_counters_) return;
  next_counters_ = utime + kCounterPeriod;
  for (const auto& [name, count] : bridge_.counters()) health_.setCounter(name, count);
  for (const auto& [name, count] : controller_->counters()) health_.setCounter(name, count);
  reportDevice();
}

void MotorBridgeNode::reportDevice() {
  const CommandPeriods::Summary period = periods_.summary();
  health_.setCounter("command period: least [us]", period.least);
  health_.setCounter("command period: median [us]", period.median);
  health_.setCounter("command period: longest [us]", period.longest);
  const double temperature = controller_->telemetry().temperature;
  if (std::isfinite(temperature))
    health_.setCounter("controller's temperature [degC]", std::lround(temperature));
}

void MotorBridgeNode::shutdown(int64_t utime) {
  bridge_.receive(ArmRequest{utime, false, kShutdown, "", StopReason::kBridgeEnds}, utime);
  readLink(utime);
  drive(utime);
  // In any state of the controller: zero is harmless.
  writeLink(controller_->zeros(kShutdownZeros), utime);
  next_motor_ = next_execution_ = utime;
  publishMotor(utime);
  publishExecutions(utime);
}

}  // namespace tread::motor
