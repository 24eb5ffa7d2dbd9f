// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/geometry/footprint_size.hpp"
#include "modules/simulator/core/plant.hpp"

namespace tread::sim {

/// A tracked machine; no robot's size is a default.
/** Body origin on the ground midway between the tracks, x forward, y left. */
struct VehicleParameters {
  double mass = 0.0;            ///< [kg]
  double yaw_inertia = 0.0;     ///< about the centre of mass, tracks included [kg m^2]
  double gauge = 0.0;           ///< effective, between the middles of the tracks [m]
  double contact_length = 0.0;  ///< of each track on the ground [m]
  double centre = 0.0;          ///< x_body of the middle of the contact patches and of the mass [m]
  double mass_height = 0.0;     ///< of the centre of mass above the ground [m]
  FootprintSize outline;        ///< what obstacles stop
  double left_power = 1.0;      ///< what the left drive gives of the power that it is told to [1]
  double right_power = 1.0;     ///< the same on the right [1]
  double charge = 1.0;          ///< of the battery at the beginning, 1 = full
  DriveParameters drive;
};

/// What else acts on the body, axes of the body, at the centre of mass: a plough, a trailer, wind.
struct OutsideForce {
  double along = 0.0;   ///< forward positive [N]
  double across = 0.0;  ///< to the left positive [N]
  double moment = 0.0;  ///< counter-clockwise positive [N m]
};

/// The same surface everywhere, level. The surface must outlive the ground.
Ground levelGround(const SurfaceParameters& surface);

/// What hides the truth: a dynamic tracked vehicle on sheared ground.
/** Motor power -> drive force against belt speed -> belt speed -> slip -> shear of the ground ->
   motion of the body in the tangent plane of the ground. Semi-implicit integration, meant for steps
   of 1 ms. */
class TrackedVehicle final : public Plant {
 public:
  explicit TrackedVehicle(const VehicleParameters& parameters);

  void step(const MotorPower& power, const Ground& ground, double dt) override;

  Twist2 velocity() const override {
    return {v_centre_.v_x, v_centre_.v_y - v_centre_.omega * parameters_.centre, v_centre_.omega};
  }
  const TrackDrive& left() const override { return left_; }
  const TrackDrive& right() const override { return right_; }
  const Battery& battery() const override { return battery_; }
  const VehicleParameters& parameters() const { return parameters_; }

  void stopBody() override { v_centre_ = {}; }
  /// Acts on the body from now on.
  void setOutsideForce(const OutsideForce& force) { outside_ = force; }
  /// Another build from now on, a new payload for instance; the body origin keeps its velocity.
  void rebuild(const VehicleParameters& parameters);
  /// Puts a share 0..1 of charge into the battery.
  void setCharge(double charge) { battery_.charge = charge; }

 private:
  void moveBody(const TrackForce& left, const TrackForce& right, const Ground& ground, double dt);

  VehicleParameters parameters_;
  TrackGeometry left_geometry_;
  TrackGeometry right_geometry_;
  TrackContact left_contact_;
  TrackContact right_contact_;
  TrackDrive left_;
  TrackDrive right_;
  Battery battery_;
  OutsideForce outside_;
  Twist2 v_centre_;  ///< of the centre of mass, axes of the body
};

}  // namespace tread::sim
