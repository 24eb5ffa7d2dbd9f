// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/car.hpp"

#include <algorithm>
#include <cmath>

#include "modules/simulator/core/omni_base.hpp"

namespace tread::sim {
namespace {

constexpr double kCarGravity = 9.81;  // [m/s^2]
constexpr double kTyrePatch = 0.2;    // [m] length of a tyre on the ground

/// A twist in the frame of a wheel that is turned to the left.
Twist2 turned(const Twist2& v_body, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v_body.v_x + s * v_body.v_y, c * v_body.v_y - s * v_body.v_x, v_body.omega};
}

/// A surface under a tyre: as stiff across as along, evenly loaded, and without a track's losses in
/// its belt and by pushing ground aside.
TrackContact::Surfaces tyreOn(const SurfaceParameters& surface, SurfaceParameters& tyre) {
  tyre.friction = surface.friction;
  tyre.shear_displacement = tyre.lateral_displacement = surface.shear_displacement;
  tyre.resistance_constant = surface.resistance_constant;
  tyre.resistance_viscous = tyre.scrub_resistance = tyre.pressure_offset = 0.0;
  TrackContact::Surfaces surfaces{};
  surfaces.fill(&tyre);
  return surfaces;
}

}  // namespace

Car::Car(const VehicleParameters& parameters)
    : parameters_(parameters), mass_at_(parameters.centre + parameters.mass_ahead) {
  const DriveParameters& drive = parameters.drive;
  battery_.charge = parameters.charge;
  battery_.voltage =
      drive.full_voltage - (drive.full_voltage - drive.empty_voltage) * (1.0 - parameters.charge);
}

void Car::step(const MotorPower& power, const Ground& ground, double dt) {
  const double wanted = parameters_.max_steering * std::clamp(power.right, -1.0, 1.0);
  const double most = parameters_.steering_rate * dt;
  steering_ += std::clamp(wanted - steering_, -most, most);

  const double steepness =
      ground.slope_along * ground.slope_along + ground.slope_across * ground.slope_across;
  const double weight = parameters_.mass * kCarGravity / std::sqrt(1.0 + steepness);
  const double wheelbase = parameters_.wheelbase;
  const double ahead = wheelbase - mass_at_;
  const double shift = parameters_.mass_height * ground.slope_along / wheelbase;
  const double on_front = std::clamp(mass_at_ / wheelbase - shift, 0.05, 0.95);

  const Twist2& v = v_mass_;
  const Twist2 v_front = turned({v.v_x, v.v_y + ahead * v.omega, v.omega}, steering_);
  const Twist2 v_rear{v.v_x, v.v_y - mass_at_ * v.omega, v.omega};
  const TrackGeometry patch{kTyrePatch, 0.0};
  // The front wheels roll freely: their rim speed is that of the ground.
  const TrackForce front = front_contact_.step(patch, tyreOn(*ground.left.front(), front_ground_),
                                               v_front, v_front.v_x, {weight * on_front, 0.0}, dt);
  const TrackForce rear =
      rear_contact_.step(patch, tyreOn(*ground.left.back(), rear_ground_), v_rear, drive_.speed,
                         {weight * (1.0 - on_front), 0.0}, dt);

  const double c = std::cos(steering_), s = std::sin(steering_);
  // The front wheels' resistance holds them only while they roll, and only with the grip that
  // cornering leaves.
  const double rolling = std::clamp(v_front.v_x / 0.05, -1.0, 1.0);
  const double grip = ground.left.front()->friction * weight * on_front;
  const double left_over = std::sqrt(std::max(0.0, grip * grip - front.across * front.across));
  const double front_along =
      std::clamp(front.along - rolling * front.dry_friction, -left_over, left_over);
  const double front_y = s * front_along + c * front.across;
  const double force_x =
      c * front_along - s * front.across + rear.along - weight * ground.slope_along;
  const double force_y = front_y + rear.across - weight * ground.slope_across;
  const double moment = ahead * front_y - mass_at_ * rear.across + front.moment + rear.moment;
  const double v_x = v.v_x, omega = v.omega;
  v_mass_.v_x += dt * (force_x / parameters_.mass + omega * v.v_y);
  v_mass_.v_y += dt * (force_y / parameters_.mass - omega * v_x);
  v_mass_.omega += dt * moment / parameters_.yaw_inertia;

  stepTrack(parameters_.drive, parameters_.left_power * std::clamp(power.left, -1.0, 1.0),
            battery_.voltage, {-rear.along, rear.dry_friction + parameters_.left_drag}, dt, drive_);
  stepBattery(parameters_.drive, drive_, servo_, dt, battery_);
}

std::unique_ptr<Plant> makeVehicle(const VehicleParameters& parameters) {
  if (!parameters.wheels.empty()) return std::make_unique<OmniBase>(parameters);
  if (parameters.wheelbase > 0.0) return std::make_unique<Car>(parameters);
  return std::make_unique<TrackedVehicle>(parameters);
}

}  // namespace tread::sim
