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

/// Where scan matching says that the body is, in a frame of its own that drifts.
struct ScanPose {
  int64_t utime = 0;  ///< [us]
  Pose2 T_scan_body;
  Twist2 v_body;
  /// Standard deviations of x, y, yaw since the start of its track [m, rad].
  Eigen::Vector3d std = Eigen::Vector3d::Zero();
  bool new_track = false;  ///< not connected with the poses before
};

/// When and how far scan matching stands in for the device, with its defaults.
struct FillInConfig {
  int64_t after_us = 150'000;  ///< [us] of silence, after which the scans' own poses are given
  double max_drift = 0.5;      ///< [m] told standard deviation since the device knew the pose
  double max_yaw_drift = 0.1;  ///< [rad] the same: beyond, nothing is filled in
  double jump = 0.2;           ///< [m] by which a pose of the device then is a jump, no correction
  double yaw_jump = 0.1;       ///< [rad] the same
};

/// Gives the poses that the device does not: the motion since its last whole pose is measured by
/// scan matching.
/** Whenever the device knows position and heading, the two tracks are laid onto each other. From
 * there on a missing position or heading is completed; where the device is silent, each pose of
 * scan matching becomes an estimate. Their deviation is the device's, with what scan matching adds
 * on the way and what a wrong heading makes of the way. Roll, pitch and height are not measured by
 * scans: unknown, and as they were. */
class FillIn {
 public:
  explicit FillIn(const FillInConfig& config) : config_(config) {}

  /// Takes a pose of scan matching.
  void observe(const ScanPose& pose);
  /// Takes what the device gave at `now`, and completes it. Returns false if the estimate must be
  /// left out, because a later one was filled in already.
  bool complete(InsEstimate& estimate, int64_t now);
  /// The next estimate while the device is silent.
  std::optional<InsEstimate> next(int64_t now);

  /// Estimates that were completed or filled in.
  int64_t filled() const { return filled_; }
  /// [us] since when estimates have been filled in; nothing while the device gives them, or nobody.
  std::optional<int64_t> since() const { return since_; }
  /// [us] of the newest pose of scan matching.
  std::optional<int64_t> newestScan() const;

 private:
  /// The two tracks at the same instant.
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
  int64_t heard_ = 0;                  ///< [us] when the device gave something
  std::optional<int64_t> last_utime_;  ///< [us] of the last estimate
  std::optional<int64_t> since_;
  int64_t filled_ = 0;
};

}  // namespace tread::ins
