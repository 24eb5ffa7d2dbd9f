// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "tools/robot/setup/core/wiring_fit.hpp"

namespace tread::setup {

/// Response of a car to throttle and steering.
/** throttle -> delay -> dead power -> lag -> s; steering -> delay -> steering lag -> u. The rear
 * axle moves by `ahead` s; the car turns by |ahead| s (curve[0] + curve[1] u + curve[2] u2). */
struct CarFit {
  Shape shape = Shape::Zero();  ///< delay [s], lag [s], dead power [1] of the throttle
  double steering_lag = 0.0;    ///< [s]
  Eigen::Vector2d ahead = Eigen::Vector2d::Zero();  ///< [m/s] per unit of s, axes of the INS
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< [m] of the INS from the rear axle, its axes
  Eigen::Vector3d curve = Eigen::Vector3d::Zero();  ///< [1/m] per unit of u, u and u squared
  double velocity_rms = 0.0;                        ///< [m/s] residual
  double turn_rms = 0.0;                            ///< [rad/s]

  /// [1/m] of the path ahead, u from -1 to 1.
  double curvature(double u) const { return curve[0] + u * (curve[1] + u * curve[2]); }
  /// [m/s] at full throttle.
  double fullSpeed() const { return (1.0 - shape[2]) * ahead.norm(); }
};

/// Motions between fixes, with the throttle (left of the command) and steering (right) before them.
class CarRows {
 public:
  CarRows(const std::vector<TimedCommand>& commands, const std::vector<TimedPose>& fixes);

  size_t size() const { return rows_.size(); }
  /// Fits the rows for which `use` is true, as WiringRows does.
  CarFit fit(bool mirrored, const std::function<bool(size_t row)>& use) const;
  CarFit refine(const CarFit& near, bool mirrored,
                const std::function<bool(size_t row)>& use) const;

 private:
  using Use = std::function<bool(size_t row)>;

  std::vector<double> throttleOf(const Shape& shape) const;
  std::vector<double> steeringOf(double delay, double lag) const;
  CarFit drive(const Shape& shape, bool mirrored, const Use& use) const;
  void turn(bool mirrored, const Use& use, CarFit& fit) const;
  double costOf(const Shape& shape, bool mirrored, const Use& use) const;
  CarFit finished(const Shape& shape, bool mirrored, const Use& use) const;

  std::vector<double> throttle_, steering_;  ///< held in each 10 ms
  std::vector<MotionRow> rows_;
};

}  // namespace tread::setup
