// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/motion_response.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace tread::motor {
namespace {

// Chosen on every other recorded session (tests/motor_bridge/test_motion_recordings.cpp).
constexpr double kMemory = 15.0;       // [1] remembered windows
constexpr double kLeastReach = 0.15;   // [m] of an informative window
constexpr double kLeastNoise = 0.05;   // [1] standard deviation of a window
constexpr double kPriorNoise = 0.15;   // [1] the same, before any window
constexpr double kPriorWeight = 3.0;   // [1] weight in windows
constexpr double kSigmas = 2.5;        // [1] that are usual
constexpr double kTravelSlack = 0.08;  // [m] beside those
constexpr double kTurnSlack = 0.08;    // [rad]
constexpr double kBandShare = 0.6;     // [1] middle part of the bands: their ends are rare
constexpr double kNearer = 0.4;  // [1] of its distance from the usual motion: close to the fault
constexpr double kHardlyAny = 0.25;  // [1] the same for zero remaining motion: ice leaves a little
constexpr double kDriven = 0.2;      // [m] least distance of a driving track
constexpr double kTurned = 0.1;      // [m] least difference of the tracks' distances in a turn

}  // namespace

void ForgettingRegression::add(const Eigen::Vector2d& x, double y, double error, double weight,
                               double kept) {
  products_ = kept * products_ + weight * x * x.transpose();
  sum_ = kept * sum_ + weight * x * y;
  squares_ = kept * squares_ + weight * error * error;
  weight_ = kept * weight_ + weight;
}

double ForgettingRegression::noise() const {
  const double prior = kPriorWeight * kPriorNoise * kPriorNoise;
  return std::max(kLeastNoise * kLeastNoise, (squares_ + prior) / (weight_ + kPriorWeight));
}

Eigen::Vector2d ForgettingRegression::parameters() const {
  return normal().inverse() * (noise() * information_ * mean_ + sum_);
}

double ForgettingRegression::deviation(const Eigen::Vector2d& x, double scale) const {
  return std::sqrt(noise() * (scale * scale + x.dot(normal().inverse() * x)));
}

/// Ranges of a window's travel and turn [m], and the usual excess over them.
struct MotionResponse::Expected {
  double travel_min = 0.0, travel_max = 0.0, turn_min = 0.0, turn_max = 0.0;
  double travel_margin = 0.0, turn_margin = 0.0;

  double travelBeyond(double travel) const {
    return travel - std::clamp(travel, travel_min, travel_max);
  }
  double turnBeyond(double turn) const { return turn - std::clamp(turn, turn_min, turn_max); }
  /// In margins.
  double distance(double travel, double turn) const {
    return std::hypot(travelBeyond(travel) / travel_margin, turnBeyond(turn) / turn_margin);
  }
  Expected mirrored() const {
    return {travel_min, travel_max, -turn_max, -turn_min, travel_margin, turn_margin};
  }
};

MotionResponse::Expected MotionResponse::expected(const MotionSums& window, double left,
                                                  double right) const {
  const Eigen::Vector2d travel = travel_.parameters(), turn = turn_.parameters();
  const Eigen::Array2d share(left, right);
  const Eigen::Array2d middle = 0.5 * share * (window.low + window.high);
  const Eigen::Array2d half = 0.5 * kBandShare * share * (window.high - window.low);
  const Eigen::Vector2d x(0.5 * middle.sum(), 0.5 * (middle[1] - middle[0]));
  // Each track is anywhere within its band: a linear form is largest at the corners.
  const auto spread = [&half](const Eigen::Vector2d& parameters) {
    return 0.5 * (std::abs(parameters[0] - parameters[1]) * half[0] +
                  std::abs(parameters[0] + parameters[1]) * half[1]);
  };
  const double travels = travel.dot(x), turns = turn.dot(x);
  return {travels - spread(travel),
          travels + spread(travel),
          turns - spread(turn),
          turns + spread(turn),
          kTravelSlack + kSigmas * travel_.deviation(x, window.reach),
          0.5 * limits_.gauge * kTurnSlack + kSigmas * turn_.deviation(x, window.reach)};
}

void MotionResponse::learn(const MotionSums& window, double weight) {
  if (window.reach < kLeastReach) return;
  const Eigen::Array2d middle = 0.5 * (window.low + window.high) / window.reach;
  const Eigen::Vector2d x(0.5 * middle.sum(), 0.5 * (middle[1] - middle[0]));
  const Expected usual = expected(window, 1.0, 1.0);
  const double travel = window.forward, turn = turnWay(window), reach = window.reach;
  const double kept = std::exp(-weight / kMemory);
  travel_.add(x, travel / reach, usual.travelBeyond(travel) / reach, weight, kept);
  turn_.add(x, turn / reach, usual.turnBeyond(turn) / reach, weight, kept);
}

std::optional<TrackFault> MotionResponse::fault(const MotionSums& window) const {
  using Kind = TrackFault::Kind;
  const double travel = window.forward, turn = turnWay(window);
  const Expected usual = expected(window, 1.0, 1.0);
  const double off = usual.distance(travel, turn);
  if (off < 1.0) return std::nullopt;
  double nearest = 1.0;  // in distances from the usual motion
  std::optional<Kind> kind;
  const auto compare = [&](Kind candidate, const Expected& left_over, double limit) {
    const double distance = left_over.distance(travel, turn) / off;
    if (distance >= std::min(limit, nearest)) return;
    nearest = distance;
    kind = candidate;
  };
  // A track that may stand still is uninformative.
  const double way = std::max(kDriven, limits_.dead_band * limits_.full_speed * window.seconds());
  if (window.low.max(-window.high).minCoeff() > way) {
    compare(Kind::kLeftDead, expected(window, 0.0, 1.0), kNearer);
    compare(Kind::kRightDead, expected(window, 1.0, 0.0), kNearer);
    compare(Kind::kBothBlocked, expected(window, 0.0, 0.0), kHardlyAny);
  }
  const double left_turn = 0.5 * (window.low[1] - window.high[0]);
  const double right_turn = 0.5 * (window.low[0] - window.high[1]);
  if ((left_turn > kTurned && turn < 0.0) || (right_turn > kTurned && turn > 0.0))
    compare(Kind::kMirrored, usual.mirrored(), kNearer);
  if (!kind) return std::nullopt;
  return TrackFault{*kind, 0.5 * (usual.travel_min + usual.travel_max),
                    (usual.turn_min + usual.turn_max) / limits_.gauge};
}

}  // namespace tread::motor
