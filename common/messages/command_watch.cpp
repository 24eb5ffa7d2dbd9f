// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/command_watch.hpp"

#include <cmath>
#include <limits>

#include "common/report/text.hpp"

namespace tread {
namespace {

/// Half a minute at 50 Hz.
constexpr size_t kRememberedCommands = 1500;
/// MOTOR carries single precision, and a Roboteq takes thousandths of full power.
constexpr double kTolerance = 2e-3;

bool sameCommand(const Command& given, const Command& command, size_t channels) {
  for (size_t i = 0; i < channels; ++i)
    if (!(std::abs(given[i] - command[i]) <= kTolerance)) return false;  // nor for NaN
  return true;
}

/// "0.500, -0.250".
std::string listed(const Command& command, size_t channels) {
  std::string text;
  for (size_t i = 0; i < channels; ++i) text += formatted(i == 0 ? "%.3f" : ", %.3f", command[i]);
  return text;
}

}  // namespace

void CommandWatch::add(const motor_t& motor) {
  if (motor.battery_voltage > 0.0F && std::isfinite(motor.battery_voltage)) {
    voltages_.push_back({motor.utime, static_cast<double>(motor.battery_voltage)});
    if (voltages_.size() > kRememberedCommands) voltages_.pop_front();
  }
  if (motor.execution_id == 0 || motor.command_index < 0) return;
  given_.push_back({{motor.motor_run_id, motor.execution_id},
                    motor.command_index,
                    kindsFrom(motor),
                    commandFrom(motor)});
  if (given_.size() > kRememberedCommands) given_.pop_front();
}

double CommandWatch::meanVoltage(int64_t from, int64_t to) const {
  double sum = 0.0;
  double count = 0.0;
  for (const Voltage& voltage : voltages_) {
    if (voltage.utime <= from || voltage.utime > to) continue;
    sum += voltage.volts;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

std::string CommandWatch::unexpectedCommand(const ExecutionKey& execution,
                                            const MotionPattern& pattern,
                                            const CommandChannels& channels) const {
  for (const Given& given : given_) {
    if (given.execution != execution) continue;
    if (given.kinds != kindsOf(channels))
      return "the motors got another kind of command than the pattern has";
    const auto index = static_cast<size_t>(given.index);
    if (index >= pattern.commands.size())
      return "the motors got more commands than the pattern has";
    const Command& command = pattern.commands[index];
    if (sameCommand(given.command, command, channels.size())) continue;
    return formatted("command %zu was (%s) on the motors, (%s) in the pattern", index,
                     listed(given.command, channels.size()).c_str(),
                     listed(command, channels.size()).c_str());
  }
  return {};
}

}  // namespace tread
