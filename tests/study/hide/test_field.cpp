// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/test_field.hpp"

#include <cmath>

#include "tests/study/hide/rng.hpp"

namespace tread::blind {
namespace {

double weight() {
  return plainVehicle().mass * kGravity;
}

}  // namespace

std::optional<NoiseLevel> noiseLevel(const std::string& name) {
  if (name == "low") return NoiseLevel{name, 0.005, 0.003, 0.001, 0.01};
  if (name == "mid") return NoiseLevel{name, 0.015, 0.010, 0.003, 0.03};
  if (name == "high") return NoiseLevel{name, 0.040, 0.030, 0.006, 0.06};
  return std::nullopt;
}

sim::VehicleParameters plainVehicle() {
  sim::VehicleParameters vehicle;
  vehicle.mass = 400.0;
  vehicle.gauge = 0.43;
  vehicle.contact_length = 0.4;
  vehicle.mass_height = 0.35;
  vehicle.outline = {0.65, 0.65, 0.34};
  // Turning responds as fast as driving.
  vehicle.yaw_inertia = 28.3;
  vehicle.drive.free_speed = 1.2;
  vehicle.drive.stiffness = 8000.0;
  vehicle.drive.force_limit = 8000.0;
  vehicle.drive.power_lag = 0.2;
  vehicle.drive.track_mass = 60.0;
  vehicle.drive.gear_friction = 1.0;
  vehicle.drive.brake_force = 2000.0;
  vehicle.drive.inner_resistance = 0.0005;
  vehicle.drive.capacity = 1e9;
  return vehicle;
}

sim::SurfaceParameters plainSurface() {
  sim::SurfaceParameters surface;
  surface.name = "test field";
  // Cleats in tough soil: the tracks hardly slip at any speed.
  surface.friction = 2.0;
  surface.shear_displacement = 0.003;
  // Turning is resisted by displaced ground, in proportion to the speed.
  surface.lateral_displacement = 100.0;
  surface.scrub_resistance = 8.0;
  surface.resistance_constant = 0.0004;
  surface.resistance_viscous = 0.05;
  return surface;
}

sim::Terrain rollingTerrain(uint64_t seed) {
  constexpr int kWaves = 6;
  constexpr double kSlope = 0.087;  // rms in any direction [1]
  Rng rng(seed);
  sim::Terrain terrain;
  for (int i = 0; i < kWaves; ++i) {
    // Directions are evenly spread, so that every heading has slopes.
    const double direction = kPi * (i + rng.uniform(0.0, 1.0)) / kWaves;
    const double wave_number = 2.0 * kPi / rng.uniform(3.0, 12.0);
    const double steepness = kSlope * 2.0 / std::sqrt(static_cast<double>(kWaves));
    terrain.waves.push_back(
        {steepness / wave_number,
         wave_number * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
         rng.uniform(0.0, 2.0 * kPi)});
  }
  return terrain;
}

double forwardDamping() {
  return 2.0 * plainVehicle().drive.stiffness + weight() * plainSurface().resistance_viscous;
}

double yawDamping() {
  const sim::VehicleParameters vehicle = plainVehicle();
  const double arm = vehicle.gauge / 2.0;
  constexpr double kDiscrete = 1.0 - 1.0 / (sim::kTrackSegments * sim::kTrackSegments);
  const double second_moment = vehicle.contact_length * vehicle.contact_length / 12.0 * kDiscrete;
  return forwardDamping() * arm * arm + weight() * plainSurface().scrub_resistance * second_moment;
}

double sideDamping() {
  return weight() * plainSurface().scrub_resistance;
}

}  // namespace tread::blind
