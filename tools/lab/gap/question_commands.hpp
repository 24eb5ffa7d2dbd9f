// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <CLI/CLI.hpp>

#include <string>

#include "common/vehicle/model_document.hpp"

namespace tread::gap {

/// The model for a command with manoeuvres of two tracks; throws for other vehicles.
ModelDocument readTwoTracks(const std::string& path, const std::string& command);

/// --effects: adds the effects of a folder to the catalogue as soon as the option is parsed.
void addEffectsOption(CLI::App& command);
void addPlan(CLI::App& app, int& status);
void addWhatIf(CLI::App& app);

}  // namespace tread::gap
