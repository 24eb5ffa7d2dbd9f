// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"

namespace tread::learner {

/// Persistence of a velocity that differs from the prediction: the vehicle's mass coasts, and
/// ground that is slightly faster stays so for a while. The next pattern starts with this velocity.
/** With d = (dx, dy) [m/s] the measured minus the predicted velocity over the last 0.2 s, body
 * frame, a pattern that starts next is ahead of its prediction at time t by
 *    s(t) tau d,   s(t) = 1 - exp(-t / 0.5 s)
 * tau [s] is learned from the end errors of patterns that followed d:
 *    tau = (L tau_0 + sum s d.e) / (L + sum s^2 d.d),   0 <= tau <= 1 s
 * with e the error of the end and tau_0 = 0.2 s. L weighs tau_0 like some ten executions; each sum
 * decays by a hundredth per execution. */
class Coasting {
 public:
  /// `fastest` [m/s] of the vehicle: scale of d.
  explicit Coasting(double fastest);

  /// d at the end of the first `samples` measured poses, each axis at most half the fastest;
  /// nullopt if there are too few. Poses after each period [s], relative to the start.
  std::optional<Eigen::Vector2d> beside(const std::vector<Pose2>& measured,
                                        const std::vector<Pose2>& predicted, size_t samples,
                                        double period) const;
  /// Learns from the error of an end [m], start frame, `seconds` after d.
  void learn(const Eigen::Vector2d& beside, const Eigen::Vector2d& error, double seconds);
  /// Adds the displacement caused by d to the poses after each period [s].
  void add(const Eigen::Vector2d& beside, double period, std::vector<Pose2>& poses) const;
  double tau() const;

  static constexpr size_t kNumbers = 2;
  std::array<double, kNumbers> memory() const { return {products_, squares_}; }
  /// Finite numbers; the second must not be negative.
  void restore(const std::array<double, kNumbers>& memory);

 private:
  double fastest_;
  double products_ = 0.0;  ///< [m2/s]
  double squares_ = 0.0;   ///< [m2/s2]
};

}  // namespace tread::learner
