// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/vehicle.hpp"

#include <algorithm>
#include <cmath>

namespace tread::sim {
namespace {

/// Slip velocity counts as displacement over this time: damps the spring of a standing track [s].
constexpr double kDampingTime = 0.08;
/// Belt speed from which no damping is needed, because the ground is renewed [m/s].
constexpr double kDampingSpeed = 0.1;
/// Displacement is limited to this many saturation displacements.
constexpr double kMemory = 3.0;

/// Share of the load's offset that one metre of x_body gives to a segment [1/m^2].
double offsetGain(const TrackGeometry& geometry) {
  constexpr double kDiscrete = 1.0 - 1.0 / (kTrackSegments * kTrackSegments);
  return 12.0 / (geometry.length * geometry.length * kDiscrete);
}

/// Speed after dry friction has removed up to `change` of it; friction stops but never reverses.
double withDryFriction(double speed, double change) {
  if (std::abs(speed) <= change) return 0.0;
  return speed - std::copysign(change, speed);
}

constexpr double kGravity = 9.81;  // [m/s^2]

/// Loads of the two tracks; a cross slope shifts them to the lower one.
struct Loads {
  ContactLoad left;
  ContactLoad right;
};

Loads loadsOn(const VehicleParameters& vehicle, const Ground& ground) {
  const double steepness =
      ground.slope_along * ground.slope_along + ground.slope_across * ground.slope_across;
  const double normal = vehicle.mass * kGravity / std::sqrt(1.0 + steepness);
  const double shift =
      std::clamp(vehicle.mass_height * ground.slope_across / vehicle.gauge, -0.5, 0.5);
  const double offset = vehicle.mass_ahead - vehicle.mass_height * ground.slope_along;
  return {{normal * (0.5 - shift), offset}, {normal * (0.5 + shift), offset}};
}

}  // namespace

TrackForce TrackContact::step(const TrackGeometry& geometry, const Surfaces& surfaces,
                              const Twist2& v_middle, double belt_speed, const ContactLoad& load,
                              double dt) {
  shear(geometry, surfaces, v_middle, belt_speed, dt);
  const double speed_over_ground = v_middle.v_x - v_middle.omega * geometry.lateral;
  const double gain = offsetGain(geometry);
  const double damping = kDampingTime * std::max(0.0, 1.0 - std::abs(belt_speed) / kDampingSpeed);
  TrackForce total;
  for (size_t i = 0; i < kTrackSegments; ++i) {
    const SurfaceParameters& surface = *surfaces[i];
    const double x = geometry.segmentX(static_cast<int>(i));
    const double share = 1.0 + gain * (load.offset + surface.pressure_offset) * x;
    const double normal = load.force / kTrackSegments * std::max(0.0, share);
    const double u_x = (along_[i] + damping * slip_along_[i]) / surface.shear_displacement;
    const double u_y = (across_[i] + damping * slip_across_[i]) / surface.lateral_displacement;
    const double shear = surface.friction * normal / std::sqrt(1.0 + u_x * u_x + u_y * u_y);
    // Ground heaped up beside the track is pushed aside, not sheared, so friction does not limit
    // it.
    const double across = -shear * u_y - normal * surface.scrub_resistance * slip_across_[i];
    total.along -= shear * u_x;
    total.across += across;
    total.resistance -= normal * surface.resistance_viscous * speed_over_ground;
    total.dry_friction += normal * surface.resistance_constant;
    total.moment += x * across;
  }
  total.moment -= geometry.lateral * (total.along + total.resistance);
  return total;
}

void TrackContact::shear(const TrackGeometry& geometry, const Surfaces& surfaces,
                         const Twist2& v_middle, double belt_speed, double dt) {
  const double slip_x = v_middle.v_x - v_middle.omega * geometry.lateral - belt_speed;
  for (size_t i = 0; i < kTrackSegments; ++i) {
    slip_along_[i] = slip_x;
    slip_across_[i] = v_middle.v_y + v_middle.omega * geometry.segmentX(static_cast<int>(i));
  }
  const double share = std::min(1.0, std::abs(belt_speed) * dt * kTrackSegments / geometry.length);
  carry(along_, share, belt_speed > 0.0);
  carry(across_, share, belt_speed > 0.0);
  for (size_t i = 0; i < kTrackSegments; ++i) {
    const double limit_x = kMemory * surfaces[i]->shear_displacement;
    const double limit_y = kMemory * surfaces[i]->lateral_displacement;
    along_[i] = std::clamp(along_[i] + slip_along_[i] * dt, -limit_x, limit_x);
    across_[i] = std::clamp(across_[i] + slip_across_[i] * dt, -limit_y, limit_y);
  }
}

void TrackContact::carry(std::array<double, kTrackSegments>& displacement, double share,
                         bool forward) {
  double upstream = 0.0;
  for (size_t k = 0; k < kTrackSegments; ++k) {
    double& here = displacement[forward ? k : kTrackSegments - 1 - k];
    const double before = here;
    here += share * (upstream - before);
    upstream = before;
  }
}

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
    // The motor's own stiffness is treated implicitly: stable for any step.
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
  stepBattery(parameters, left.power * left.current + right.power * right.current, dt, battery);
}

void stepBattery(const DriveParameters& parameters, double motors_current, double dt,
                 Battery& battery) {
  battery.current = parameters.idle_current + motors_current;
  battery.charge =
      std::clamp(battery.charge - battery.current * dt / parameters.capacity, 0.0, 1.0);
  const double open_voltage = parameters.empty_voltage +
                              (parameters.full_voltage - parameters.empty_voltage) * battery.charge;
  battery.voltage = std::max(0.0, open_voltage - parameters.inner_resistance * battery.current);
}

Ground levelGround(const SurfaceParameters& surface) {
  Ground ground;
  ground.left.fill(&surface);
  ground.right.fill(&surface);
  ground.wheels.fill(&surface);
  return ground;
}

TrackedVehicle::TrackedVehicle(const VehicleParameters& parameters) : parameters_(parameters) {
  const DriveParameters& drive = parameters.drive;
  battery_.charge = parameters.charge;
  battery_.voltage =
      drive.full_voltage - (drive.full_voltage - drive.empty_voltage) * (1.0 - parameters.charge);
}

void TrackedVehicle::rebuild(const VehicleParameters& parameters) {
  v_centre_.v_y += v_centre_.omega * (parameters.centre - parameters_.centre);
  parameters_ = parameters;
}

void TrackedVehicle::step(const MotorPower& power, const Ground& ground, double dt) {
  const Loads loads = loadsOn(parameters_, ground);
  const TrackGeometry left_track{parameters_.contact_length, parameters_.gauge / 2.0};
  const TrackGeometry right_track{parameters_.contact_length, -parameters_.gauge / 2.0};
  const TrackForce left =
      left_contact_.step(left_track, ground.left, v_centre_, left_.speed, loads.left, dt);
  const TrackForce right =
      right_contact_.step(right_track, ground.right, v_centre_, right_.speed, loads.right, dt);
  moveBody(left, right, ground, dt);
  stepTrack(parameters_.drive, parameters_.left_power * std::clamp(power.left, -1.0, 1.0),
            battery_.voltage, {-left.along, left.dry_friction + parameters_.left_drag}, dt, left_);
  stepTrack(parameters_.drive, parameters_.right_power * std::clamp(power.right, -1.0, 1.0),
            battery_.voltage, {-right.along, right.dry_friction + parameters_.right_drag}, dt,
            right_);
  stepBattery(parameters_.drive, left_, right_, dt, battery_);
}

void TrackedVehicle::moveBody(const TrackForce& left, const TrackForce& right, const Ground& ground,
                              double dt) {
  const double steepness =
      ground.slope_along * ground.slope_along + ground.slope_across * ground.slope_across;
  const double weight = parameters_.mass * kGravity / std::sqrt(1.0 + steepness);
  const double force_x = left.along + left.resistance + right.along + right.resistance -
                         weight * ground.slope_along + outside_.along;
  const double from_ground = left.across + right.across;
  const double force_y = from_ground - weight * ground.slope_across + outside_.across;
  // About the centre of mass; the velocity is that of the middle of the patches.
  const double ahead = parameters_.mass_ahead;
  const double moment = left.moment + right.moment - ahead * from_ground + outside_.moment;
  const double turned = dt * moment / parameters_.yaw_inertia;
  const double v_x = v_centre_.v_x, omega = v_centre_.omega;
  v_centre_.v_x +=
      dt * (force_x / parameters_.mass + omega * v_centre_.v_y + omega * omega * ahead);
  v_centre_.v_y += dt * (force_y / parameters_.mass - omega * v_x) - turned * ahead;
  v_centre_.omega += turned;
}

}  // namespace tread::sim
