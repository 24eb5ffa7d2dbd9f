// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include <Eigen/Core>

#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

/// Relation of a position to the track before it.
enum class TrackStep : uint8_t {
  kNear,     ///< it goes on
  kDoubted,  ///< the vehicle cannot have come here: possibly wrong, the next position decides
  kJump      ///< nor to the doubted one before, but is close to it: so that was right
};

/// Detects gaps and jumps in a track: motion that the vehicle cannot have made is a measurement
/// error.
class TrackMonitor {
 public:
  explicit TrackMonitor(const InsConfig& config)
      : period_us_(config.period_us), max_speed_(config.max_speed), slack_(config.jump_slack) {}

  /// Whether this message comes more than three periods after the previous one.
  /** The period is the configured one, or the median of the last nine intervals once there are
   * three. */
  bool isGap(int64_t utime);
  /** A single distant position passed a weak checksum: 8 bits accept one damaged message in 256. */
  TrackStep judge(int64_t utime, const Eigen::Vector3d& p_map_body);
  /// The next position is not compared with earlier ones.
  void restart() { last_.reset(); }

 private:
  struct Place {
    int64_t utime;
    Eigen::Vector2d p_map;
  };

  int64_t typicalPeriod() const;
  bool canCome(const Place& from, const Place& to) const;

  int64_t period_us_;
  double max_speed_;
  double slack_;
  std::deque<int64_t> intervals_;
  std::optional<int64_t> last_utime_;
  std::optional<Place> last_, doubted_;
};

/// Converts device time to host time so that jitter of line, scheduler and polling does not affect
/// the measurement time.
/** A message never arrives before it was sent: the smallest (arrival - device time) of a sliding
 * window is the best estimate of the clocks' offset plus the minimum delay. The window bounds the
 * error of a drifting device clock: 10 s times 50 ppm is 0.5 ms. */
class ArrivalFilter {
 public:
  explicit ArrivalFilter(int64_t window_us) : window_us_(window_us) {}

  /// Adds an arrival [us host] of a device time [us]. A device time before the last one means that
  /// the device's clock was set: the estimate restarts.
  void add(int64_t device_time, int64_t arrival) {
    if (!samples_.empty() && device_time < samples_.back().device_time) samples_.clear();
    const int64_t offset = arrival - device_time;
    while (!samples_.empty() && samples_.back().offset >= offset) samples_.pop_back();
    samples_.push_back({device_time, offset});
    while (samples_.front().device_time < device_time - window_us_) samples_.pop_front();
  }
  /// Host time of a device time; for an added one at most its arrival.
  int64_t hostTime(int64_t device_time) const { return device_time + offset(); }
  /// Smallest offset in the window, 0 before the first arrival [us].
  int64_t offset() const { return samples_.empty() ? 0 : samples_.front().offset; }

 private:
  struct Sample {
    int64_t device_time;
    int64_t offset;
  };
  int64_t window_us_;
  std::deque<Sample> samples_;  ///< offsets in ascending order: the front is the minimum
};

}  // namespace tread::ins
