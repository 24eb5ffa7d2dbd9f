// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Queries of the emulated controller, and their history.
#include <algorithm>
#include <cmath>
#include <utility>

#include "modules/simulator/emulators/roboteq/roboteq_firmware.hpp"

namespace tread::sim {
namespace {

constexpr size_t kHistoryDepth = 16;
constexpr double kBrownOutVoltage = 12.0;  // what is left of the motor supply [V]
constexpr int kUndervoltageFault = 4;      // bits of ?FF
constexpr int kEmergencyStopFault = 16;
constexpr int kSerialStatus = 1;  // bits of ?FS
constexpr int kPowerStageOffStatus = 8;

int rounded(double value) {
  return static_cast<int>(std::lround(value));
}

}  // namespace

std::optional<std::string> RoboteqFirmware::runQuery(const std::string& text) {
  auto reply = answer(roboteqWords(text));
  if (!reply) return std::nullopt;
  const bool known = std::find(history_.begin(), history_.end(), text) != history_.end();
  if (!known) history_.push_back(text);
  if (history_.size() > kHistoryDepth) history_.erase(history_.begin());
  return reply;
}

std::optional<std::string> RoboteqFirmware::answer(const RoboteqWords& words) const {
  if (words.numbers.size() > 1) return std::nullopt;
  const int parts = words.name == "V" ? 3 : 2;
  for (const auto& number : words.numbers) {
    if (!number || *number < 1 || *number > parts) return std::nullopt;
  }
  if (words.name == "V") return "V=" + voltages(words.numbers);
  if (words.name == "FF") {
    return "FF=" + std::to_string((supplyLow() ? kUndervoltageFault : 0) |
                                  (emergency_stop_ ? kEmergencyStopFault : 0));
  }
  if (words.name == "FS") {
    return "FS=" + std::to_string((serial_active_ ? kSerialStatus : 0) |
                                  (powerStageOn() ? 0 : kPowerStageOffStatus));
  }
  if (words.name == "FID") return std::string("FID=Roboteq v2.0 MDC2460 emulated by Tread");
  if (words.name == "T") return std::string("T=32:30:30");
  return channelAnswer(words);
}

std::string RoboteqFirmware::voltages(const Numbers& numbers) const {
  const double battery = brown_out_ ? kBrownOutVoltage : measurements_.battery_voltage;
  // Driver supply in 0.1 V, battery in 0.1 V, 5 V rail in mV.
  const std::array<std::string, 3> parts{"135", std::to_string(rounded(10.0 * battery)), "4980"};
  if (!numbers.empty()) return parts[static_cast<size_t>(*numbers[0] - 1)];
  return parts[0] + ":" + parts[1] + ":" + parts[2];
}

std::optional<std::string> RoboteqFirmware::channelAnswer(const RoboteqWords& words) const {
  const std::array<int, 2> power = applied();
  std::array<int, 2> values{};
  for (size_t i = 0; i < 2; ++i) {
    const double current = measurements_.motor_current[i];
    if (words.name == "M" || words.name == "P") {
      values[i] = power[i];
    } else if (words.name == "A") {
      values[i] = rounded(10.0 * current);
    } else if (words.name == "BA") {
      values[i] = rounded(10.0 * std::abs(power[i]) / 1000.0 * current);
    } else if (words.name == "FM") {
      values[i] = 0;
    } else if (words.name == "S" && settings_.encoders) {
      values[i] = rounded(settings_.rpm_per_speed * measurements_.track_speed[i]);
    } else {
      return std::nullopt;
    }
  }
  const std::string name = words.name + "=";
  if (words.numbers.empty())
    return name + std::to_string(values[0]) + ":" + std::to_string(values[1]);
  return name + std::to_string(values[static_cast<size_t>(*words.numbers[0] - 1)]);
}

void RoboteqFirmware::runHistory(const RoboteqWords& words, int64_t utime) {
  if (words.name == "C") {
    history_.clear();
    repeat_us_ = 0;
  }
  if (words.numbers.size() != 1 || !words.numbers[0] || *words.numbers[0] < 0) return;
  repeat_us_ = *words.numbers[0] * int64_t{1000};
  next_repeat_ = utime + repeat_us_;
}

std::optional<RoboteqFirmware::Repeated> RoboteqFirmware::repeatedReply(int64_t utime) {
  if (repeat_us_ == 0 || history_.empty() || next_repeat_ > utime) return std::nullopt;
  const int64_t due = std::exchange(next_repeat_, next_repeat_ + repeat_us_);
  next_in_history_ = (next_in_history_ + 1) % history_.size();
  return Repeated{answer(roboteqWords(history_[next_in_history_])).value_or("-"), due};
}

}  // namespace tread::sim
