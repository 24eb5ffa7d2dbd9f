// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/track.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::setup {

/// Response of a vehicle to its commands, independent of the wiring: the sum of both sides.
/** command -> delay -> dead power -> first-order lag -> s; velocity = response * (s_left, s_right).
 * Axes of the velocity are those of the INS. */
struct WiringFit {
  double delay = 0.0;  ///< [s]
  double lag = 0.0;    ///< [s]
  double dead = 0.0;   ///< [1] commands up to it have no effect
  /// Per unit of s: forward and left [m/s], yaw rate [rad/s].
  Eigen::Matrix<double, 3, 2> response = Eigen::Matrix<double, 3, 2>::Zero();
  double velocity_rms = 0.0;  ///< [m/s] residual
  double turn_rms = 0.0;      ///< [rad/s]

  /// Share of a full command above the dead power.
  double atFull() const { return 1.0 - dead; }
};

inline constexpr double kFitStep = 0.01;  ///< [s] of integration

/// The motion between two fixes .1 s apart.
struct MotionRow {
  double from = 0.0, to = 0.0;  ///< [s] since the first command
  Eigen::Vector2d moved_map;    ///< [m/s]
  double yaw = 0.0;             ///< [rad] at mid-time
  double turned = 0.0;          ///< [rad/s]

  /// Velocity along and across the INS's axes [m/s] and yaw rate [rad/s]; `mirrored`: its yaw has
  /// the wrong sign.
  Eigen::Vector3d seen(bool mirrored) const;
};

/// Both inputs ordered by time. Gaps of the INS are left out.
std::vector<MotionRow> motionRows(const std::vector<TimedCommand>& commands,
                                  const std::vector<TimedPose>& fixes);
/// The command in force at each kFitStep, from the first command to the last fix.
std::vector<TrackCommand> heldCommands(const std::vector<TimedCommand>& commands,
                                       const std::vector<TimedPose>& fixes);
/// A delayed series of commands [s]; a delay between two steps is interpolated.
double delayedAt(const std::vector<double>& held, size_t step, double delay);
/// 0 up to the dead power, above it the excess.
double beyondDead(double command, double dead);

/// Search variables: delay [s], lag [s], dead power [1].
using Shape = Eigen::Vector3d;
/// Local search for the least cost around `near`, with decreasing `step`.
/** Compass search; as delay and lag are correlated, it also moves along both. */
Shape searchShape(Shape near, double step, const std::function<double(const Shape&)>& cost);
/// The same over the whole range of vehicles.
Shape searchShape(const std::function<double(const Shape&)>& cost);

/// Motions between fixes .1 s apart, with the commands before them.
class WiringRows {
 public:
  /// Both inputs ordered by time. Gaps of the INS are left out.
  WiringRows(const std::vector<TimedCommand>& commands, const std::vector<TimedPose>& fixes);

  size_t size() const { return rows_.size(); }
  /// Fits the rows for which `use` is true. `mirrored`: the INS's yaw has the wrong sign.
  WiringFit fit(bool mirrored, const std::function<bool(size_t row)>& use) const;
  /// The same, searched around another fit.
  WiringFit refine(const WiringFit& near, bool mirrored,
                   const std::function<bool(size_t row)>& use) const;

 private:
  using Use = std::function<bool(size_t row)>;

  WiringFit solve(const Eigen::Vector3d& shape, bool mirrored, const Use& use) const;
  double costOf(const WiringFit& fit) const;
  std::vector<Eigen::Vector2d> integralOf(const Eigen::Vector3d& shape) const;

  std::vector<TrackCommand> held_;  ///< command in each 10 ms
  std::vector<MotionRow> rows_;
};

}  // namespace tread::setup
