// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "common/vehicle/model_document.hpp"

// Subcommands of tread-gap. Each adds itself to the program and does its work in its callback, once
// the whole command line is read; it sets the program's exit status, and what it throws ends the
// program with its one line and 2.
namespace tread::gap {

/// A model for a command whose manoeuvres are of two tracks; another one is refused.
ModelDocument readTwoTracks(const std::string& path, const std::string& command);

/// --effects: adds the effects of a folder to the catalogue as soon as it is read.
void addEffectsOption(CLI::App& command);
void addPlan(CLI::App& app, int& status);
void addWhatIf(CLI::App& app);
void addWatch(CLI::App& app, int& status);

}  // namespace tread::gap
