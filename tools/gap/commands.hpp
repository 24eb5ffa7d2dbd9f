// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include <CLI/CLI.hpp>

#include "modules/identification/core/fit.hpp"

// Subcommands of tread-gap, and what several have in common. Each adds itself to the program and
// does its work in its callback, once the whole command line is read; it sets the program's exit
// status, and what it throws ends the program with its one line and 2.
namespace tread::gap {

void addPlan(CLI::App& app, int& status);
void addWhatIf(CLI::App& app);

/// Runs on so many threads.
ParallelFor onThreads(int threads);

/// Adds --seed, and --threads with as many as the machine has, to a subcommand; both variables must
/// outlive it.
void addSeedAndThreads(CLI::App& command, int64_t& seed, int& threads);

}  // namespace tread::gap
