// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "common/geometry/track.hpp"
#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

/// A pose of the body by scan matching, in its own drifting frame.
struct ScanPose {
  int64_t utime = 0;  ///< [us]
  Pose2 T_scan_body;
  Twist2 v_body;
  /// Standard deviations of x, y, yaw since the start of its track [m, rad].
  Eigen::Vector3d std = Eigen::Vector3d::Zero();
  bool new_track = false;  ///< not connected with the poses before
};

/// When, and up to which drift, scan matching replaces the device, with defaults.
struct FillInConfig {
  int64_t after_us = 150'000;  ///< [us] of silence after which scan poses are used
  double max_drift = 0.5;  ///< [m] estimated standard deviation since the last pose of the device
  double max_yaw_drift = 0.1;  ///< [rad] the same: beyond it nothing is filled in
  /// [m] difference from which a new pose of the device is a jump, not a correction
  double jump = 0.2;
  double yaw_jump = 0.1;  ///< [rad] the same
};

/// Fills in poses missing from the device: scan matching measures the motion since its last
/// complete pose.
/** Whenever the device has position and heading, the two tracks are aligned. From there a missing
 * position or heading is completed; while the device is silent, each pose of scan matching becomes
 * an estimate. Its standard deviation is the device's, plus the drift of scan matching and the
 * effect of a heading error on the displacement. Scans do not measure roll, pitch and height: roll
 * and pitch are unknown, the height is kept. */
class FillIn {
 public:
  explicit FillIn(const FillInConfig& config) : config_(config) {}

  /// Takes a pose of scan matching.
  void observe(const ScanPose& pose);
  /// Takes the device's estimate at `now` and completes it. Returns false if it must be left out,
  /// because a later one was already filled in.
  bool complete(InsEstimate& estimate, int64_t now);
  /// The next estimate while the device is silent.
  std::optional<InsEstimate> next(int64_t now);

  /// Number of estimates completed or filled in.
  int64_t filled() const { return filled_; }
  /// [us] since when estimates have been filled in; nullopt while the device sends them, or if
  /// there are none at all.
  std::optional<int64_t> since() const { return since_; }
  /// [us] of the newest pose of scan matching.
  std::optional<int64_t> newestScan() const;

 private:
  /// Poses of both tracks at the same instant.
  struct Anchor {
    Pose2 T_map_body;
    Eigen::Vector3d device_std;  ///< of x, y, yaw
    double z = kUnmeasured;
    ScanPose scan;
  };
  /// A pose of the body by scan matching.
  struct Filled {
    Pose2 T_map_body;
    Twist2 v_body;
    Eigen::Vector3d std;  ///< of x, y, yaw
  };

  void anchor();
  void measured(InsEstimate& estimate);
  std::optional<Filled> at(int64_t utime) const;
  void markFilled(int64_t utime);

  FillInConfig config_;
  PoseTrack device_{1'000'000};
  Eigen::Vector3d device_std_ = Eigen::Vector3d::Constant(kUnmeasured);
  double device_z_ = kUnmeasured;
  std::optional<ScanPose> scan_;  ///< the newest
  PoseTrack scans_{1'000'000};
  std::optional<Anchor> anchor_;
  int64_t heard_ = 0;                  ///< [us] of the device's last data
  std::optional<int64_t> last_utime_;  ///< [us] of the last estimate
  std::optional<int64_t> since_;
  int64_t filled_ = 0;
};

}  // namespace tread::ins
