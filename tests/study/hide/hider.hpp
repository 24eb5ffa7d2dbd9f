// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/vehicle.hpp"

namespace tread::blind {

/// State that a hider can use: one step of 1 ms of a drive.
struct Moment {
  double time = 0.0;       ///< [s] since the log began
  double dt = 0.001;       ///< [s]
  sim::MotorPower order;   ///< as in the log, -1..1
  Twist2 v_body;           ///< of the body origin, before the ground's noise
  double belt_left = 0.0;  ///< [m/s]
  double belt_right = 0.0;
  double current_left = 0.0;  ///< [A]
  double current_right = 0.0;
  double voltage = 0.0;  ///< [V]
  double pitch = 0.0;    ///< nose down positive [rad]
  double roll = 0.0;     ///< left side up positive [rad]
};

/// Parts of the vehicle that can be modified.
struct Build {
  sim::VehicleParameters vehicle;
  sim::SurfaceParameters surface;
};

/// Systematic errors of the instruments.
struct InstrumentFault {
  double pose_latency = 0.0;     ///< of position and heading, not of the gyro [s]
  double all_latency = 0.0;      ///< of all INS values [s]
  double heading_latency = 0.0;  ///< of the heading relative to the position [s]
  double gyro_bias = 0.0;        ///< [rad/s]
  double gyro_warm_up = 0.0;     ///< additional bias when cold, decays within minutes [rad/s]
  /// of the body relative to the INS: v_y gains this share of v_x [rad]
  double misalignment = 0.0;
  double antenna_x = 0.0;  ///< the measured point, in body [m]
  double antenna_y = 0.0;
  double position_scale = 0.0;  ///< of all distances [1]
};

/// A number with a name, in files.
struct Quantity {
  std::string name;
  double value = 0.0;
  std::string unit;
  bool measured = false;  ///< found by driving with and without; else known by construction
};

/// Means over the steady second half of one pattern, with and without the effect, without noise.
struct SteadyPair {
  Twist2 with;
  Twist2 without;
  sim::MotorPower order;
  double time = 0.0;   ///< [s]
  double duty = 0.0;   ///< squared power, low-pass of 180 s, without scale [1]
  double pitch = 0.0;  ///< in the drive with the effect [rad]
  double roll = 0.0;
};

/// Data for measuring an effect's size.
struct Comparison {
  std::vector<SteadyPair> pairs;
  double duration = 0.0;  ///< [s] of the log
  double speed = 1.2;     ///< track speed per power of the plain vehicle [m/s]
};

/// Place of a hider in the power path.
enum class Stage { kWire, kSignal, kStage, kRamp, kMotor };

/// One way of hiding: modifications of the simulated vehicle or its instruments. Empty functions do
/// nothing.
struct Hider {
  Stage stage = Stage::kStage;
  /// Before the drive, and at the times in `due`: another vehicle or ground.
  std::function<void(double time, Build& build)> build;
  std::vector<double> due;  ///< [s] when build is called again
  std::function<sim::MotorPower(const Moment&, sim::MotorPower)> drive;
  std::function<sim::OutsideForce(const Moment&)> push;
  std::function<Twist2(const Moment&, Twist2)> slide;
  std::function<void(const Moment&, sim::TrackedVehicle&)> touch;
  std::function<void(InstrumentFault&)> sense;
  /// members of its spec's group that this hider can be distinguished from
  std::vector<std::string> unlike;
  std::vector<Quantity> levers;      ///< the modified values
  std::vector<Quantity> equivalent;  ///< in the catalogue's terms, if known without measuring
  /// In the catalogue's terms, from a comparison.
  std::function<std::vector<Quantity>(const Comparison&)> measure;
};

}  // namespace tread::blind
