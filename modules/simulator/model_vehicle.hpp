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

/// An INS that is late, askew or biased as the measurement part of a model file says.
/** Position, heading and yaw rate are measuredAt()'s. The rest goes with them: height, attitude and
 * velocity are as old as the position; the velocity is that of the reported point, turned so that
 * its course in the map stays right under the heading that is said. A negative latency looks ahead
 * along the arc of the last two samples, as an INS does that predicts to make up for its own age.
 */
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
  std::vector<InsInput> truths_;      ///< at the same moments
};

/// A vehicle that does what a model file says: how a named effect is seen at work.
/** The kernel is stepped with the simulator; it hears power or track speeds, session time, attitude
 * and the fall of the battery's voltage. The world's surfaces do not touch it: a model file is one
 * ground. Its spread varies along the drive as the dynamic vehicle's does. The battery is the
 * dynamic vehicle's, loaded by the current that this one draws at the same power straight ahead on
 * grass. The motor currents that it reports are those at the speed that the drive gives, and more
 * for what the ground takes of it. */
class ModelVehicle final : public Plant {
 public:
  /// `noise_seed`: of the spread; without it every execution is the mean. `top_speed` [m/s]: for a
  /// model of track speeds, the largest that it is asked for; `max_steering` [rad]: of a car.
  ModelVehicle(const ModelDocument& document, std::optional<uint64_t> noise_seed, double top_speed,
               double max_steering = 0.0);

  bool takesSpeeds() const override { return model_.kind == CommandKind::kTrackSpeed; }
  void step(const MotorPower& power, const Ground& ground, double dt) override;

  /// Leads from pose to pose of the kernel in steps of constant velocity in the map.
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
  /// What is asked for outside of the model's envelope, by the mean motion: chance asks nothing.
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

/// Vehicle and INS of a model file, for a robot of these settings.
/** The INS part is null where the file says nothing of it. */
RobotParts partsOf(const ModelDocument& document, const RobotSettings& settings);

}  // namespace tread::sim
