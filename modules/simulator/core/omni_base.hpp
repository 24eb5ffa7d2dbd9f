// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>

#include "modules/simulator/core/vehicle.hpp"

namespace tread::sim {

/// A holonomic base on sheared ground: three or more driven wheels with rollers on their rims.
/** Each wheel shears the surface below it along the axis of the roller that touches it, as a
 * track's contact patch does (TrackContact); at right angles to that axis it rolls away on the
 * roller. The ground resists in both directions, more so for the small rollers. So wheels slip
 * individually, and on non-uniform ground the base turns. Loads are those of a rigid body at rest.
 * Its motors, battery and gears are those of DriveParameters, one set per wheel. */
class OmniBase final : public Plant {
 public:
  explicit OmniBase(const VehicleParameters& parameters);

  void step(const MotorPower& power, const Ground& ground, double dt) override;

  Twist2 velocity() const override {
    return {v_mass_.v_x, v_mass_.v_y - v_mass_.omega * parameters_.mass_ahead, v_mass_.omega};
  }
  size_t motors() const override { return parameters_.wheels.size(); }
  const TrackDrive& motor(size_t i) const override { return drives_[i]; }
  const TrackDrive& left() const override { return drives_[0]; }
  const TrackDrive& right() const override { return drives_[1]; }
  const Battery& battery() const override { return battery_; }
  void stopBody() override { v_mass_ = {}; }

 private:
  struct Force {
    double x = 0.0, y = 0.0, moment = 0.0;  ///< [N, N, N m] on the body, at its origin
    TrackLoad on_wheel;
  };
  Force forceOn(size_t wheel, const SurfaceParameters& ground, double load, double dt);

  VehicleParameters parameters_;
  std::array<TrackContact, kMostMotors> contacts_;
  std::array<SurfaceParameters, kMostMotors> grounds_;  ///< as it acts on the rollers
  std::array<TrackDrive, kMostMotors> drives_;
  Battery battery_;
  Twist2 v_mass_;  ///< of the centre of mass, axes of the body
};

}  // namespace tread::sim
