// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/core/car_check.hpp"

#include <cmath>

#include "tools/robot/setup/core/car_fit.hpp"
#include "tools/robot/setup/core/ins_faults.hpp"

namespace tread::setup {
namespace {

constexpr double kNoSteering = 0.05;      // [rad] at full command
constexpr double kAskewSteering = 0.04;   // [rad] straight ahead
constexpr double kAskewInSeconds = 0.15;  // [rad] the same, after a few seconds of driving

/// Interpretation of a fit, if the throttle drives forwards or backwards.
struct CarReading {
  bool forward = true;
  double yaw = 0.0;       ///< [rad] of the INS
  Eigen::Vector2d place;  ///< [m] of the INS, in body axes
  double left = 0.0;      ///< [rad] wheel angle at full command to the left
  double right = 0.0;     ///< [rad] at full command to the right
  double straight = 0.0;  ///< [rad] at zero command

  bool steersLeft() const { return left > right; }
};

CarReading readingOf(const CarFit& fit, bool forward, double wheelbase) {
  CarReading reading;
  reading.forward = forward;
  const double sign = forward ? 1.0 : -1.0;
  const Eigen::Vector2d ahead = sign * fit.ahead;
  reading.yaw = wrapAngle(-std::atan2(ahead.y(), ahead.x()));
  const Pose2 to_body{0.0, 0.0, reading.yaw};
  reading.place = to_body * fit.place;
  const auto angle = [&](double u) { return std::atan(wheelbase * sign * fit.curvature(u)); };
  reading.left = angle(1.0);
  reading.right = angle(-1.0);
  reading.straight = angle(0.0);
  return reading;
}

class CarCheck {
 public:
  CarCheck(const std::vector<TimedCommand>& commands, const std::vector<TimedPose>& fixes,
           const WiringExpectation& expected)
      : rows_(commands, fixes),
        expected_(expected),
        tolerance_(expected.brief ? kSeconds : kMinute) {}

  WiringReport run() {
    if (rows_.size() < kFewRows) {
      report_.unsure =
          "the INS gave too few positions with a heading during the drive; look at its fix and its "
          "line";
      return report_;
    }
    const auto all = [](size_t) { return true; };
    const CarFit plain = rows_.fit(false, all);
    const CarFit mirrored = rows_.fit(true, all);
    mirrored_ = mirrored.velocity_rms < kMirrorGain * plain.velocity_rms;
    fit_ = mirrored_ ? mirrored : plain;
    if (fit_.fullSpeed() < kStandsStill) {
      report_.dead = {true, true};
      report_.faults.push_back(nothingMoves());
      return report_;
    }
    reading_ = chosen();
    measure();
    report_.moves[0].forward = reading_.forward;
    report_.moves[1] = {Side::kRight, reading_.steersLeft()};
    judge();
    return report_;
  }

 private:
  CarReading read(bool forward) const { return readingOf(fit_, forward, expected_.wheelbase); }

  CarReading chosen() {
    const CarReading forward = read(true), backward = read(false);
    if (expected_.seen) {
      const CarReading seen = expected_.seen->forward ? forward : backward;
      contradicts_ = seen.steersLeft() != (expected_.seen->side == Side::kLeft);
      return seen;
    }
    const int more = changesOf(forward) - changesOf(backward);
    const bool straighter = std::abs(backward.yaw) < std::abs(forward.yaw);
    return more > 0 || (more == 0 && straighter) ? backward : forward;
  }

  /// Number of parts that deviate from the configuration.
  int changesOf(const CarReading& reading) const {
    const bool turned = std::abs(reading.yaw) > std::max(tolerance_.turn, kTurnedForSure);
    return !reading.forward + (!reading.steersLeft() && !steeringIsDead(reading)) + turned;
  }

  static bool steeringIsDead(const CarReading& reading) {
    return std::abs(reading.left - reading.right) < 2.0 * kNoSteering;
  }

  void measure() {
    std::vector<CarFit> parts;
    for (size_t part = 0; part < kParts; ++part)
      parts.push_back(rows_.refine(
          fit_, mirrored_, [&](size_t row) { return row * kParts / rows_.size() != part; }));
    const auto interval = [&](const auto& of, bool is_angle) {
      std::vector<double> values;
      for (const CarFit& part : parts)
        values.push_back(of(part, readingOf(part, reading_.forward, expected_.wheelbase)));
      return leavingOneOut(of(fit_, reading_), values, is_angle);
    };
    using Fit = const CarFit&;
    using Reading = const CarReading&;
    report_.full_left = report_.full_right =
        interval([](Fit fit, Reading) { return fit.fullSpeed(); }, false);
    report_.mounting_yaw = interval([](Fit, Reading reading) { return reading.yaw; }, true);
    report_.antenna_x = interval([](Fit, Reading reading) { return reading.place.x(); }, false);
    report_.antenna_y = interval([](Fit, Reading reading) { return reading.place.y(); }, false);
    report_.delay = interval([](Fit fit, Reading) { return fit.shape[0]; }, false);
    report_.lag = interval([](Fit fit, Reading) { return fit.shape[1]; }, false);
    report_.dead_power = interval([](Fit fit, Reading) { return fit.shape[2]; }, false);
    report_.steering_lag = interval([](Fit fit, Reading) { return fit.steering_lag; }, false);
    // Angles after a reversed steering is corrected.
    const bool round = !reading_.steersLeft();
    report_.steering_left = interval(
        [round](Fit, Reading reading) { return round ? reading.right : reading.left; }, true);
    report_.steering_right = interval(
        [round](Fit, Reading reading) { return round ? reading.left : reading.right; }, true);
    report_.steering_straight =
        interval([](Fit, Reading reading) { return reading.straight; }, true);
    report_.fit.delay = fit_.shape[0];
    report_.fit.lag = fit_.shape[1];
    report_.fit.dead = fit_.shape[2];
    report_.fit.velocity_rms = fit_.velocity_rms;
    report_.fit.turn_rms = fit_.turn_rms;
  }

  void add(FaultKind kind, double amount, const std::string& words) {
    report_.faults.push_back({kind, {}, amount, words});
  }

  void judge() {
    const bool dead = steeringIsDead(reading_);
    if (mirrored_ || (contradicts_ && !dead)) report_.faults.push_back(insMirrored(mirrored_));
    const ConfidenceInterval& yaw = report_.mounting_yaw;
    if (yaw.low > tolerance_.turn || yaw.high < -tolerance_.turn)
      report_.faults.push_back(insTurned(
          yaw,
          std::abs(yaw.value) > 0.9 * kPi && !expected_.seen
              ? "; or throttle and steering are both reversed: look in which direction it drives"
              : ""));
    const ConfidenceInterval &x = report_.antenna_x, &y = report_.antenna_y;
    if (!dead && std::hypot(x.value, y.value) > tolerance_.elsewhere &&
        (!x.holds(0.0) || !y.holds(0.0)))
      report_.faults.push_back(insElsewhere(x, y));
    if (!reading_.forward)
      add(FaultKind::kReversed, 0.0,
          "the throttle drives backwards; change invert_throttle of robot.yaml, or the motor's "
          "wires");
    if (dead)
      add(FaultKind::kSteeringDead, 0.0,
          "the steering does nothing: look at the servo, its supply and its output of the "
          "controller");
    else if (!reading_.steersLeft())
      add(FaultKind::kSteeringReversed, 0.0,
          std::string("the steering is reversed: left is right; change invert_steering of "
                      "robot.yaml") +
              (expected_.brief
                   ? ", unless the INS is mirrored: so short a drive does not show which"
                   : ""));
    const double askew = expected_.brief ? kAskewInSeconds : kAskewSteering;
    const ConfidenceInterval& straight = report_.steering_straight;
    if (!dead && (straight.low > askew || straight.high < -askew))
      add(FaultKind::kSteeringAskew, straight.value,
          "with no steering its wheels stand " + inDegrees(straight.value) +
              " to the left; move the servo's middle (servo_left, servo_right), or its lever");
  }

  CarRows rows_;
  WiringExpectation expected_;
  Tolerance tolerance_;
  WiringReport report_;
  CarFit fit_;
  CarReading reading_;
  bool mirrored_ = false;
  bool contradicts_ = false;  ///< observation and INS disagree
};

}  // namespace

WiringReport checkCar(const std::vector<TimedCommand>& commands,
                      const std::vector<TimedPose>& fixes, const WiringExpectation& expected) {
  return CarCheck(commands, fixes, expected).run();
}

}  // namespace tread::setup
