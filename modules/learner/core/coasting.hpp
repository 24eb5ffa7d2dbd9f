// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"

namespace tread::learner {

/// What a vehicle keeps of a velocity that is not the predicted one: its mass coasts, and where the
/// ground is a little faster it stays so for a while. The next pattern begins with it.
/** With d = (dx, dy) [m/s] the measured velocity over the last 0.2 s less the predicted one, body
 * frame, a pattern that begins next goes at t
 *    s(t) tau d,   s(t) = 1 - exp(-t / 0.5 s)
 * further than predicted. tau [s] is learned from what the ends of patterns were off by after d:
 *    tau = (L tau_0 + sum s d.e) / (L + sum s^2 d.d),   0 <= tau <= 1 s
 * with e the error of the end and tau_0 = 0.2 s. L makes it count for some ten executions; each sum
 * fades by a hundredth from one to the next. */
class Coasting {
 public:
  /// `fastest` [m/s] of the vehicle: the measure of what is much.
  explicit Coasting(double fastest);

  /// d at the end of the first `samples` measured poses, each axis at most half the fastest;
  /// nothing if they are too few. Poses after each period [s], relative to the start.
  std::optional<Eigen::Vector2d> beside(const std::vector<Pose2>& measured,
                                        const std::vector<Pose2>& predicted, size_t samples,
                                        double period) const;
  /// Learns from the error of an end [m], start frame, `seconds` after d.
  void learn(const Eigen::Vector2d& beside, const Eigen::Vector2d& error, double seconds);
  /// Adds the way that d makes to the poses after each period [s].
  void add(const Eigen::Vector2d& beside, double period, std::vector<Pose2>& poses) const;
  double tau() const;

  static constexpr size_t kNumbers = 2;
  std::array<double, kNumbers> memory() const { return {products_, squares_}; }
  /// Finite numbers, the second not negative.
  void restore(const std::array<double, kNumbers>& memory);

 private:
  double fastest_;
  double products_ = 0.0;  ///< [m2/s]
  double squares_ = 0.0;   ///< [m2/s2]
};

}  // namespace tread::learner
