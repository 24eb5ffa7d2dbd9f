// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "modules/ins_driver/core/attitude_memory.hpp"
#include "modules/ins_driver/core/device_epoch.hpp"
#include "modules/ins_driver/core/heading_choice.hpp"
#include "modules/ins_driver/core/ins_source.hpp"
#include "modules/ins_driver/core/position_memory.hpp"
#include "modules/ins_driver/core/track_monitor.hpp"

namespace tread::ins {

/// How often an input of a pose arrived, and how often so late that the previous one could not be
/// extrapolated that far.
struct InputCount {
  int64_t came = 0;
  int64_t apart = 0;
  std::optional<int64_t> last;  ///< [us]

  void add(int64_t utime, int64_t hold_us) {
    ++came;
    if (last && utime - *last > hold_us) ++apart;
    last = utime;
  }
};

/// Results of the epochs.
struct AssemblerCounts {
  int64_t epochs = 0;             ///< taken
  int64_t published = 0;          ///< became an estimate
  int64_t attitude_only = 0;      ///< kept for the next position
  int64_t carried = 0;            ///< positions with an attitude measured shortly before
  int64_t positions_carried = 0;  ///< attitudes with a position measured shortly before
  int64_t not_newer = 0;          ///< refused: not newer than the last one
  int64_t too_far = 0;            ///< positions refused because they are too far from the origin
  int64_t gaps = 0;
  int64_t jumps = 0;
  int64_t doubted = 0;      ///< not published: far from the previous position
  int64_t clock_steps = 0;  ///< the device's clock was set
  InputCount positions;     ///< including those without a fix
  InputCount headings;
  InputCount velocities;
  int64_t without_heading = 0;   ///< published without a heading measured near it
  int64_t without_velocity = 0;  ///< likewise
};

/// Estimates the body's pose in the map from the device's data of one instant.
class InsAssembler {
 public:
  explicit InsAssembler(const InsConfig& config);

  /// Notes the arrival of an epoch. Call it for all available epochs before solving the first of
  /// them: after a pause the newest reveals how late the others are. Not beyond an epoch before
  /// which the device's clock was set.
  void observe(const DeviceEpoch& epoch);
  /// The estimate of an observed epoch; nullopt if it contains only an attitude and no position can
  /// be extrapolated to it, or if it is not newer than the last one.
  std::optional<InsEstimate> solve(const DeviceEpoch& epoch);
  /// Takes the rates of a device that sends them separately from its epochs, about the device's
  /// axes [rad/s]. They are used for epochs within attitude_hold of their device time.
  void addRate(int64_t device_time, const Eigen::Vector3d& rate_device);

  /// The map's origin on Earth, if known: configured, or the first good fix.
  std::optional<GeoOrigin> origin() const;
  const AssemblerCounts& counts() const { return counts_; }
  const HeadingChoice& headings() const { return headings_; }
  /// Distance of the last refused position from the origin [m].
  double farDistance() const { return far_distance_; }

 private:
  int64_t measurementTime(const DeviceEpoch& epoch) const;
  bool positionsAreExpected(int64_t utime) const;
  bool isPublished(const DeviceEpoch& epoch, int64_t utime);
  void countInputs(const DeviceEpoch& epoch, int64_t utime);
  void forget();
  void setRate(const DeviceEpoch& epoch, InsEstimate& estimate) const;
  void setOrientation(const std::optional<Attitude>& attitude, InsEstimate& estimate) const;
  /// Measured, or from the last two headings, otherwise 0 [rad/s].
  double yawRateOf(const InsEstimate& estimate) const;
  /// The last reported velocity, its course rotated with the vehicle, within position_hold.
  std::optional<GroundVelocity> velocityAt(const InsEstimate& estimate) const;
  /// `arm`: the reference point in body [m].
  void setVelocity(const std::optional<GroundVelocity>& ground, const Eigen::Vector3d& arm,
                   InsEstimate& estimate) const;
  /// Of the reference point along map x and y.
  std::optional<Eigen::Vector2d> velocityInMap(const GroundVelocity& ground) const;
  /// False if the position is doubted: then the epoch gives nothing.
  bool setPosition(const DeviceEpoch& epoch, InsEstimate& estimate);
  void remember(const DeviceEpoch& epoch, const PointInMap& point, int64_t utime);
  Eigen::Vector3d armOf(const DeviceEpoch& epoch) const;
  void place(const PointInMap& point, InsEstimate& estimate) const;
  std::optional<PointInMap> pointOf(const DeviceEpoch& epoch);
  void watchTrack(InsEstimate& estimate);
  void adoptOrigin(const PositionReport& report, int64_t utime);

  struct Rate {
    int64_t device_time;
    Eigen::Vector3d rate_device;
  };

  InsConfig config_;
  Eigen::Quaterniond R_body_device_;
  std::optional<LocalFrame> frame_;
  ArrivalFilter arrival_filter_;
  HeadingChoice headings_;
  AttitudeMemory attitudes_;
  PositionMemory positions_;
  TrackMonitor monitor_;
  std::optional<Rate> rate_;
  std::optional<GroundVelocity> velocity_;  ///< the last reported one
  int64_t velocity_utime_ = 0;
  std::optional<int64_t> last_position_utime_;
  std::optional<int64_t> last_utime_;
  bool new_track_ = false;
  int incomplete_fixes_ = 0;
  int64_t first_incomplete_ = 0;  ///< host time of the first of them [us]
  double far_distance_ = 0.0;
  AssemblerCounts counts_;
};

}  // namespace tread::ins
