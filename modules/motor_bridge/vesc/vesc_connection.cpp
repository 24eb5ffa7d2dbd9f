// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/vesc/vesc_connection.hpp"

#include <utility>

namespace tread::motor {
namespace {

constexpr int64_t kQueryInterval = 20'000;  // [us]
constexpr size_t kLargestValues = 128;      // bytes of a reply to COMM_GET_VALUES

}  // namespace

std::string VescConnection::commandBytes(const Command& command) const {
  std::string bytes;
  for (const int id : config_.ids()) bytes += addressed(id, vescCommand(command, id, config_));
  if (config_.servo) bytes += addressed(config_.servo->id, servoCommand(command, config_));
  return bytes;
}

void VescConnection::begin(int64_t now) {
  output_.clear();
  group_.begin(now);
}

void VescConnection::give(const Command& command, int64_t /*now*/) {
  output_ += commandBytes(command);
  ++commands_;
}

std::string VescConnection::lost(int64_t now) const {
  const std::string silent = group_.silent(now, times().silence_limit_us);
  return silent.empty() ? "" : "no sign of life of VESC " + silent;
}

DeviceReport VescConnection::reported(int64_t /*now*/) const {
  DeviceReport report;
  const std::string unheard = group_.unheard();
  if (!unheard.empty()) {
    report.link_fault = "values of VESC " + unheard + " not read yet";
  } else {
    report.device_fault = group_.faults();
    if (group_.voltageFault()) report.fault_code = StopReason::kControllerVoltage;
  }
  return report;
}

std::string VescUart::toController(int id, std::string_view payload) const {
  return vescPacket(id == config_.local ? std::string(payload) : vescForwarded(id, payload));
}

std::string VescUart::addressed(int id, const VescCommand& command) const {
  return toController(id, vescPayload(command));
}

std::string VescUart::startupRequest(int step) const {
  if (!isAnswered(step)) return zero();
  const char comm = step <= count() ? kCommFirmware : kCommGetAppConfiguration;
  return toController(idOf(step), std::string_view(&comm, 1));
}

std::string VescUart::startupName(int step) const {
  if (!isAnswered(step)) return "zero";
  return std::string(step <= count() ? "COMM_FW_VERSION" : "COMM_GET_APPCONF") + " of VESC " +
         std::to_string(idOf(step)) +
         (idOf(step) == config_.local ? "" : "; check its id and its CAN cable");
}

void VescUart::receive(std::string_view bytes, int64_t now) {
  for (const std::string& payload : packets_.push(bytes)) {
    if (waitingStep() >= 0) {
      takeStartup(payload, now);
    } else if (ready()) {
      const std::optional<VescReading> reading = vescValues(payload);
      if (reading && group_.take(*reading, now)) {
        pending_.answered(std::to_string(reading->id));
      } else {
        ++unreadable_;
      }
    }
  }
}

void VescUart::takeStartup(const std::string& payload, int64_t now) {
  const int step = waitingStep();
  const std::optional<VescTimeout> timeout = vescTimeout(payload);
  if (step <= count()) {
    if (payload[0] == kCommFirmware && payload.size() >= 3) stepDone(now);
  } else if (timeout && timeout->id == idOf(step)) {
    checkTimeout(*timeout, now);
  }
}

void VescUart::checkTimeout(const VescTimeout& told, int64_t now) {
  const int64_t most = times().watchdog_us / 1000;
  if (told.timeout_ms > 0 && told.timeout_ms <= most) {
    stepDone(now);
    return;
  }
  fail("its timeout is not that of the configuration", now,
       ": VESC " + std::to_string(told.id) + " has " + std::to_string(told.timeout_ms) +
           " ms (0 = never); set at most " + std::to_string(most) +
           " ms in VESC Tool, App Settings, General");
}

void VescUart::forget() {
  packets_.clear();
  packets_.expectAtMost(VescPackets::kMaxPayload);
}

void VescUart::begin(int64_t now) {
  VescConnection::begin(now);
  packets_.expectAtMost(kLargestValues);
  pending_.clear();
  queried_at_ = now;
}

std::string VescUart::talk(int64_t now) {
  pending_.expire(now, times().reply_timeout_us);
  if (now - queried_at_ >= kQueryInterval &&
      !pending_.waitsForQuery(now, times().reply_timeout_us / 2)) {
    const int id = config_.ids()[next_query_++ % config_.ids().size()];
    const char comm = kCommGetValues;
    output_ += toController(id, std::string_view(&comm, 1));
    pending_.querySent(std::to_string(id), now);
    queried_at_ = now;
  }
  return std::exchange(output_, {});
}

std::map<std::string, int64_t> VescUart::counted() const {
  std::map<std::string, int64_t> counters = pending_.counters();
  counters["commands given"] += commands_;
  counters["unreadable packets"] += unreadable_;
  counters["wrong checksums"] += packets_.badChecksums();
  counters["garbage bytes"] += packets_.garbageBytes();
  return counters;
}

std::string VescCan::startupName(int step) const {
  return step == kListen ? "listening: no status of VESC " + group_.unheard() +
                               "; switch its CAN status messages 1, 4 and 5 on"
                         : "zero";
}

std::string VescCan::notice() const {
  return "VESC over CAN: neither its timeout (App Settings, General) nor its faults can be read; "
         "set the timeout to at most " +
         std::to_string(config_.times.watchdog_us / 1000) + " ms in VESC Tool";
}

void VescCan::forget() {
  frames_.clear();
  group_.begin(0);
}

void VescCan::receive(std::string_view bytes, int64_t now) {
  for (const VescReading& reading : frames_.push(bytes)) {
    if (!group_.take(reading, now)) count("frames of other controllers");
    if (waitingStep() == kListen && group_.unheard().empty()) stepDone(now);
  }
}

std::string VescCan::talk(int64_t /*now*/) {
  return std::exchange(output_, {});
}

std::map<std::string, int64_t> VescCan::counted() const {
  return {{"commands given", commands_},
          {"other frames", frames_.otherFrames()},
          {"garbage bytes", frames_.garbageBytes()}};
}

}  // namespace tread::motor
