// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>

#include <Eigen/Core>

#include "modules/motor_bridge/core/motion_track.hpp"

namespace tread::motor {

/// y = parameters . x, with a prior; old samples are forgotten. All quantities are dimensionless.
class ForgettingRegression {
 public:
  ForgettingRegression(const Eigen::Vector2d& mean, const Eigen::Vector2d& std)
      : mean_(mean), information_(std.cwiseInverse().cwiseAbs2().asDiagonal()) {}

  /// Adds a sample of `weight` that was predicted with `error`; the previous sums are multiplied by
  /// `kept`.
  void add(const Eigen::Vector2d& x, double y, double error, double weight, double kept);
  Eigen::Vector2d parameters() const;
  /// Standard deviation of a single sample about parameters . x, including the parameters' own;
  /// both are scaled: x = scale * (x of a sample).
  double deviation(const Eigen::Vector2d& x, double scale) const;

 private:
  double noise() const;  ///< variance of a sample
  Eigen::Matrix2d normal() const { return noise() * information_ + products_; }

  Eigen::Vector2d mean_;
  Eigen::Matrix2d information_;                         ///< (2x2) of the prior
  Eigen::Matrix2d products_ = Eigen::Matrix2d::Zero();  ///< (2x2) sum of x x'
  Eigen::Vector2d sum_ = Eigen::Vector2d::Zero();       ///< sum of x y
  double weight_ = 0.0;
  double squares_ = 0.0;  ///< sum of squared errors
};

/// A fault of the tracks that explains a window.
struct TrackFault {
  enum class Kind { kLeftDead, kRightDead, kBothBlocked, kMirrored };
  Kind kind = Kind::kBothBlocked;
  double travel = 0.0, turn = 0.0;  ///< [m, rad] usual for these commands
};

/// Learns the robot's response to its commands on the present ground, and detects dead tracks by
/// it.
/** MotionTrack's bands hold on all grounds, so they are wide. This class learns, over 15 s of
 * motion, which share of the commanded travel and turn arrives, how far the robot pulls to one
 * side, and how much these vary; before that it knows no more than the bands. A fault is reported
 * if the motion is far from the usual one and close to that of one dead track, two blocked ones or
 * mirrored turns. So a change of ground alone is no fault: it reduces both tracks. */
class MotionResponse {
 public:
  explicit MotionResponse(const MotionLimits& limits) : limits_(limits) {}

  /// Learns from a window of faultless driving with a weight of `weight` [1] windows.
  void learn(const MotionSums& window, double weight);
  /// The fault that explains the window; nullopt if it is usual, or unlike all faults.
  std::optional<TrackFault> fault(const MotionSums& window) const;

 private:
  struct Expected;
  /// Expectation if the tracks move these shares of their commanded distances.
  Expected expected(const MotionSums& window, double left, double right) const;
  double turnWay(const MotionSums& window) const { return 0.5 * limits_.gauge * window.turned; }

  MotionLimits limits_;
  // For x = (mean, half the difference) of the tracks' distances, divided by that of the faster
  // track.
  ForgettingRegression travel_{{0.85, 0.0}, {0.2, 0.1}};
  ForgettingRegression turn_{{0.0, 0.55},
                             {0.1, 0.2}};  ///< as distance of a track, 0.5 gauge from the centre
};

}  // namespace tread::motor
