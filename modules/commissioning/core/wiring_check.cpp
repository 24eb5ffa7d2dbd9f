// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/commissioning/core/wiring_check.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/degrees.hpp"
#include "common/words/words.hpp"
#include "modules/commissioning/core/wiring_geometry.hpp"

namespace tread::commissioning {
namespace {

/// Largest deviations that are not yet a fault.
struct Tolerance {
  double turn;       ///< [rad] of the INS
  double elsewhere;  ///< [m] of the INS
  double gauge;      ///< relative error of the configured one
  double weak;       ///< share of the other side
  double askew;      ///< [rad] of a car's wheels straight ahead
};
constexpr Tolerance kMinute{0.05, 0.15, 0.2, 0.9, 0.04}, kSeconds{0.2, 0.3, 0.6, 0.7, 0.15};

constexpr size_t kFewRows = 25;
constexpr size_t kParts = 12;              // parts of the drive for the jackknife
constexpr double kStudent = 2.2;           // 95 % quantile for that many parts
constexpr double kStandsStill = 0.05;      // [m/s], [rad/s]: less is no motion at full command
constexpr double kTurnedForSure = 0.5;     // [rad]
constexpr double kMirrorGain = 0.6;        // residual of the mirrored yaw over the configured one's
constexpr double kDeadShare = 0.15;        // relative to the motion of the other side
constexpr double kTurnedBesideDead = 0.8;  // [rad]
constexpr double kSteadyShare = 0.04;      // settling error that a pulse may still have at its end
constexpr double kNoSteering = 0.05;       // [rad] at full command

std::string inMetres(double value) {
  return fixed(value, 2) + " m";
}

std::string inDegrees(double angle) {
  return fixed(toDegrees(angle), 0) + " deg";
}

double motionOf(const WiringFit& fit, int side) {
  return fit.atFull() *
         std::max(fit.response.block<2, 1>(0, side).norm(), 0.3 * std::abs(fit.response(2, side)));
}

/// A quantity with its 95 % interval from the jackknife estimates `parts`.
ConfidenceInterval leavingOneOut(size_t quantity, const Quantities& best,
                                 const std::vector<Quantities>& parts) {
  const auto count = static_cast<double>(parts.size());
  const auto off = [&](const Quantities& part) {
    const double apart = part[quantity] - best[quantity];
    return isAngle(quantity) ? wrapAngle(apart) : apart;
  };
  double mean = 0.0, squares = 0.0;
  for (const Quantities& part : parts) mean += off(part) / count;
  for (const Quantities& part : parts) squares += std::pow(off(part) - mean, 2);
  const double reach = kStudent * std::sqrt(squares * (count - 1.0) / count);
  return {best[quantity], best[quantity] - reach, best[quantity] + reach};
}

/// The mean with its 95 % interval.
ConfidenceInterval meanWithin(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  double mean = 0.0, squares = 0.0;
  for (const double value : values) mean += value / count;
  for (const double value : values) squares += std::pow(value - mean, 2);
  // Student's 95 % quantile, accurate enough from three values on.
  const double student = 2.0 + 7.0 / std::pow(count - 1.0, 1.5);
  const double reach =
      std::hypot(student * std::sqrt(squares / (count - 1.0) / count), kSteadyShare * mean);
  return {mean, mean - reach, mean + reach};
}

class Check {
 public:
  Check(const std::vector<TimedCommand>& commands, const std::vector<TimedPose>& fixes,
        const WiringExpectation& expected)
      : commands_(commands),
        fixes_(fixes),
        car_(expected.wheelbase > 0.0),
        rows_(commands, fixes, car_),
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
    const WiringFit plain = rows_.fit(false, all);
    const WiringFit mirrored = rows_.fit(true, all);
    mirrored_ = mirrored.velocity_rms < kMirrorGain * plain.velocity_rms;
    report_.fit = mirrored_ ? mirrored : plain;
    if (!moves()) return report_;
    best_ = chosen();
    measure();
    describe();
    judge();
    return report_;
  }

 private:
  /// Whether the vehicle moves at all; also finds a dead side.
  bool moves() {
    const double car = report_.fit.atFull() * report_.fit.ahead().norm();
    const double left = car_ ? car : motionOf(report_.fit, 0);
    const double right = car_ ? car : motionOf(report_.fit, 1);
    report_.dead = {left < std::max(kStandsStill, kDeadShare * right),
                    right < std::max(kStandsStill, kDeadShare * left)};
    if (!report_.dead[0] || !report_.dead[1]) return true;
    add(FaultKind::kNoMotion, {}, 0.0);
    return false;
  }

  bool oneIsDead() const { return report_.dead[0] || report_.dead[1]; }

  bool steeringIsDead(const WiringGeometry& geometry) const {
    return car_ &&
           std::abs(geometry.of[kSteeringLeft] - geometry.of[kSteeringRight]) < 2.0 * kNoSteering;
  }

  /// One of two explanations of the same motions: sides or throttle as configured, or the others.
  WiringGeometry geometry(const WiringFit& fit, bool other) const {
    if (car_) return geometryOfCar(fit, other, expected_.wheelbase);
    return oneIsDead() ? geometryOfOne(fit, report_.dead[0] ? 1 : 0) : geometryOf(fit, other);
  }

  WiringGeometry chosen() {
    const WiringGeometry plain = geometry(report_.fit, false), other = geometry(report_.fit, true);
    if (oneIsDead()) return plain;
    if (expected_.seen) {
      const bool right = expected_.seen->side == Side::kRight, ahead = expected_.seen->forward;
      is_other_ = car_ ? !ahead : right;
      const WiringGeometry& found = is_other_ ? other : plain;
      contradicts_ = car_ ? found.reverse_right != right : found.reverse_left == ahead;
      return found;
    }
    const int more = changesOf(plain) - changesOf(other);
    const bool straighter = std::abs(other.of[kYaw]) < std::abs(plain.of[kYaw]);
    is_other_ = more > 0 || (more == 0 && straighter);
    return is_other_ ? other : plain;
  }

  /// Number of parts that deviate from the configuration: of two explanations the one with fewer
  /// holds.
  int changesOf(const WiringGeometry& geometry) const {
    return geometry.swapped + geometry.reverse_left +
           (geometry.reverse_right && !steeringIsDead(geometry)) +
           (std::abs(geometry.of[kYaw]) > std::max(tolerance_.turn, kTurnedForSure));
  }

  void measure() {
    std::vector<Quantities> parts;
    for (size_t part = 0; part < kParts; ++part) {
      const auto use = [&](size_t row) { return row * kParts / rows_.size() != part; };
      parts.push_back(geometry(rows_.refine(report_.fit, mirrored_, use), is_other_).of);
    }
    // Wheel angles are those after a reversed steering is corrected.
    const bool round = car_ && best_.reverse_right;
    ConfidenceInterval* const intervals[kQuantities] = {
        &report_.full_left,
        &report_.full_right,
        &report_.gauge,
        &report_.mounting_yaw,
        &report_.antenna_x,
        &report_.antenna_y,
        &report_.delay,
        &report_.lag,
        &report_.dead_power,
        round ? &report_.steering_right : &report_.steering_left,
        round ? &report_.steering_left : &report_.steering_right,
        &report_.steering_straight,
        &report_.steering_lag};
    for (size_t q = 0; q < kQuantities; ++q) *intervals[q] = leavingOneOut(q, best_.of, parts);
    if (!car_) measureStraight();
  }

  /// Straight driving at full command measures the speeds better.
  void measureStraight() {
    if (oneIsDead() || mirrored_) return;
    const std::vector<StraightSpeed> speeds = straightSpeeds(commands_, fixes_, best_);
    if (speeds.size() < 3) return;
    std::vector<double> left, right;
    for (const StraightSpeed& speed : speeds) {
      left.push_back(speed.left);
      right.push_back(speed.right);
    }
    report_.full_left = meanWithin(left);
    report_.full_right = meanWithin(right);
  }

  void describe() {
    report_.moves[0] = {best_.swapped ? Side::kRight : Side::kLeft, !best_.reverse_left};
    report_.moves[1] = {best_.swapped ? Side::kLeft : Side::kRight, !best_.reverse_right};
  }

  void add(FaultKind kind, std::optional<Side> side, double amount,
           const std::vector<std::string>& values = {}) {
    report_.faults.push_back(wiringFault(kind, side, amount, values));
  }

  void judge() {
    judgeIns();
    if (car_) return judgeCar();
    judgeSides();
    if (oneIsDead()) return;
    judgeStrength();
    judgeGauge();
  }

  void judgeIns() {
    const bool no_turns = steeringIsDead(best_);
    if (mirrored_ || (contradicts_ && !no_turns))
      add(FaultKind::kInsMirrored, {}, 0.0,
          {mirrored_
               ? ": its heading turns opposite to its path; set the sense of its heading at the "
                 "device (clockwise from north)"
               : ", or the observation is wrong: a turn to the left is measured as one to the "
                 "right; check its mounting and axes, and repeat"});
    const ConfidenceInterval& yaw = report_.mounting_yaw;
    // With one dead track the vehicle may turn about another point than the middle of that track.
    const double least = oneIsDead() ? kTurnedBesideDead : tolerance_.turn;
    if (yaw.low > least || yaw.high < -least)
      add(FaultKind::kInsTurned, {}, yaw.value,
          {inDegrees(yaw.value), inDegrees(yaw.low), inDegrees(yaw.high), orElse(yaw.value)});
    const ConfidenceInterval &x = report_.antenna_x, &y = report_.antenna_y;
    const double off = std::hypot(x.value, y.value);
    const bool sure = !x.holds(0.0) || !y.holds(0.0);
    if (!oneIsDead() && !no_turns && off > tolerance_.elsewhere && sure)
      add(FaultKind::kInsElsewhere, {}, off, {inMetres(x.value), inMetres(y.value)});
  }

  /// Another explanation of an INS that is turned by half a turn.
  const char* orElse(double yaw) const {
    if (std::abs(yaw) <= 0.9 * kPi || expected_.seen) return "";
    return car_ ? "; or throttle and steering are both reversed: look in which direction it drives"
                : "; or both motors run backwards and are swapped: look in which direction it "
                  "drives";
  }

  void judgeSides() {
    if (best_.swapped) add(FaultKind::kSwapped, {}, 0.0);
    for (const int i : {0, 1}) {
      const Side configured = i == 0 ? Side::kLeft : Side::kRight;
      const SideMotion& real = report_.moves[static_cast<size_t>(i)];
      const std::string name = nameOf(real.side);
      if (report_.dead[static_cast<size_t>(i)]) {
        add(FaultKind::kDead, real.side, 0.0, {name, nameOf(configured)});
      } else if (!real.forward) {
        add(FaultKind::kReversed, real.side, 0.0, {name + " track runs", "invert_" + name});
      }
    }
  }

  void judgeStrength() {
    const bool left_is_weak = report_.full_left.value < report_.full_right.value;
    const ConfidenceInterval& weak = left_is_weak ? report_.full_left : report_.full_right;
    const ConfidenceInterval& strong = left_is_weak ? report_.full_right : report_.full_left;
    const double share = weak.value / strong.value;
    if (share > tolerance_.weak || weak.high > strong.low) return;
    const Side side = left_is_weak ? Side::kLeft : Side::kRight;
    add(FaultKind::kWeak, side, share,
        {nameOf(side), fixed(100.0 * share, 0), fixed(weak.value, 2), fixed(strong.value, 2)});
  }

  void judgeGauge() {
    const ConfidenceInterval& gauge = report_.gauge;
    if (expected_.gauge <= 0.0 || gauge.holds(expected_.gauge) ||
        std::abs(gauge.value / expected_.gauge - 1.0) < tolerance_.gauge)
      return;
    add(FaultKind::kGauge, {}, gauge.value,
        {inMetres(gauge.value), inMetres(gauge.low), inMetres(gauge.high),
         inMetres(expected_.gauge)});
  }

  void judgeCar() {
    if (best_.reverse_left)
      add(FaultKind::kReversed, {}, 0.0, {"throttle drives", "invert_throttle"});
    if (steeringIsDead(best_)) return add(FaultKind::kSteeringDead, {}, 0.0);
    if (best_.reverse_right)
      add(FaultKind::kSteeringReversed, {}, 0.0,
          {expected_.brief ? ", unless the INS is mirrored: so short a drive does not show which"
                           : ""});
    const ConfidenceInterval& straight = report_.steering_straight;
    if (straight.low > tolerance_.askew || straight.high < -tolerance_.askew)
      add(FaultKind::kSteeringAskew, {}, straight.value, {inDegrees(straight.value)});
  }

  const std::vector<TimedCommand>& commands_;
  const std::vector<TimedPose>& fixes_;
  bool car_;
  WiringRows rows_;
  WiringExpectation expected_;
  Tolerance tolerance_;
  WiringReport report_;
  WiringGeometry best_;
  bool is_other_ = false;  ///< best_ is the other one of two explanations
  bool mirrored_ = false;
  bool contradicts_ = false;  ///< observation and INS disagree
};

}  // namespace

bool WiringReport::has(FaultKind kind, std::optional<Side> side) const {
  return std::any_of(faults.begin(), faults.end(), [&](const WiringFault& fault) {
    return fault.kind == kind && (!side || fault.side == side);
  });
}

double WiringReport::fullSpeed() const {
  return std::min(full_left.value, full_right.value);
}

WiringReport checkWiring(const std::vector<TimedCommand>& commands,
                         const std::vector<TimedPose>& fixes, const WiringExpectation& expected) {
  return Check(commands, fixes, expected).run();
}

}  // namespace tread::commissioning
