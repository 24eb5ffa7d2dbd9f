// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"

#include <algorithm>

namespace tread::motor {
namespace {

/// Older fault flags count as unknown [us]; they are read about thirty times a second.
constexpr int64_t kFlagsMaxAge = 1'000'000;

ConnectionTimes timesOf(const RoboteqConfig& config) {
  ConnectionTimes times = config.times;
  times.watchdog_us = 1000 * config.watchdog_ms;
  return times;
}

}  // namespace

RoboteqConfig readRoboteqConfig(ConfigReader& reader, const DriveDescription& drive) {
  RoboteqConfig config;
  RoboteqLayout& layout = config.layout;
  layout.full_scale = drive.fullCommand();
  layout.left_channel = drive.left_channel;
  layout.invert_left = drive.invert_left;
  layout.invert_right = drive.invert_right;
  int64_t watchdog_us = 1000 * config.watchdog_ms;
  // Zero is repeated every 0.1 s: a shorter watchdog would expire while the robot stands.
  reader.seconds("watchdog", watchdog_us, {0.15, 0.25});
  config.watchdog_ms = watchdog_us / 1000;
  reader.flag("both_in_one_line", layout.both_in_one_line);
  reader.number("rpm_per_mps", layout.rpm_per_mps, {0.0, 100000.0}, "rpm s/m");
  return config;
}

RoboteqConnection::RoboteqConnection(const RoboteqConfig& config)
    : ControllerConnection(timesOf(config)), config_(config), session_(config) {}

std::string RoboteqConnection::zero() const {
  std::string bytes;
  for (const std::string& line : commandLines({}, config_.layout)) bytes += line + "\r";
  return bytes;
}

void RoboteqConnection::receive(std::string_view bytes, int64_t now) {
  for (const std::string& line : lines_.push(bytes)) takeLine(line, now);
}

void RoboteqConnection::takeLine(const std::string& line, int64_t now) {
  const RoboteqReply reply = parseReply(line);
  if (isEcho(line)) {
    count("echoed lines");
    // We switched the echo off: the controller was restarted and has its default watchdog again.
    if (ready()) fail("it was restarted", now);
  } else if (reply.kind == RoboteqReply::Kind::kOther) {
    count("unreadable lines");
  } else if (ready()) {
    session_.take(reply, now);
  } else if (waitingStep() >= 0) {
    takeStartup(reply, now);
  }
}

std::string RoboteqConnection::startupName(int step) const {
  switch (step) {
    case kEcho:
      return "^ECHOF 1";
    case kWatchdog:
      return "^RWD " + std::to_string(config_.watchdog_ms);
    case kReadBack:
      return "~RWD";
    case kZero:
      return "zero";
    default:
      return "?FID";
  }
}

std::string RoboteqConnection::startupRequest(int step) const {
  if (step == kZero) return zero();
  // Zero also follows the very first line: it may complete half a command that a killed predecessor
  // left in the controller. Its acknowledgement is taken for that of the watchdog's setting, which
  // is read back anyway.
  return startupName(step) + "\r" + (step == kEcho ? zero() : "");
}

void RoboteqConnection::takeStartup(const RoboteqReply& reply, int64_t now) {
  const int step = waitingStep();
  const bool expects_value = step == kReadBack || step == kIdentify;
  if (reply.kind == RoboteqReply::Kind::kRefused) {
    stepRefused(now);
  } else if (step == kReadBack && reply.key == "RWD") {
    checkWatchdog(reply, now);
  } else if (step == kIdentify && reply.key == "FID") {
    firmware_ = reply.text;
    stepDone(now);
  } else if (reply.kind == RoboteqReply::Kind::kAck && !expects_value) {
    stepDone(now);
  }
}

void RoboteqConnection::checkWatchdog(const RoboteqReply& reply, int64_t now) {
  const std::string wanted = std::to_string(config_.watchdog_ms);
  if (reply.text == wanted) {
    stepDone(now);
  } else {
    fail("its watchdog did not take its setting", now,
         ": it reads " + reply.text + " ms instead of " + wanted);
  }
}

DeviceReport RoboteqConnection::reported(int64_t now) const {
  DeviceReport report;
  const RoboteqTelemetry& told = session_.telemetry();
  if (!told.faults_read_at || !told.status_read_at) {
    report.link_fault = "controller's fault flags not read yet";
  } else if (now - std::min(*told.faults_read_at, *told.status_read_at) > kFlagsMaxAge) {
    report.link_fault = "controller's fault flags are out of date";
  } else {
    report.device_fault = describeFaults(told.fault_flags, told.status_flags);
    if ((told.fault_flags & (kOvervoltage | kUndervoltage)) != 0)
      report.fault_code = StopReason::kControllerVoltage;
    for (const std::string& motor : {describeMotorFaults("left", told.motor_flags_left),
                                     describeMotorFaults("right", told.motor_flags_right)})
      if (!motor.empty()) report.device_fault += (report.device_fault.empty() ? "" : "; ") + motor;
    report.stop_latched = session_.stopLatched();
  }
  return report;
}

std::map<std::string, int64_t> RoboteqConnection::counted() const {
  std::map<std::string, int64_t> counters = session_.counters();
  counters["overlong lines"] += lines_.overlong();
  counters["garbage bytes"] += lines_.garbageBytes();
  return counters;
}

}  // namespace tread::motor
