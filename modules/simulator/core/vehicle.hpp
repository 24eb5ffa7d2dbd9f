// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/drive.hpp"
#include "modules/simulator/core/track_contact.hpp"

namespace tread::sim {

/// A tracked machine of the size of a Telerob Teodor.
/** Body origin on the ground midway between the tracks, x forward, y left. */
struct VehicleParameters {
  double mass = 400.0;           ///< [kg]
  double yaw_inertia = 34.0;     ///< about the centre of mass, tracks included [kg m^2]
  double gauge = 0.43;           ///< between the middles of the tracks [m]
  double contact_length = 0.56;  ///< of each track on the ground [m]
  double centre = -0.08;      ///< x_body of the middle of the contact patches and of the mass [m]
  double mass_height = 0.35;  ///< of the centre of mass above the ground [m]
  double length = 1.30;       ///< footprint [m]
  double width = 0.68;        ///< footprint [m]
  DriveParameters drive;
};

/// Motor power, -1..1 a track.
struct MotorPower {
  double left = 0.0;
  double right = 0.0;
};

/// The ground below the vehicle at one moment.
struct Ground {
  TrackContact::Surfaces left{};   ///< below the segments, front to rear; never null
  TrackContact::Surfaces right{};  ///< below the segments, front to rear; never null
  double slope_along = 0.0;        ///< height gained per metre ahead [1]
  double slope_across = 0.0;       ///< height gained per metre to the left [1]
};

/// The same surface everywhere, level. The surface must outlive the ground.
Ground levelGround(const SurfaceParameters& surface);

/// What hides the truth: a dynamic tracked vehicle on sheared ground.
/** Motor power -> drive force against belt speed -> belt speed -> slip -> shear of the ground ->
   motion of the body in the tangent plane of the ground. Semi-implicit integration, meant for steps
   of 1 ms. */
class TrackedVehicle {
 public:
  explicit TrackedVehicle(const VehicleParameters& parameters);

  /// Advances by dt [s]. Power is clamped to -1..1.
  void step(const MotorPower& power, const Ground& ground, double dt);

  /// Velocity of the body origin in the body frame.
  Twist2 velocity() const {
    return {v_centre_.v_x, v_centre_.v_y - v_centre_.omega * parameters_.centre, v_centre_.omega};
  }
  const TrackDrive& left() const { return left_; }
  const TrackDrive& right() const { return right_; }
  const Battery& battery() const { return battery_; }
  const VehicleParameters& parameters() const { return parameters_; }

  /// Stops the body at once, as a hard obstacle does; the tracks go on turning.
  void stopBody() { v_centre_ = {}; }
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
  Twist2 v_centre_;  ///< of the centre of mass, axes of the body
};

}  // namespace tread::sim
