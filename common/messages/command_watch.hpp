// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <string>

#include <tread/motor_t.hpp>

#include "common/execution/readings.hpp"
#include "common/pattern/pattern.hpp"

namespace tread {

/// Remembers what the motors were given lately, so that R is compared with what its own commands
/// did and no other.
class CommandWatch {
 public:
  void add(const motor_t& motor);

  /// The first command of an execution that differs from the pattern's, in words; empty if none was
  /// seen.
  std::string unexpectedCommand(const ExecutionKey& execution, const MotionPattern& pattern,
                                CommandKind kind) const;

 private:
  struct Given {
    ExecutionKey execution;
    int32_t index;
    int16_t kind;
    double left;
    double right;
  };
  std::deque<Given> given_;
};

}  // namespace tread
