// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include "modules/motor_bridge/core/program.hpp"

namespace tread::motor {

/// A slot of constant power with a period of 50 ms.
inline ProgramSlot makeSlot(int64_t execution_id, int commands, double left = 0.5,
                            double right = 0.5) {
  ProgramSlot slot;
  slot.execution_id = execution_id;
  slot.pattern_id = static_cast<int32_t>(100 + execution_id);
  slot.set_version = 7;
  slot.kinds = kindsOf(trackChannels(CommandKind::kPower));
  slot.period_us = 50'000;
  slot.series.assign(static_cast<size_t>(commands), Command{left, right});
  return slot;
}

/// A program of run 1 sent at utime.
inline Program makeProgram(int64_t utime, const ProgramSlot& running,
                           const ProgramSlot& next = {}) {
  Program program;
  program.utime = utime;
  program.seq = utime;
  program.run_id = 1;
  program.lease_us = 200'000;
  program.running = running;
  program.next = next;
  return program;
}

}  // namespace tread::motor
