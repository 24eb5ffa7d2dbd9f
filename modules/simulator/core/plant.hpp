// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/drive.hpp"
#include "modules/simulator/core/track_contact.hpp"

namespace tread::sim {

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

/// The vehicle of a simulated robot as its devices and the world see it: power in, motion out.
/** Body origin on the ground midway between the tracks, x forward, y left. */
class Plant {
 public:
  virtual ~Plant() = default;

  /// Advances by dt [s]. Power is clamped to -1..1.
  virtual void step(const MotorPower& power, const Ground& ground, double dt) = 0;
  /// Velocity of the body origin in the body frame: what moves it through the next step.
  virtual Twist2 velocity() const = 0;
  virtual const TrackDrive& left() const = 0;
  virtual const TrackDrive& right() const = 0;
  virtual const Battery& battery() const = 0;
  /// Stops the body at once, as a hard obstacle does; the tracks go on turning.
  virtual void stopBody() = 0;

  /// Whether the spread of the world's surfaces disturbs its motion; else it has all its noise in
  /// itself.
  virtual bool disturbedByGround() const { return true; }
  /// What it is called, where the user chose it; may be empty.
  virtual std::string name() const { return {}; }
  /// Why its motion is not to be relied on, in one line; empty = nothing known against it.
  virtual std::string warning() const { return {}; }
};

}  // namespace tread::sim
