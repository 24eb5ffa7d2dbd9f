// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <stdexcept>

#include <CLI/CLI.hpp>

// The subcommands of tread-patterns. Each adds itself to the program and does its work in its
// callback, once the whole command line is read; what it throws ends the program with its one line
// and 2.
namespace tread::patterns {

/// A recording was interrupted, or the robot failed: exit code 1, as nothing given was wrong.
struct RecordingStopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

CLI::App* addMake(CLI::App& app);
CLI::App* addRecipe(CLI::App& app);
CLI::App* addRecord(CLI::App& app);
CLI::App* addAverage(CLI::App& app);
CLI::App* addFromRecordings(CLI::App& app);
CLI::App* addShow(CLI::App& app);
CLI::App* addCheck(CLI::App& app);
CLI::App* addMirror(CLI::App& app);

}  // namespace tread::patterns
