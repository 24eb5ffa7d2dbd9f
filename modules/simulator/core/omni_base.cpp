// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/omni_base.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>

namespace tread::sim {
namespace {

constexpr double kBaseGravity = 9.81;  // [m/s^2]
constexpr double kRollerPatch = 0.08;  // [m] length of a roller's contact
constexpr double kRollerDrag = 2.0;    // [1] of a wheel's resistance: added by small rollers
constexpr double kRollingFrom = 0.05;  // [m/s] below it a roller does not resist fully

/// A surface under rollers: sheared only along their axis.
TrackContact::Surfaces rollersOn(const SurfaceParameters& surface, SurfaceParameters& felt) {
  felt.friction = surface.friction;
  felt.shear_displacement = surface.shear_displacement;
  felt.lateral_displacement = 1e6;  // they roll away
  felt.resistance_constant = surface.resistance_constant;
  felt.resistance_viscous = felt.scrub_resistance = felt.pressure_offset = 0.0;
  TrackContact::Surfaces surfaces{};
  surfaces.fill(&felt);
  return surfaces;
}

/// Loads of the wheels: as even as the point of application allows.
std::vector<double> wheelLoads(const VehicleParameters& vehicle, const Ground& ground) {
  const double steepness =
      ground.slope_along * ground.slope_along + ground.slope_across * ground.slope_across;
  const double normal = vehicle.mass * kBaseGravity / std::sqrt(1.0 + steepness);
  const Eigen::Vector2d at(vehicle.mass_ahead - vehicle.mass_height * ground.slope_along,
                           -vehicle.mass_height * ground.slope_across);
  const auto count = static_cast<double>(vehicle.wheels.size());
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const WheelMount& wheel : vehicle.wheels) middle += wheel.p_body() / count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const WheelMount& wheel : vehicle.wheels) {
    const Eigen::Vector2d arm = wheel.p_body() - middle;
    spread += arm * arm.transpose();
  }
  const Eigen::Vector2d tilt = spread.inverse() * (at - middle);
  std::vector<double> loads;
  for (const WheelMount& wheel : vehicle.wheels)
    loads.push_back(normal * std::max(0.0, 1.0 / count + tilt.dot(wheel.p_body() - middle)));
  return loads;
}

}  // namespace

OmniBase::OmniBase(const VehicleParameters& parameters) : parameters_(parameters) {
  const DriveParameters& drive = parameters.drive;
  battery_.charge = parameters.charge;
  battery_.voltage =
      drive.full_voltage - (drive.full_voltage - drive.empty_voltage) * (1.0 - parameters.charge);
}

OmniBase::Force OmniBase::forceOn(size_t wheel, const SurfaceParameters& ground, double load,
                                  double dt) {
  const WheelMount& mount = parameters_.wheels[wheel];
  const Twist2 v_body = velocity();
  const Eigen::Vector2d v(v_body.v_x - v_body.omega * mount.y, v_body.v_y + v_body.omega * mount.x);
  const double angle = mount.heading + mount.rollers;
  const Eigen::Vector2d axis(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d away(-axis.y(), axis.x());
  const double on_axis = std::cos(mount.rollers);  // of the rim's motion
  const TrackForce sheared = contacts_[wheel].step(
      {kRollerPatch, 0.0}, rollersOn(ground, grounds_[wheel]), {v.dot(axis), v.dot(away), 0.0},
      drives_[wheel].speed * on_axis, {load, 0.0}, dt);
  const double rolls = v.dot(away);
  const double drag = load * (ground.resistance_constant * std::tanh(rolls / kRollingFrom) +
                              ground.resistance_viscous * rolls);
  const Eigen::Vector2d force =
      axis * (sheared.along - load * ground.resistance_viscous * v.dot(axis)) -
      away * kRollerDrag * drag;
  return {force.x(),
          force.y(),
          mount.x * force.y() - mount.y * force.x(),
          {-sheared.along * on_axis, sheared.dry_friction}};
}

void OmniBase::step(const MotorPower& power, const Ground& ground, double dt) {
  const double steepness =
      ground.slope_along * ground.slope_along + ground.slope_across * ground.slope_across;
  const double weight = parameters_.mass * kBaseGravity / std::sqrt(1.0 + steepness);
  const std::vector<double> loads = wheelLoads(parameters_, ground);
  double force_x = -weight * ground.slope_along, force_y = -weight * ground.slope_across;
  double moment = 0.0, current = 0.0;
  std::array<TrackLoad, kMostMotors> on_wheels{};
  for (size_t i = 0; i < motors(); ++i) {
    const Force force = forceOn(i, *ground.wheels[i], loads[i], dt);
    force_x += force.x;
    force_y += force.y;
    // About the centre of mass.
    moment += force.moment - parameters_.mass_ahead * force.y;
    on_wheels[i] = force.on_wheel;
  }
  for (size_t i = 0; i < motors(); ++i) {
    stepTrack(parameters_.drive, std::clamp(power[i], -1.0, 1.0), battery_.voltage, on_wheels[i],
              dt, drives_[i]);
    current += drives_[i].power * drives_[i].current;
  }
  stepBattery(parameters_.drive, current, dt, battery_);
  const double v_x = v_mass_.v_x, omega = v_mass_.omega;
  v_mass_.v_x += dt * (force_x / parameters_.mass + omega * v_mass_.v_y);
  v_mass_.v_y += dt * (force_y / parameters_.mass - omega * v_x);
  v_mass_.omega += dt * moment / parameters_.yaw_inertia;
}

}  // namespace tread::sim
