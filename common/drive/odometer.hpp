// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include <tread/ins_t.hpp>

#include "common/drive/drive_reader.hpp"
#include "common/geometry/se2.hpp"

namespace tread {

/// Farther from the origin of map a position is a broken number [m].
inline constexpr double kFarthestPlace = 1e6;

/// Whether a ground vehicle may have come from one measured position to the other in so many
/// seconds.
inline bool isWithinReach(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double seconds) {
  constexpr double kFastest = 30.0;  // [m/s]
  constexpr double kNoise = 1.0;     // [m] of poses that are near each other in time
  return (to - from).norm() <= kNoise + kFastest * std::abs(seconds);
}

/// Adds up the metres that a robot drove, from the INS messages of a log.
/** Only what lies between poses that follow each other was driven: not over a jump that the INS
 * tells, a new beginning of the robot's clock, or a distance that no ground vehicle goes in that
 * time. Messages out of order, or in events whose time cannot be, are left out. */
class Odometer {
 public:
  void add(const DriveEvent& event, const ins_t& ins);
  /// What comes next does not follow what came before.
  void interrupt() { newest_.reset(); }
  double distance() const { return distance_; }  ///< [m]

 private:
  struct Place {
    int64_t utime = 0;  ///< [us] by the INS
    size_t restarts = 0;
    Pose2 T_map_body;
  };
  bool follows(const Place& place) const;

  std::optional<Place> newest_;
  Pose2 counted_;  ///< up to where the distance is counted
  double distance_ = 0.0;
};

}  // namespace tread
