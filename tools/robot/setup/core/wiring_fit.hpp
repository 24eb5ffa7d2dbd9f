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
  struct Row {
    double from = 0.0, to = 0.0;  ///< [s] since the first command
    Eigen::Vector2d moved_map;    ///< [m/s]
    double yaw = 0.0;             ///< [rad] in the middle
    double turned = 0.0;          ///< [rad/s]
  };
  using Use = std::function<bool(size_t row)>;

  WiringFit solve(const Eigen::Vector3d& shape, bool mirrored, const Use& use) const;
  WiringFit search(WiringFit best, double step, bool mirrored, const Use& use) const;
  double costOf(const WiringFit& fit) const;
  std::vector<Eigen::Vector2d> integralOf(const Eigen::Vector3d& shape) const;

  std::vector<TrackCommand> held_;  ///< command in each hundredth of a second
  std::vector<Row> rows_;
};

}  // namespace tread::setup
