// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/command_watch.hpp"

#include <cmath>
#include <cstdio>

namespace tread {
namespace {

/// Half a minute at 50 Hz.
constexpr size_t kRemembered = 1500;
/// MOTOR carries single precision, and a Roboteq takes thousandths of full power.
constexpr double kTolerance = 2e-3;

}  // namespace

void CommandWatch::add(const motor_t& motor) {
  if (motor.execution_id == 0 || motor.command_index < 0) return;
  given_.push_back({{motor.motor_run_id, motor.execution_id},
                    motor.command_index,
                    motor.motor_command_kind,
                    static_cast<double>(motor.command_left),
                    static_cast<double>(motor.command_right)});
  if (given_.size() > kRemembered) given_.pop_front();
}

std::string CommandWatch::unexpectedCommand(const ExecutionKey& execution,
                                            const MotionPattern& pattern, CommandKind kind) const {
  for (const Given& given : given_) {
    if (given.execution != execution) continue;
    if (given.kind != static_cast<int16_t>(kind))
      return "the motors got another kind of command than the pattern has";
    const auto index = static_cast<size_t>(given.index);
    if (index >= pattern.commands.size())
      return "the motors got more commands than the pattern has";
    const TrackCommand& command = pattern.commands[index];
    // Both by themselves: a NaN in one of them must not hide behind the other.
    if (std::abs(given.left - command.left) <= kTolerance &&
        std::abs(given.right - command.right) <= kTolerance)
      continue;
    char line[160];
    std::snprintf(line, sizeof line,
                  "command %zu was (%.3f, %.3f) on the motors, (%.3f, %.3f) in the pattern", index,
                  given.left, given.right, command.left, command.right);
    return line;
  }
  return {};
}

}  // namespace tread
