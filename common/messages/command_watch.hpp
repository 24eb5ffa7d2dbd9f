// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include <tread/motor_t.hpp>

#include "common/messages/pattern_messages.hpp"

namespace tread {

/// Remembers recent motor commands, so that R is compared only with executions of its own commands.
class CommandWatch {
 public:
  void add(const motor_t& motor);

  /// The first command of an execution that differs from the pattern's, in words; empty if none
  /// did.
  std::string unexpectedCommand(const ExecutionKey& execution, const MotionPattern& pattern,
                                const CommandChannels& channels) const;
  /// Mean battery voltage in (from, to] [V]; NaN if none was reported.
  double meanVoltage(int64_t from, int64_t to) const;

 private:
  struct Voltage {
    int64_t utime;
    double volts;
  };
  struct Given {
    ExecutionKey execution;
    int32_t index;
    std::vector<CommandKind> kinds;
    Command command;
  };
  std::deque<Given> given_;
  std::deque<Voltage> voltages_;
};

}  // namespace tread
