// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_document.hpp"
#include "modules/simulator/core/instruments.hpp"
#include "modules/simulator/core/noise.hpp"
#include "modules/simulator/core/robot.hpp"

namespace tread::sim {

/// An INS with the delays, misalignments and biases of the measurement part of a model file.
/** Position, heading and yaw rate are those of measuredAt(). The other quantities are consistent
 * with them: height, attitude and velocity are as old as the position; the velocity is that of the
 * reference point, rotated so that its course in the map stays correct with the measured heading.
 * A negative latency extrapolates along the arc of the last two samples, like an INS that predicts
 * to compensate for its delay. */
class ModelIns final : public InsErrors {
 public:
  ModelIns(const MeasurementModel& measurement, int64_t start_utime)
      : measurement_(measurement), start_utime_(start_utime) {}

  InsInput sensed(int64_t utime, const InsInput& truth) override;

 private:
  void remember(const MotionSample& now, const InsInput& truth);
  InsInput inputAt(double time) const;

  MeasurementModel measurement_;
  int64_t start_utime_;
  std::vector<MotionSample> motion_;  ///< of the last seconds
  std::vector<InsInput> truths_;      ///< at the same times
};

/// A vehicle that moves according to a model file: shows the influence of a named effect.
/** The kernel is stepped with the simulator; its inputs are power or track speeds, session time,
 * attitude and the drop of the battery's voltage. The world's surfaces have no influence: a model
 * file describes one ground. Its spread varies along the drive like the dynamic vehicle's. The
 * battery is the dynamic vehicle's, loaded by the current that this one draws at the same power
 * straight ahead on grass. The reported motor currents are those at the drive's speed, plus a
 * share for the speed lost to the ground. */
class ModelVehicle final : public Plant {
 public:
  /// `noise_seed`: of the spread; without it every execution is the mean. `top_speed` [m/s]: for a
  /// model of track speeds, the largest command; `max_steering` [rad]: of a car.
  ModelVehicle(const ModelDocument& document, std::optional<uint64_t> noise_seed, double top_speed,
               double max_steering = 0.0);

  bool takesSpeeds() const override { return model_.kind == CommandKind::kTrackSpeed; }
  void step(const MotorPower& power, const Ground& ground, double dt) override;

  /// Moves from pose to pose of the kernel in steps of constant velocity in the map.
  Twist2 velocity() const override { return v_body_; }
  const TrackDrive& left() const override { return left_; }
  const TrackDrive& right() const override { return right_; }
  const Battery& battery() const override { return battery_; }
  void stopBody() override {
    kernel_.stopBody();
    mean_.stopBody();
  }
  bool disturbedByGround() const override { return false; }
  std::string name() const override { return model_.name; }
  /// Demands outside of the model's envelope, for the mean motion without noise.
  std::string warning() const override;

 private:
  void varyNoise();
  void drawCurrent(const TrackCommand& command, double dt);

  VehicleModel model_;
  double full_command_;  ///< power 1, or the top speed [m/s]
  double max_steering_;  ///< [rad]
  VehicleKernel kernel_;
  VehicleKernel mean_;  ///< the same without noise
  std::optional<Envelope> known_;
  Envelope asked_;
  MotionSpread spread_;
  std::optional<MotionNoise> noise_;
  int64_t steps_ = 0;
  double session_time_ = 0.0;  ///< [s]
  Twist2 v_body_;
  DriveParameters drive_;
  TrackDrive left_;
  TrackDrive right_;
  Battery battery_;
};

/// Vehicle and INS of a model file, for a robot with these settings.
/** The INS part is null if the file has no measurement effects. */
RobotParts partsOf(const ModelDocument& document, const RobotSettings& settings);

}  // namespace tread::sim
