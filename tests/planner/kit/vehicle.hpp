// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/planner/core/execution/supervisor.hpp"
#include "modules/planner/core/search/path_planner.hpp"

namespace tread::planner::testkit {

/// The vehicle of all planner tests.
inline constexpr FootprintSize kVehicle{0.65, 0.65, 0.34};

inline SweepResolution usualSweep() {
  SweepResolution step;
  step.outline = kVehicle.widened(0.09);
  return step;
}

inline DistanceFieldConfig usualField() {
  DistanceFieldConfig config;
  config.inflation = kVehicle.half_width;
  return config;
}

inline PlanningMapConfig usualMap() {
  PlanningMapConfig config;
  config.footprint = kVehicle;
  config.field = usualField();
  return config;
}

inline PlannerConfig usualPlanner() {
  PlannerConfig config;
  config.map = usualMap();
  config.sweep = usualSweep();
  return config;
}

inline PathConfig usualPaths() {
  PathConfig config;
  config.footprint = kVehicle;
  return config;
}

}  // namespace tread::planner::testkit
