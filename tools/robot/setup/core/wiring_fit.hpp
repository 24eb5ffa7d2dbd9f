// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::setup {

/// What was commanded from a time on, until the next one.
struct GivenCommand {
  int64_t utime = 0;     ///< [us]
  TrackCommand command;  ///< as it was given to the configured left and right, full = 1
};

/// Where the INS says that the vehicle was, with the mounting that is configured.
struct InsFix {
  int64_t utime = 0;  ///< [us]
  Pose2 T_map_body;   ///< yaw may be wrapped
};

/// How a vehicle answers commands, whatever hangs on which wire: the sum of what both sides do.
/** command -> delay -> dead power -> first-order lag -> s; velocity = response * (s_left, s_right).
 * Axes of the velocity are those of the INS. */
struct WiringFit {
  double delay = 0.0;  ///< [s]
  double lag = 0.0;    ///< [s]
  double dead = 0.0;   ///< [1] commands up to it give nothing
  /// Per unit of s: along and across [m/s], turning [rad/s].
  Eigen::Matrix<double, 3, 2> response = Eigen::Matrix<double, 3, 2>::Zero();
  double velocity_rms = 0.0;  ///< [m/s] what is left unexplained
  double turn_rms = 0.0;      ///< [rad/s]

  /// Share of a full command that is beyond the dead power.
  double atFull() const { return 1.0 - dead; }
};

inline constexpr double kFitStep = 0.01;  ///< [s] of integration

/// The motion between two fixes a tenth of a second apart.
struct MotionRow {
  double from = 0.0, to = 0.0;  ///< [s] since the first command
  Eigen::Vector2d moved_map;    ///< [m/s]
  double yaw = 0.0;             ///< [rad] in the middle
  double turned = 0.0;          ///< [rad/s]

  /// Along and across the INS's axes [m/s] and turning [rad/s]; `mirrored`: its yaw turns the wrong
  /// way round.
  Eigen::Vector3d seen(bool mirrored) const;
};

/// Both in the order of time. Gaps of the INS are left out.
std::vector<MotionRow> motionRows(const std::vector<GivenCommand>& commands,
                                  const std::vector<InsFix>& fixes);
/// The command that holds at each kFitStep, from the first command to the last fix.
std::vector<TrackCommand> heldCommands(const std::vector<GivenCommand>& commands,
                                       const std::vector<InsFix>& fixes);
/// A series of commands delayed [s]: a delay between two steps takes a share of each.
double delayedAt(const std::vector<double>& held, size_t step, double delay);
/// 0 up to the dead power, the rest beyond it.
double beyondDead(double command, double dead);

/// What a search is over: delay [s], lag [s], dead power [1].
using Shape = Eigen::Vector3d;
/// The shape of the least cost near another one, by steps from `step` down.
/** A compass search: delay and lag stand in for each other, so that it also moves along both. */
Shape searchShape(Shape near, double step, const std::function<double(const Shape&)>& cost);
/// The same over all shapes that a vehicle may have.
Shape searchShape(const std::function<double(const Shape&)>& cost);

/// The motions between fixes a tenth of a second apart, and the commands before them.
class WiringRows {
 public:
  /// Both in the order of time. Gaps of the INS are left out.
  WiringRows(const std::vector<GivenCommand>& commands, const std::vector<InsFix>& fixes);

  size_t size() const { return rows_.size(); }
  /// The best fit over the rows for which `use` is true. `mirrored`: the INS turns its yaw the
  /// wrong way round.
  WiringFit fit(bool mirrored, const std::function<bool(size_t row)>& use) const;
  /// The same, searched near another one.
  WiringFit refine(const WiringFit& near, bool mirrored,
                   const std::function<bool(size_t row)>& use) const;

 private:
  using Use = std::function<bool(size_t row)>;

  WiringFit solve(const Eigen::Vector3d& shape, bool mirrored, const Use& use) const;
  double costOf(const WiringFit& fit) const;
  std::vector<Eigen::Vector2d> integralOf(const Eigen::Vector3d& shape) const;

  std::vector<TrackCommand> held_;  ///< command in each hundredth of a second
  std::vector<MotionRow> rows_;
};

}  // namespace tread::setup
