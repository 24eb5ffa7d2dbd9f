// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/config/config_reader.hpp"
#include "modules/planner/core/execution/supervisor.hpp"

namespace tread::planner {

/// Reads the configuration; throws ConfigError with file:line.
PlannerConfig readPlannerConfig(ConfigReader& reader);

/// The same from a CONFIG message in a log. Keys of older versions that are constants today are
/// ignored.
PlannerConfig readLoggedPlannerConfig(ConfigReader& reader);

}  // namespace tread::planner
