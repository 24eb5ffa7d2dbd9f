// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <optional>

#include "modules/ins_driver/core/arrival_filter.hpp"
#include "modules/ins_driver/core/attitude.hpp"
#include "modules/ins_driver/core/ins_estimate.hpp"
#include "modules/ins_driver/core/track_monitor.hpp"

namespace tread::ins {

/// What became of the epochs.
struct AssemblerCounts {
  int64_t epochs = 0;         ///< taken
  int64_t published = 0;      ///< became an estimate
  int64_t attitude_only = 0;  ///< kept for the next position
  int64_t carried = 0;        ///< positions with an attitude that was measured shortly before
  int64_t not_newer = 0;      ///< refused: their time is not after the last one
  int64_t too_far = 0;        ///< positions refused because they are too far from the origin
  int64_t gaps = 0;
  int64_t jumps = 0;
  int64_t clock_steps = 0;  ///< the device's clock was set
};

/// Makes an estimate of the body in the map from what the device said about one instant.
class InsAssembler {
 public:
  explicit InsAssembler(const InsConfig& config);

  /// Takes note of when an epoch arrived. To be called for all that are there before the first of
  /// them is solved: after a pause the newest knows best how late the others are. Not beyond one
  /// before which the device's clock was set.
  void observe(const Epoch& epoch);
  /// The estimate of an observed epoch; nothing if only the attitude was measured (it is kept for
  /// the next position) or if its time is not after the last one.
  std::optional<InsEstimate> solve(const Epoch& epoch);

  /// The map's place on Earth once there is one: configured, or the first good fix.
  std::optional<GeoOrigin> origin() const;
  const AssemblerCounts& counts() const { return counts_; }
  /// Distance of the last refused position from the origin [m].
  double farDistance() const { return far_distance_; }

 private:
  int64_t measurementTime(const Epoch& epoch) const;
  bool positionsAreExpected(int64_t utime) const;
  bool isPublished(const Epoch& epoch, int64_t utime);
  void setOrientation(const std::optional<Attitude>& attitude, InsEstimate& estimate) const;
  void setVelocity(const Epoch& epoch, InsEstimate& estimate) const;
  void setPosition(const Epoch& epoch, InsEstimate& estimate);
  void setAccuracy(const Epoch& epoch, InsEstimate& estimate) const;
  void watchTrack(InsEstimate& estimate);
  void adoptOrigin(const Epoch& epoch);

  InsConfig config_;
  Eigen::Quaterniond R_body_device_;
  std::optional<LocalFrame> frame_;
  ArrivalFilter arrival_filter_;
  AttitudeMemory attitudes_;
  TrackMonitor monitor_;
  std::optional<int64_t> last_position_utime_;
  std::optional<int64_t> last_utime_;
  bool new_track_ = false;
  int fixes_without_gga_ = 0;
  double far_distance_ = 0.0;
  AssemblerCounts counts_;
};

}  // namespace tread::ins
