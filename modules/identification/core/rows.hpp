// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "modules/identification/core/simulation.hpp"

namespace tread::gap {

/// What a row compares: mean rates over an interval, in the body frame of its beginning.
enum class Channel { kYawRate, kHeading, kAlong, kAcross };
inline constexpr size_t kChannels = 4;

/// Name of a channel in reports: "yaw rate", "heading rate", "along", "lateral".
const char* channelName(Channel channel);
/// Its unit: rad/s or m/s.
const char* channelUnit(Channel channel);

/// One comparison of measurement and simulation.
struct Row {
  Channel channel = Channel::kYawRate;
  size_t drive = 0;
  size_t stretch = 0;     ///< of the drive
  double begin = 0.0;     ///< [s] since the drive's first message
  double end = 0.0;       ///< [s]
  double measured = 0.0;  ///< [rad/s] or [m/s], mean over the interval
  int block = 0;          ///< index of the block of driving in which it lies
};

/// How drives are cut.
struct RowSettings {
  double gyro_bin = 0.25;      ///< [s] over which the gyro is averaged
  double pose_interval = 0.4;  ///< [s] at least, between fixes
  double longest = 1.2;        ///< [s] at most, between fixes
  double smoothing = 0.05;     ///< [s] to either side over which frequent fixes are averaged
  double block = 20.0;         ///< [s] of driving, at least
  double piece = 0.05;         ///< [s] of simulation
};

/// Rows of drives, and what a model predicts for them.
/** Increments instead of poses: the integral form, which needs no differentiation and lets the
 * simulation run open loop over any time (gap.md 4.8). The measurement part of a model acts on the
 * simulated motion, so that rows compare what the INS says with what it would say. */
class Rows {
 public:
  /// The drives must outlive the rows.
  Rows(const std::vector<Drive>& drives, const RowSettings& settings);

  const std::vector<Row>& rows() const { return rows_; }
  const std::vector<Drive>& drives() const { return drives_; }
  int blocks() const { return blocks_; }
  double blockLength() const { return block_length_; }  ///< [s] of driving

  /// True motions of all stretches, drive after drive.
  std::vector<std::vector<MotionSample>> simulate(const VehicleModel& vehicle) const;
  /// One of them.
  std::vector<MotionSample> simulateStretch(size_t index, const VehicleModel& vehicle) const {
    return plans_[index].simulate(vehicle);
  }
  /// What the rows would be if the vehicle and the INS were the model's (rows x 1).
  Eigen::VectorXd predict(const ModelDocument& model) const;
  /// The same from simulated motions.
  Eigen::VectorXd predict(const std::vector<std::vector<MotionSample>>& motions,
                          const MeasurementModel& measurement) const;
  /// Measured less predicted (rows x 1).
  Eigen::VectorXd residuals(const Eigen::VectorXd& predicted) const {
    return measured_ - predicted;
  }
  /// Block in which a moment of a stretch lies.
  int blockAt(size_t drive, size_t stretch, double time) const;
  /// Index of a stretch among all, as in simulate().
  size_t stretchIndex(size_t drive, size_t stretch) const {
    return first_stretch_[drive] + stretch;
  }

 private:
  void addDrive(size_t drive, double block);
  void addGyro(const Stretch& stretch, const Row& like);
  void addPoses(const Stretch& stretch, const Row& like);

  const std::vector<Drive>& drives_;
  RowSettings settings_;
  std::vector<StretchPlan> plans_;
  std::vector<size_t> first_stretch_;  ///< of each drive among all
  /// Of each stretch: driving before it in its drive, and its own [s].
  std::vector<std::pair<double, double>> driven_;
  std::vector<std::pair<int, int>> drive_blocks_;  ///< of each drive: first block and their number
  std::vector<double> drive_lengths_;              ///< of each drive: length of its blocks [s]
  std::vector<Row> rows_;
  Eigen::VectorXd measured_;
  int blocks_ = 0;
  double block_length_ = 0.0;
};

}  // namespace tread::gap
