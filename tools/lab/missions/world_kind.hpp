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

/// What a kind of world does to every mission (config/missions/worlds); the default does nothing.
/** Surfaces and vehicle are the simulator's: the robot is not told. Start, goal, obstacles, usual
 * surfaces and slopes of a seed are the same in every kind. */
struct WorldKind {
  std::string name = "usual";
  std::string between;  ///< surface of stretches between the usual ones; empty = none
  std::vector<sim::SurfaceParameters> surfaces;   ///< beside the built-in ones
  std::optional<sim::RoughRegion> rough;          ///< bumps of stretches across the way
  double rough_share = 0.5;                       ///< [1] of the way that lies on them
  std::optional<sim::VehicleParameters> vehicle;  ///< in the place of the robot's
  double after = 0.0;                             ///< [m] driven before it is that vehicle
  std::optional<PatternSet> shipped;              ///< the learner begins with it

  bool changesOnTheWay() const { return vehicle && after > 0.0; }
};

/// Names of all kinds, `usual` first.
std::vector<std::string> worldKinds();

/// A kind by its name for a robot that is simulated by `vehicle`; throws ConfigError with one line.
WorldKind readWorldKind(const std::string& name, const sim::VehicleParameters& vehicle);

/// The surfaces of all kinds, beside the built-in ones.
std::vector<sim::SurfaceParameters> surfacesOfKinds();

/// The vehicle that becomes another one on its way; null where it does not.
std::unique_ptr<sim::Plant> vehicleOf(const WorldKind& kind, const sim::VehicleParameters& before);

}  // namespace tread::missions
