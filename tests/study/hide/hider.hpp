// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/vehicle.hpp"

namespace tread::blind {

/// What a hider may look at: one step of 1 ms of a drive.
struct Moment {
  double time = 0.0;       ///< [s] since the log began
  double dt = 0.001;       ///< [s]
  sim::MotorPower order;   ///< as the log has it, -1..1
  Twist2 v_body;           ///< of the body origin, before the ground's noise
  double belt_left = 0.0;  ///< [m/s]
  double belt_right = 0.0;
  double current_left = 0.0;  ///< [A]
  double current_right = 0.0;
  double voltage = 0.0;  ///< [V]
  double pitch = 0.0;    ///< nose down positive [rad]
  double roll = 0.0;     ///< left side up positive [rad]
};

/// What can be built differently.
struct Build {
  sim::VehicleParameters vehicle;
  sim::SurfaceParameters surface;
};

/// How the instruments err, beside noise.
struct InstrumentFault {
  double pose_latency = 0.0;     ///< of position and heading, not of the gyro [s]
  double all_latency = 0.0;      ///< of everything that the INS says [s]
  double heading_latency = 0.0;  ///< of the heading alone, against the position [s]
  double gyro_bias = 0.0;        ///< [rad/s]
  double gyro_warm_up = 0.0;     ///< more bias when cold, gone after minutes [rad/s]
  double misalignment = 0.0;     ///< of body against INS: v_y gains this share of v_x [rad]
  double antenna_x = 0.0;        ///< the point whose position is measured, in body [m]
  double antenna_y = 0.0;
  double position_scale = 0.0;  ///< of all distances [1]
};

/// A number with a name, in files.
struct Quantity {
  std::string name;
  double value = 0.0;
  std::string unit;
  bool measured = false;  ///< found by driving with and without; else so by construction
};

/// Means over the steady second half of one pattern, with the effect and without, noise apart.
struct SteadyPair {
  Twist2 with;
  Twist2 without;
  sim::MotorPower order;
  double time = 0.0;   ///< [s]
  double duty = 0.0;   ///< squared power, low-pass of 180 s, without scale [1]
  double pitch = 0.0;  ///< in the drive with the effect [rad]
  double roll = 0.0;
};

/// All that an effect's size can be measured from.
struct Comparison {
  std::vector<SteadyPair> pairs;
  double duration = 0.0;  ///< [s] of the log
  double speed = 1.2;     ///< track speed per power of the plain vehicle [m/s]
};

/// Where in the power path a hider sits.
enum class Stage { kWire, kSignal, kStage, kRamp, kMotor };

/// One way of hiding: levers on the simulated vehicle or its instruments. Empty ones do nothing.
struct Hider {
  Stage stage = Stage::kStage;
  /// Before the drive, and whenever `due` says so: another vehicle or ground.
  std::function<void(double time, Build& build)> build;
  std::vector<double> due;  ///< [s] when build is to be called again
  std::function<sim::MotorPower(const Moment&, sim::MotorPower)> drive;
  std::function<sim::OutsideForce(const Moment&)> push;
  std::function<Twist2(const Moment&, Twist2)> slide;
  std::function<void(const Moment&, sim::TrackedVehicle&)> touch;
  std::function<void(InstrumentFault&)> sense;
  std::vector<std::string> unlike;   ///< of its spec's group: what this one can be told from
  std::vector<Quantity> levers;      ///< what was turned, as it is
  std::vector<Quantity> equivalent;  ///< in the catalogue's terms where that needs no measuring
  /// In the catalogue's terms, found by comparing.
  std::function<std::vector<Quantity>(const Comparison&)> measure;
};

}  // namespace tread::blind
