// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "modules/simulator/core/robot.hpp"
#include "modules/simulator/core/world.hpp"

namespace tread::missions {

/// Effect of a kind of world on every mission (config/missions/worlds); the default has none.
/** Surfaces and vehicle change only in the simulator, the robot is not informed. Start, goal,
 * obstacles, usual surfaces and slopes of a seed are the same in every kind. */
struct WorldKind {
  std::string name = "usual";
  std::string between;  ///< surface of the stretches between the usual ones; empty = none
  std::vector<sim::SurfaceParameters> surfaces;   ///< in addition to the built-in ones
  std::optional<sim::RoughRegion> rough;          ///< bumpy stretches across the way
  double rough_share = 0.5;                       ///< [1] of the way
  std::optional<sim::VehicleParameters> vehicle;  ///< replaces the robot's vehicle
  double after = 0.0;                             ///< [m] driven before the change
  std::optional<PatternSet> shipped;              ///< initial set of the learner

  bool changesOnTheWay() const { return vehicle && after > 0.0; }
};

/// All names, `usual` first.
std::vector<std::string> worldKinds();

/// A kind by name, for a robot simulated as `vehicle`; throws ConfigError with one line.
WorldKind readWorldKind(const std::string& name, const sim::VehicleParameters& vehicle);

/// Surfaces of all kinds, in addition to the built-in ones.
std::vector<sim::SurfaceParameters> surfacesOfKinds();

/// A vehicle that changes on its way; null if the kind has none.
std::unique_ptr<sim::Plant> vehicleOf(const WorldKind& kind, const sim::VehicleParameters& before);

}  // namespace tread::missions
