// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/track.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::commissioning {

/// Response of a vehicle to its commands, independent of the wiring.
/** Tracks: command -> delay -> dead power -> first-order lag -> s; velocity and yaw rate = response
 * * (s_left, s_right).
 * Cars: throttle -> delay -> dead power -> lag -> s; steering -> delay -> steering lag -> u. The
 * velocity is response * (s, yaw rate): the rear axle moves along one direction, a point elsewhere
 * also moves by turning. The car turns by |ahead| s (curve[0] + curve[1] u + curve[2] u2).
 * Axes of the velocity are those of the INS. */
struct WiringFit {
  double delay = 0.0;  ///< [s]
  double lag = 0.0;    ///< [s]
  double dead = 0.0;   ///< [1] commands up to it have no effect
  /// Per unit of s: forward and left [m/s], yaw rate [rad/s].
  Eigen::Matrix<double, 3, 2> response = Eigen::Matrix<double, 3, 2>::Zero();
  double velocity_rms = 0.0;                        ///< [m/s] residual
  double turn_rms = 0.0;                            ///< [rad/s]
  double steering_lag = 0.0;                        ///< [s] of a car
  Eigen::Vector3d curve = Eigen::Vector3d::Zero();  ///< [1/m] of a car, per unit of u, u2

  /// Share of a full command above the dead power.
  double atFull() const { return 1.0 - dead; }
  /// Velocity per unit of s: [m/s] of a car's rear axle, axes of the INS.
  Eigen::Vector2d ahead() const { return response.block<2, 1>(0, 0); }
  /// [1/m] of a car's path ahead, u from -1 to 1.
  double curvature(double u) const { return curve[0] + u * (curve[1] + u * curve[2]); }
};

/// Motions between fixes .1 s apart, with the commands before them.
class WiringRows {
 public:
  /// Both inputs ordered by time; gaps of the INS are left out. Commands of a car are throttle
  /// (left) and steering (right).
  WiringRows(const std::vector<TimedCommand>& commands, const std::vector<TimedPose>& fixes,
             bool car);

  using Use = std::function<bool(size_t row)>;

  size_t size() const { return rows_.size(); }
  /// Fits the rows for which `use` is true. `mirrored`: the INS's yaw has the wrong sign.
  WiringFit fit(bool mirrored, const Use& use) const;
  /// The same, searched around another fit.
  WiringFit refine(const WiringFit& near, bool mirrored, const Use& use) const;

 private:
  /// The motion between two fixes .1 s apart.
  struct Row {
    double from = 0.0, to = 0.0;  ///< [s] since the first command
    Eigen::Vector2d moved_map;    ///< [m/s]
    double yaw = 0.0;             ///< [rad] at mid-time
    double turned = 0.0;          ///< [rad/s]

    /// Velocity along and across the INS's axes [m/s] and yaw rate [rad/s].
    Eigen::Vector3d seen(bool mirrored) const;
  };
  using Shape = Eigen::Vector3d;  ///< delay [s], lag [s], dead power [1]

  void hold(const std::vector<TimedCommand>& commands, const std::vector<TimedPose>& fixes);
  void addRows(int64_t start, const std::vector<TimedPose>& fixes);
  WiringFit solve(const Shape& shape, bool mirrored, const Use& use) const;
  double costOf(const Shape& shape, bool mirrored, const Use& use) const;
  WiringFit finished(const Shape& shape, bool mirrored, const Use& use) const;
  void steer(bool mirrored, const Use& use, WiringFit& fit) const;

  bool car_;
  std::vector<double> left_, right_;  ///< command in each 10 ms
  std::vector<Row> rows_;
};

}  // namespace tread::commissioning
