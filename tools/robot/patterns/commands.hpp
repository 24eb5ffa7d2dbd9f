// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <stdexcept>

#include <CLI/CLI.hpp>

// The subcommands of tread-patterns. Each adds itself to the program and runs in its callback,
// after the command line is parsed. An exception ends the program with one line and exit code 2.
namespace tread::patterns {

/// A recording was interrupted, or the robot failed: exit code 1, as the input was not at fault.
struct RecordingStopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace tread::patterns
