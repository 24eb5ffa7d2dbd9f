// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace tread::learner {

/// Motion of the body at one instant, measured by the INS.
struct BodyMotion {
  int64_t utime = 0;                                ///< [us]
  Eigen::Vector2d p_map = Eigen::Vector2d::Zero();  ///< body origin [m]
  double rise = 0.0;   ///< height gained per metre along x_body [1]: sine of the nose-up angle
  double speed = 0.0;  ///< along x_body [m/s]; NaN: derived from the positions
  double climb = 0.0;  ///< vertical velocity of the body origin in map [m/s]; NaN: speed x rise
};

/// Shock of the vehicle on one segment of ground.
struct FeltSegment {
  int64_t utime = 0;                   ///< [us] of its end
  std::vector<Eigen::Vector2d> p_map;  ///< path of the body origin [m], a point per bin
  double speed = 0.0;                  ///< mean magnitude [m/s]
  double shock = 0.0;                  ///< RMS vertical acceleration of the front end [m/s2]
  double peak = 0.0;                   ///< largest magnitude of it [m/s2]
  double pitch_rate = 0.0;             ///< RMS [rad/s]
};

/// Converts INS measurements to shock, by segments of the path.
/** 1. Measurements are averaged in bins of a tenth of a second: this limits the band to about 3 Hz.
 *  2. The front end is `arm` ahead of the body origin; its vertical acceleration is the first
 *     difference of the climb plus the second difference of the rise, over three bins in turn.
 *     Heights are not used, because angles are measured much better.
 *  3. The signal at standstill is the INS's noise; its mean square is subtracted.
 * A gap, or a position or attitude that is not finite, restarts the estimate and drops the current
 * segment. */
class FeltShock {
 public:
  static constexpr int64_t kBin = 100'000;  ///< [us]
  static constexpr double kSegment = 1.0;   ///< [m] of way
  /// [m/s] below this, motion is uninformative about the ground
  static constexpr double kSlowest = 0.1;

  /// `arm` [m] from the body origin to the front end.
  explicit FeltShock(double arm) : arm_(arm) {}

  /// Takes a measurement; returns the segment that it completes, if any. Ignores measurements older
  /// than the last.
  std::optional<FeltSegment> take(const BodyMotion& motion);
  /// Restarts: the next measurement is not connected with the previous ones.
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
  int noise_count_ = 0;  ///< number of bins behind the noise estimate
  Bin bin_;
  std::vector<BodyMotion> last_;  ///< means of the last bins without a gap, at most three
  FeltSegment segment_;
  double way_ = 0.0;  ///< [m] length of the current segment
  int count_ = 0;     ///< bins in it
};

}  // namespace tread::learner
