// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/track.hpp"
#include "modules/scan_matching/core/local_map.hpp"
#include "modules/scan_matching/core/motion_filter.hpp"
#include "modules/scan_matching/core/registration.hpp"
#include "modules/scan_matching/core/scan_points.hpp"

namespace tread::scan_matching {

/// Settings of motion estimation from scans, with defaults.
struct ScanMatcherConfig {
  Pose2 start;  ///< T_map_body at the first scan
  ScanPointsConfig points;
  RegistrationConfig registration;
  MotionConfig motion;
  int min_points = 25;        ///< of a scan, and of its points with a partner
  double min_overlap = 0.3;   ///< share of the points that must have a partner
  double search_std = 0.1;    ///< [m], and half of it in rad: larger uncertainty starts a search
  double key_distance = 0.5;  ///< [m] after which a scan is added to the local map
  double key_turn = 0.35;     ///< [rad] the same
  int key_scans = 15;         ///< in the local map
  /// [m] since the last full match: beyond it the position is unknown
  double max_position_std = 0.3;
  double max_yaw_std = 0.1;  ///< [rad] the same for the heading
  /// [s] lost, after which the map restarts at the body's present pose
  double new_map_after = 1.0;
};

/// One sweep, seen from above.
struct Sweep {
  int64_t first = 0;  ///< [us] of the first beam
  int64_t last = 0;   ///< [us] of the last
  Eigen::Vector2d p_body_sensor = Eigen::Vector2d::Zero();
  std::vector<PlanarReturn> returns;
  /// [m] more distant returns may be ground
  double trusted_range = std::numeric_limits<double>::infinity();
  bool standing = false;  ///< the motors have long been off: the body is at rest
};

/// Result of matching a scan.
enum class MatchOutcome {
  kFirst,         ///< the map starts with it
  kMatched,       ///< it determines the pose
  kUndetermined,  ///< it fits, but does not determine some direction: a corridor, a round room
  kTooFew,        ///< too few returns: an open field
  kNoFit,         ///< it does not fit the map
  kNotNewer       ///< its time is not after the previous scan's
};

/// Pose of the body at the last beam of a scan.
struct MatchedPose : TimedPose {
  MatchOutcome outcome = MatchOutcome::kFirst;
  Twist2 v_body;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y, yaw in map, since the start
  Eigen::Matrix3d local = Eigen::Matrix3d::Zero();  ///< the same relative to the newest key scan
  bool position_known = true;
  bool heading_known = true;
  bool new_track = false;  ///< not connected with the poses before
};

/// Estimates the motion of a body from a range finder alone, relative to a local map of recent
/// scans.
/** 1. The pose in the middle of the sweep is predicted (MotionFilter), and the sweep undistorted
 *    with the predicted twist.
 *  2. A very uncertain pose is first searched for; then the scan is aligned with the map
 *     (registerScan).
 *  3. A scan that fits corrects pose and twist in the directions that it determines. In the
 *     others, and without a fit, the prediction continues and its uncertainty grows; beyond
 *     max_*_std the pose is unknown, until a scan determines it again.
 *  4. Every key_distance the scan is added to the map. From then on its own uncertainty is part of
 *     all later poses: that sum is the drift, which only grows without an absolute reference. */
class ScanMatcher {
 public:
  explicit ScanMatcher(const ScanMatcherConfig& config);

  MatchedPose take(const Sweep& sweep);

  const LocalMap& map() const { return map_; }

 private:
  struct Match {
    std::vector<ScanPoint> points;
    Registration registration;
    MatchOutcome outcome = MatchOutcome::kTooFew;
  };

  MatchOutcome begin(const Sweep& sweep, const std::vector<ScanPoint>& points);
  Match match(const Sweep& sweep, const Twist2& twist) const;
  bool fits(const Registration& registration) const;
  void correct(const Registration& registration);
  MatchOutcome process(const Sweep& sweep);
  void addKeyScan(const std::vector<ScanPoint>& points);
  bool isKey() const;
  void watch(const Sweep& sweep, MatchOutcome outcome);
  MatchedPose describe(const Sweep& sweep, MatchOutcome outcome);
  Eigen::Matrix3d carried(const Eigen::Matrix3d& covariance, const Pose2& T_map_body) const;

  ScanMatcherConfig config_;
  MotionFilter filter_;
  LocalMap map_;
  std::optional<int64_t> middle_;  ///< [us] of the newest sweep: the time of the filter
  int64_t fitted_ = 0;             ///< [us] of the newest one that fitted
  Eigen::Matrix3d drift_ = Eigen::Matrix3d::Zero();    ///< of the newest key scan, in map
  Eigen::Matrix3d unfixed_ = Eigen::Matrix3d::Zero();  ///< the part since the last full match
  bool position_known_ = true;
  bool heading_known_ = true;
  bool new_track_ = true;
};

}  // namespace tread::scan_matching
