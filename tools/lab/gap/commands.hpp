// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "common/vehicle/model_document.hpp"

// Subcommands of tread-gap. Each adds itself to the program and runs in its callback, after the
// command line is parsed. It sets the exit status; an exception ends the program with one line and
// status 2.
namespace tread::gap {

/// The model for a command with manoeuvres of two tracks; throws for other vehicles.
ModelDocument readTwoTracks(const std::string& path, const std::string& command);

/// --effects: adds the effects of a folder to the catalogue as soon as the option is parsed.
void addEffectsOption(CLI::App& command);
void addPlan(CLI::App& app, int& status);
void addWhatIf(CLI::App& app);
void addWatch(CLI::App& app, int& status);

}  // namespace tread::gap
