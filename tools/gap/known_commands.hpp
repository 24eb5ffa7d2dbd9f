// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <vector>

#include "modules/identification/core/drive.hpp"
#include "tools/gap/log_messages.hpp"

namespace tread::gap {

/// What was before a span of known commands.
enum class Before {
  kLogBegins,
  kUnknownCommands,  ///< a fault, an emergency stop or an operator
  kMotorSilent       ///< messages are missing
};

/// A time in which all commands are known.
struct CommandSpan {
  std::vector<CommandSample> commands;  ///< changes only, the first one at the begin; not empty
  double end = 0.0;                     ///< [s]
  Before before = Before::kLogBegins;

  double begin() const { return commands.front().time; }
};

/// What the machine obeys at a MOTOR message; nothing where that is unknown.
std::optional<TrackCommand> obeyed(const motor_t& motor);

/// The spans of a log, at least a second long, in order of time.
std::vector<CommandSpan> knownCommands(const LogMessages& messages);

/// The command that acts at a time [s] within a span (the first one before it).
TrackCommand commandAt(const CommandSpan& span, double time);

/// Whether the span commands zero from `from` to `to` [s].
bool standsBetween(const CommandSpan& span, double from, double to);

/// Track speeds as the encoders say, where they do.
std::vector<EncoderSample> encoderSamples(const LogMessages& messages);

/// Voltages of the battery, where they are measured.
std::vector<VoltageSample> voltageSamples(const LogMessages& messages);

}  // namespace tread::gap
