// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::commissioning {

/// Extent of the wiring drive.
struct WiringDriveConfig {
  double room = 5.0;         ///< [m] radius of the free circle around the start
  double seconds = 60.0;     ///< of driving
  double travel = 1.8;       ///< [m] approximate travel in one direction
  double shortest = 0.9;     ///< [s] of a pulse
  double pause = 0.6;        ///< [s] between two
  double first_level = 0.2;  ///< [1] initial command; it rises until the vehicle moves
  bool car = false;          ///< commands are throttle and steering
  double level_step = 0.15;  ///< [1] step of the rise
  double most_path = 1e3;    ///< [m] longest path
};

/// The 10 s test before a drive: less than a metre of path. A car begins more gently, as it needs a
/// path to turn.
WiringDriveConfig preDrive(bool car);

/// Chooses commands that reveal the wiring: pulses back and forth, straight, turning, each side
/// alone, slow and full; shorter if the vehicle is fast or far from the middle.
/** It needs no knowledge of the wiring and stays in the circle. Commands are shares of the full
 * one. */
class WiringDrive {
 public:
  /// Shares of the level for both sides, or for throttle and steering; slow or full; share of the
  /// travel.
  struct Pulse {
    double left, right;
    bool full;
    double share;
  };

  explicit WiringDrive(const WiringDriveConfig& config);

  /// The command from now on [us]; `T_map_body` if the INS has a fresh pose.
  TrackCommand step(int64_t utime, const std::optional<Pose2>& T_map_body);

  bool done() const { return done_; }
  /// Why it ended early, one line; empty if it did not.
  const std::string& problem() const { return problem_; }
  /// [m] driven so far according to the INS.
  double path() const { return path_; }

 private:
  void follow(const Pose2& pose);
  void begin(int64_t utime);
  void feel();
  void judge();
  Pulse nextPulse();
  double levelOf(const Pulse& pulse) const;
  void end(const std::string& problem);

  WiringDriveConfig config_;
  std::optional<int64_t> start_;
  std::optional<Pose2> home_, last_;
  std::optional<int64_t> last_seen_;
  std::deque<std::pair<int64_t, Pose2>> recent_;  ///< of the last 0.3 s
  double path_ = 0.0;
  double fastest_ = 0.0;  ///< [m/s] per share of a full command
  bool tried_ = false;    ///< at least one pulse has ended
  bool felt_ = false;     ///< it moves at level_
  double level_ = 0.0;
  Pose2 pulse_start_;
  size_t pulse_ = 0;  ///< of the round
  TrackCommand command_;
  /// [m] displacement of a car's last pulse, as for a positive throttle
  std::optional<Eigen::Vector2d> way_;
  double throttle_ = 0.0;  ///< of a car, applied once its wheels have turned
  int64_t pulse_begin_ = 0;
  int64_t pulse_end_ = 0;
  int64_t pause_end_ = 0;
  bool done_ = false;
  std::string problem_;
};

}  // namespace tread::commissioning
