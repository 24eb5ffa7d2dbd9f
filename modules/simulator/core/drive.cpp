// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/drive.hpp"

#include <algorithm>
#include <cmath>

namespace tread::sim {
namespace {

/// Speed after dry friction took away up to `change` of it; friction stops, it never reverses.
double withDryFriction(double speed, double change) {
  if (std::abs(speed) <= change) return 0.0;
  return speed - std::copysign(change, speed);
}

}  // namespace

void stepTrack(const DriveParameters& parameters, double commanded_power, double voltage,
               const TrackLoad& load, double dt, TrackDrive& track) {
  const double heard = std::max(0.0, std::abs(commanded_power) - parameters.dead_power);
  const double asked = std::copysign(heard, commanded_power);
  track.power += (asked - track.power) * std::min(1.0, dt / parameters.power_lag);
  const double drive_speed =
      parameters.free_speed * track.power * voltage / parameters.nominal_voltage;
  const double wanted = parameters.stiffness * (drive_speed - track.speed);
  const double force = std::clamp(wanted, -parameters.force_limit, parameters.force_limit);
  track.current = force / parameters.force_per_current;

  const double per_mass = dt / parameters.track_mass;
  if (force == wanted) {
    // The motor's own stiffness is taken implicitly: stable for any step.
    track.speed =
        (track.speed + per_mass * (parameters.stiffness * drive_speed + load.ground_force)) /
        (1.0 + per_mass * parameters.stiffness);
  } else {
    track.speed += per_mass * (force + load.ground_force);
  }
  const bool braked = std::abs(track.power) < parameters.brake_power &&
                      std::abs(track.speed) < parameters.brake_speed;
  const double dry_friction =
      parameters.gear_friction + load.dry_friction + (braked ? parameters.brake_force : 0.0);
  track.speed = withDryFriction(track.speed, per_mass * dry_friction);
}

void stepBattery(const DriveParameters& parameters, const TrackDrive& left, const TrackDrive& right,
                 double dt, Battery& battery) {
  // The power stage is a step-down converter: battery current = duty x motor current.
  battery.current =
      parameters.idle_current + left.power * left.current + right.power * right.current;
  battery.charge =
      std::clamp(battery.charge - battery.current * dt / parameters.capacity, 0.0, 1.0);
  const double open_voltage = parameters.empty_voltage +
                              (parameters.full_voltage - parameters.empty_voltage) * battery.charge;
  battery.voltage = std::max(0.0, open_voltage - parameters.inner_resistance * battery.current);
}

}  // namespace tread::sim
