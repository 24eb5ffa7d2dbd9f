// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "modules/ins_driver/core/ins_source.hpp"
#include "modules/ins_driver/core/track_monitor.hpp"
#include "modules/ins_driver/nmea/epoch_collector.hpp"
#include "modules/ins_driver/nmea/nmea_parser.hpp"

namespace tread::ins {

/// How the device lies, as it says itself: yaw counter-clockwise from east, nose down positive
/// [rad].
struct Attitude {
  double yaw = 0.0;
  std::optional<double> pitch;
  std::optional<double> roll;
  double yaw_std = 0.0;    ///< NaN where the device does not tell
  double pitch_std = 0.0;  ///< NaN likewise
  double roll_std = 0.0;   ///< NaN likewise
};

/// Attitude of an epoch from PASHR, heading also from HDT; nothing without a heading.
std::optional<Attitude> attitudeOf(const Epoch& epoch);

/// The last measured attitudes, to bridge the short time to a position that was measured in
/// between.
class AttitudeMemory {
 public:
  /// An attitude is carried at most `hold_us` beyond its time.
  explicit AttitudeMemory(int64_t hold_us) : hold_us_(hold_us) {}

  void add(int64_t utime, const Attitude& attitude);
  /// The newest attitude if it is at most the hold time old, yaw carried on with its rate.
  /** The whole carried angle is added to the standard deviation of yaw. */
  std::optional<Attitude> at(int64_t utime) const;
  /// Adds pitch and roll of the newest attitude to one that has only a heading, within the hold
  /// time.
  void complete(int64_t utime, Attitude& attitude) const;
  /// Rate between the last two headings, where both are near `utime`: [rad/s], counter-clockwise
  /// positive.
  std::optional<double> yawRate(int64_t utime) const;
  void clear();

 private:
  int64_t hold_us_;
  std::optional<Attitude> newest_;
  int64_t newest_utime_ = 0;
  std::optional<double> rate_;
};

/// Standard deviation of a GGA position along east, north, up [m]; NaN without HDOP or for an
/// estimated fix.
/** Range error times dilution of precision. Range errors by fix quality [m, one sigma]:
    - standard, precise: 3.9. GPS SPS Performance Standard (4th ed., 2008): 7.8 m at 95 %, all ages
   of data;
    - differential, augmented: 1.0. A quarter of it, the ratio that gpsd uses between the two (15
   : 3.75 m);
    - RTK fixed: 0.02, float: 0.4. What makers of dual-frequency receivers commonly promise: 1 cm +
   1 ppm of the base line, here 10 km; float 0.4 m;
    - estimated (dead reckoning): unknown, because it grows with time.
    HDOP holds both horizontal axes, so each has 1/sqrt(2) of it; the vertical one is taken as twice
   the horizontal. */
Eigen::Vector3d positionStd(const Gga& gga);

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
