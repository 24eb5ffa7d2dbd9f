// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "common/pattern/command.hpp"

#include "common/pattern/pattern.hpp"
#include "common/vehicle/omni_wheels.hpp"

namespace tread::motor {

/// One INS measurement of planar motion; NaN = not measured.
struct InsMotion {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  int64_t utime = 0;               ///< [us] of the measurement
  double x = kUnknown;             ///< [m] of the body in map
  double y = kUnknown;             ///< [m]
  double yaw = kUnknown;           ///< [rad] + counter-clockwise
  double v_forward = kUnknown;     ///< [m/s] body velocity, the INS's own
  double v_left = kUnknown;        ///< [m/s]
  double yaw_rate = kUnknown;      ///< [rad/s] gyro
  double position_std = kUnknown;  ///< [m] per axis
};

/// Limits of a robot's response to its commands.
/** Shares of slip were chosen on recordings of a 470 kg skid-steer (tests/motor_bridge); delay and
 * acceleration are the robot's own. A robot that slips more or responds later needs wider limits,
 * which make the monitor slower but never disable it. */
struct MotionLimits {
  double gauge = 0.6;       ///< [m] between the middles of the tracks
  double wheelbase = 0.0;   ///< [m] of a car, which is treated as its rear wheels; 0 = tracks
  OmniWheels wheels;        ///< of a holonomic base; otherwise empty
  double full_speed = 1.1;  ///< [m/s] of a track: upper limit for any command
  double speed_per_command = 1.1;  ///< [m/s] of a track or a wheel's rim at command 1
  double dead_band = 0.15;         ///< [1] share of full_speed that may move nothing
  double delay = 0.25;             ///< [s] longest time from a command to its first effect
  double lag = 0.45;               ///< [s] slowest time constant of the tracks
  double acceleration = 2.0;       ///< [m/s2] of a track far from its commanded speed, at least
  double least_travel = 0.4;       ///< [1] of the commanded travel, at least
  double least_turn = 0.2;         ///< [1] of the commanded turn, at least
  double pull = 0.25;  ///< [1] turn caused by uneven ground, as a share of speed / gauge
  /// [s] of the INS's measurement times, also between position and rates
  double time_error = 0.05;

  bool isOmni() const { return !wheels.empty(); }
  /// A command in its unit as track commands: of the left and the right track, or a car's rear
  /// wheels, and at kSideways to the left.
  /** A holonomic base is treated as two tracks, as far apart as its wheels, with the same forward
   * motion and turn; only its command has a sideways part. */
  Command motion(const Command& command) const;
};

/// Index of the sideways part of a motion, after left and right.
inline constexpr size_t kSideways = 2;

/// The speeds of a track [m/s] that are consistent with its commands.
/** It may respond at once, or after the full delay and lag: the band contains both. */
class TrackBand {
 public:
  /// Advances by dt [s] with commands between `least` and `most` [m/s] within the delay.
  void follow(double least, double most, const MotionLimits& limits, double dt);
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  double low_ = 0.0;
  double high_ = 0.0;
};

/// Sums since the first measurement, or over a window: the measured motion, and the motion that the
/// commands explain.
struct MotionSums {
  int64_t utime = 0;                                   ///< [us]
  double forward = 0.0, left = 0.0;                    ///< [m] steps of the pose, body's frame
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [m] in map
  double turned = 0.0;                                 ///< [rad] of the heading
  double travel_min = 0.0, travel_max = 0.0;           ///< [m] explained, slip included
  double turn_min = 0.0, turn_max = 0.0;               ///< [rad]
  Eigen::Array2d low = Eigen::Array2d::Zero();   ///< [m] left, right track, lower bound, no slip
  Eigen::Array2d high = Eigen::Array2d::Zero();  ///< [m] at most
  double travel = 0.0, turn = 0.0;               ///< [m, rad] of ideal tracks without delay
  double side_min = 0.0, side_max = 0.0;         ///< [m] explained to the left, of a holonomic base
  /// [m] mean distance of both tracks, or sideways, lower bound without slip
  double tracks_min = 0.0;
  double reach = 0.0;       ///< [m] of the faster track, at most
  double turn_reach = 0.0;  ///< [rad] at most, without slip
  /// [m] in map, integrated from the INS's velocity
  Eigen::Vector2d ins_way = Eigen::Vector2d::Zero();
  double ins_path = 0.0;                    ///< [m] length of that
  double gyro = 0.0, gyro_path = 0.0;       ///< [rad] integrated from the INS's yaw rate
  double turned_with_gyro = 0.0;            ///< [rad] by the heading, while the rate was measured
  double no_velocity = 0.0, no_rate = 0.0;  ///< [s] for which it was not measured

  double seconds() const { return 1e-6 * static_cast<double>(utime); }
  MotionSums operator-(const MotionSums& start) const;
};

/// Combines commands and measurements in time.
class MotionTrack {
 public:
  explicit MotionTrack(const MotionLimits& limits) : limits_(limits), given_(1) {}

  /// Result of MotionLimits::motion() for the command that acts from now [us] on.
  void command(const Command& motion, int64_t now);
  /// Whether a robot at full speed could have reached this pose since the last one, with `slack`
  /// [m] and `yaw_slack` [rad]; true without a previous pose.
  bool reachable(const InsMotion& ins, double slack, double yaw_slack) const;
  /// Adds a measurement with a pose; false if it is not newer than the last one.
  bool add(const InsMotion& ins);
  /// Forgets the windows; the next measurement starts them again.
  void forget() { history_.clear(); }

  bool empty() const { return history_.size() < 2; }
  /// From the second last measurement to the last.
  MotionSums step() const;
  /// The window of at least this length [s] that ended `ago` [s] before the last measurement;
  /// nullopt while the history is too short.
  std::optional<MotionSums> window(double seconds, double ago = 0.0) const;
  /// From the first measurement whose pose equals the last one bit by bit.
  MotionSums repeats() const;
  /// How long zero had been commanded at the last measurement [s].
  double zeroFor() const;
  /// The slowest speed [m/s] consistent with the commands, of the left (0) or right (1) track, or
  /// of a wheel's rim.
  double least(size_t wheel) const;
  int64_t utime() const { return last_.utime; }
  const MotionLimits& limits() const { return limits_; }

 private:
  struct Given {
    int64_t utime = std::numeric_limits<int64_t>::min() / 2;
    Eigen::Array3d speed = Eigen::Array3d::Zero();  ///< [m/s] left, right, sideways
  };

  void follow(MotionSums& sums, int64_t from, int64_t until);
  void followPiece(MotionSums& sums, int64_t from, int64_t until);
  void measure(MotionSums& sums, const InsMotion& ins, double dt) const;
  double beyondDeadBand(double low, double high) const;

  MotionLimits limits_;
  std::deque<Given> given_;  ///< oldest first; starts with zero
  TrackBand bands_[3];       ///< left, right, sideways
  std::deque<MotionSums> history_;
  std::optional<MotionSums> repeats_;
  InsMotion last_;
};

}  // namespace tread::motor
