// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tread::sim {

/// Spread of the motion from one execution of 1 s to the next; reference/calibration.yaml.
struct MotionSpread {
  double forward = 0.0;  ///< sig_f, relative, of the forward gain [1]
  double yaw = 0.0;      ///< sig_psi, relative, of the yaw gain [1]
  double heading = 0.0;  ///< sig_del, of the direction of motion against the body axis [rad]
};

/// What a kind of ground does to a track.
struct SurfaceParameters {
  std::string name;
  double friction = 0.8;  ///< limit of shear over normal force [1]
  double shear_displacement =
      0.03;  ///< displacement of the ground at which shear along the track saturates [m]
  double lateral_displacement = 0.1;  ///< the same across the track [m]
  double resistance_constant = 0.01;  ///< rolling resistance over normal force at any speed [1]
  double resistance_viscous = 0.05;   ///< rolling resistance over normal force per speed [s/m]
  double scrub_resistance = 1.0;      ///< against sideways slip, over normal force and speed [s/m]
  double pressure_offset = 0.0;       ///< centre of pressure ahead of the patch's middle [m]
  MotionSpread spread;
};

/// The built-in surfaces: cinder, tarmac, grass, gravel, sand, ice.
const std::vector<SurfaceParameters>& builtInSurfaces();

/// A built-in surface by name; nothing if there is none of that name.
std::optional<SurfaceParameters> builtInSurface(const std::string& name);

}  // namespace tread::sim
