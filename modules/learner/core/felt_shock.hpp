// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace tread::learner {

/// What the INS says of the body at one moment.
struct BodyMotion {
  int64_t utime = 0;                                ///< [us]
  Eigen::Vector2d p_map = Eigen::Vector2d::Zero();  ///< body origin [m]
  double rise = 0.0;   ///< height gained per metre along x_body [1]: sine of the nose-up angle
  double speed = 0.0;  ///< along x_body [m/s]; NaN: the positions tell
  double climb = 0.0;  ///< vertical velocity of the body origin in map [m/s]; NaN: speed x rise
};

/// How a segment of ground shook the vehicle.
struct FeltSegment {
  int64_t utime = 0;                   ///< [us] of its end
  std::vector<Eigen::Vector2d> p_map;  ///< the way of the body origin [m], a point a bin
  double speed = 0.0;                  ///< mean magnitude [m/s]
  double shock = 0.0;                  ///< RMS vertical acceleration of the front end [m/s2]
  double peak = 0.0;                   ///< the largest of it [m/s2]
  double pitch_rate = 0.0;             ///< RMS [rad/s]
};

/// Turns INS measurements into shock, segment by segment of the way.
/** 1. Measurements are averaged in bins of a tenth of a second: that is the band, up to about 3 Hz.
 *  2. The front end lies `arm` ahead of the body origin; its vertical acceleration is the first
 *     difference of the climb and the second difference of the rise, over three bins in turn.
 * Angles are measured much better than heights, so that heights are not used.
 *  3. What the INS shows while the vehicle stands is its noise; its mean square is taken off.
 * A gap, or a place or attitude that is not finite, begins anew, and the segment so far is dropped.
 */
class FeltShock {
 public:
  static constexpr int64_t kBin = 100'000;  ///< [us]
  static constexpr double kSegment = 1.0;   ///< [m] of way
  static constexpr double kSlowest = 0.1;   ///< [m/s] slower says little about the ground

  /// `arm` [m] from the body origin to the front end.
  explicit FeltShock(double arm) : arm_(arm) {}

  /// Takes a measurement; returns a segment when it has just ended. Older ones than the last are
  /// ignored.
  std::optional<FeltSegment> take(const BodyMotion& motion);
  /// Begins anew: what comes next has nothing to do with what was.
  void restart();
  /// Mean square of the INS noise, as acceleration [m2/s4].
  double noise() const { return noise_; }

 private:
  /// Mean of the measurements of one bin.
  struct Bin {
    int64_t number = -1;
    int count = 0;
    BodyMotion sum;
  };

  std::optional<FeltSegment> close(const BodyMotion& mean);
  std::optional<FeltSegment> addToSegment(const BodyMotion& middle, double speed,
                                          double acceleration, double pitch_rate);

  double arm_;
  double noise_ = 0.0;
  int noise_count_ = 0;  ///< bins that it was estimated from
  Bin bin_;
  std::vector<BodyMotion> last_;  ///< means of the last bins without a gap, at most three
  FeltSegment segment_;
  double way_ = 0.0;  ///< [m] of the segment so far
  int count_ = 0;     ///< bins in it
};

}  // namespace tread::learner
