// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/geometry/se2.hpp"

namespace tread {

/// Something that a log says.
struct Note {
  double time = 0.0;  ///< [s] since the log began
  size_t event = 0;   ///< number of its event in the log
};

/// An INS message.
struct InsNote : Note {
  int64_t utime = 0;   ///< [us]
  int32_t status = 0;  ///< ins_t::STATUS_*
  Pose2 T_map_body;
  bool placed = false;      ///< it has a pose that can be one
  bool wrong_time = false;  ///< of its event, see DriveEvent
  size_t restarts = 0;      ///< the same
};

/// A position farther from the origin of map is a corrupt number [m].
inline constexpr double kFarthestPlace = 1e6;

/// Whether a ground vehicle could have moved between two measured positions in this time [s].
inline bool isWithinReach(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double seconds) {
  constexpr double kFastest = 30.0;  // [m/s]
  constexpr double kNoise = 1.0;     // [m] between poses that are close in time
  return (to - from).norm() <= kNoise + kFastest * std::abs(seconds);
}

/// Sums the distance that a robot drove, from the INS messages of a log.
/** Counts only distances between consecutive poses: not across a jump reported by the INS, a
 * restart of the robot's clock, or a distance that no ground vehicle covers in that time. Messages
 * out of order, or in events with an impossible time, are left out. */
class Odometer {
 public:
  void add(const InsNote& ins);
  /// The next pose is not connected with the previous one.
  void interrupt() { newest_.reset(); }
  double distance() const { return distance_; }  ///< [m]

 private:
  bool follows(const InsNote& place) const;

  std::optional<InsNote> newest_;
  Pose2 counted_;  ///< up to here the distance is counted
  double distance_ = 0.0;
};

}  // namespace tread
