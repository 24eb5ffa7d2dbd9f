// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "modules/simulator/core/terrain.hpp"
#include "modules/simulator/core/vehicle.hpp"

// The plain vehicle: a Teodor's body and tracks with a stiff drive on even, tough ground. Its own
// physics remain, but effects in a catalogue are small: hardly any dry friction, a balanced body, a
// battery that does not fade.
namespace tread::blind {

inline constexpr double kGravity = 9.81;  ///< [m/s^2]

/// Uncertainties in a log, one sigma.
struct NoiseLevel {
  std::string name;
  double gyro_bin = 0.0;  ///< yaw rate averaged over 0.25 s [rad/s]
  double fix = 0.0;       ///< position of a pose, per axis [m]
  double heading = 0.0;   ///< of a pose [rad]
  double terrain = 0.0;   ///< of speed and of yaw rate between patterns [1]
};

/// low, mid or high; nullopt for other names.
std::optional<NoiseLevel> noiseLevel(const std::string& name);

sim::VehicleParameters plainVehicle();
sim::SurfaceParameters plainSurface();

/// Waves of the ground with slopes of about 5 degrees. They tilt the INS, but do not affect the
/// plain vehicle.
sim::Terrain rollingTerrain(uint64_t seed);

/// Loss of forward drive force per speed of the plain vehicle [N s/m].
double forwardDamping();
/// Loss of yaw moment per yaw rate of the plain vehicle [N m s].
double yawDamping();
/// Side force per sideways speed of the plain vehicle [N s/m].
double sideDamping();

}  // namespace tread::blind
