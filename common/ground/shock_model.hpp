// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace tread {

/// How strongly ground of a given roughness shakes the vehicle at a given speed, as far as known.
/** Shock is the RMS of the vertical acceleration of the vehicle's front end [m/s2]. Its logarithm
 * is a line plus scatter, log shock = w0 + w1 log(roughness / 1 cm) + w2 log(speed / 1 m/s),
 * because shock grows with a power of both. Stavens and Thrun (UAI 2006) learn the same relation
 * from the shock felt where a range finder measured before; here by Bayesian regression with a
 * conjugate prior, so that little data means little certainty. */
struct ShockModel {
  /// Prior: a wave about as long as a small vehicle, 0.9 m, which shakes it most: (2 pi / 0.9 m)^2
  /// x 1 cm = 0.5 m/s2. Twice the height gives twice the shock, twice the speed four times.
  Eigen::Vector3d mean{-0.7, 1.0, 2.0};                                         ///< of w0, w1, w2
  Eigen::Matrix3d covariance = Eigen::Vector3d(0.25, 0.09, 0.25).asDiagonal();  ///< of those
  double variance = 0.25;  ///< of log shock about the line, among segments that look the same

  /// Expected square of the shock [m2/s4] on ground of a roughness [m] at a speed [m/s], both
  /// clamped to the possible range; uncertainty increases it.
  double meanSquare(double roughness, double speed) const;
  /// The same on ground where a shock [m/s2] at 1 m/s is known: only the effect of speed is
  /// uncertain.
  double meanSquareLike(double shock, double speed) const;
  /// Ratio of the shock at a speed to that at 1 m/s on the same ground [1].
  double speedFactor(double speed) const;
};

/// Learns a shock model from pairs of observed roughness and measured shock.
/** Old data fade: after kMemory pairs their weight is a third, so that a new payload is learned. */
class ShockRegression {
 public:
  static constexpr double kMemory = 1000.0;

  /// Adds a pair: shock measured [m/s2] at a speed [m/s] on ground observed to have a roughness
  /// [m]; ignores values that are not finite and positive.
  void learn(double roughness, double speed, double shock);
  /// What is known now.
  ShockModel model() const;
  int pairs() const { return pairs_; }

  /// The learned state as kNumbers numbers, for a store.
  static constexpr size_t kNumbers = 12;
  std::vector<double> state() const;
  /// The regression of a stored state; nullopt if the numbers are invalid.
  static std::optional<ShockRegression> fromState(const std::vector<double>& numbers);

 private:
  // Sums over the pairs: of x x', x y and y^2, with x = (1, log roughness, log speed), y = log
  // shock.
  Eigen::Matrix3d inputs_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d products_ = Eigen::Vector3d::Zero();
  double squares_ = 0.0;
  double weight_ = 0.0;  ///< pairs that still count
  int pairs_ = 0;
};

}  // namespace tread
