// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "modules/simulator/core/vehicle.hpp"

namespace tread::sim {

/// A car on sheared ground: rear wheels driven by one motor, front wheels steered by a servo.
/** Body origin on the ground in the middle of the rear axle. The left power is the throttle, the
 * right one the steering angle over max_steering, -1..1, to the left positive. The two wheels of
 * an axle are one contact patch in its middle, on the surface below the axle; the tyres slip on it
 * (TrackContact), so that the car runs wide on slippery ground. Axle loads are those of a car that
 * does not accelerate. Its right drive, the servo, draws no current. */
class Car final : public Plant {
 public:
  explicit Car(const VehicleParameters& parameters);

  void step(const MotorPower& power, const Ground& ground, double dt) override;

  Twist2 velocity() const override {
    return {v_mass_.v_x, v_mass_.v_y - v_mass_.omega * mass_at_, v_mass_.omega};
  }
  const TrackDrive& left() const override { return drive_; }
  const TrackDrive& right() const override { return servo_; }
  const Battery& battery() const override { return battery_; }
  void stopBody() override { v_mass_ = {}; }

  double steering() const { return steering_; }  ///< [rad]

 private:
  VehicleParameters parameters_;
  double mass_at_;  ///< [m] of the centre of mass ahead of the rear axle
  TrackContact front_contact_;
  TrackContact rear_contact_;
  SurfaceParameters front_ground_;  ///< as it acts on the tyres
  SurfaceParameters rear_ground_;
  TrackDrive drive_;
  TrackDrive servo_;
  Battery battery_;
  double steering_ = 0.0;
  Twist2 v_mass_;  ///< of the centre of mass, axes of the body
};

/// The dynamic vehicle for these parameters: a holonomic base if they have wheels, a car if they
/// have a wheelbase, otherwise a tracked vehicle.
std::unique_ptr<Plant> makeVehicle(const VehicleParameters& parameters);

}  // namespace tread::sim
