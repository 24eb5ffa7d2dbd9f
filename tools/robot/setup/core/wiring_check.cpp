// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/core/wiring_check.hpp"

#include <algorithm>
#include <cmath>

#include "tools/robot/setup/core/car_check.hpp"
#include "tools/robot/setup/core/ins_faults.hpp"
#include "tools/robot/setup/core/wiring_geometry.hpp"

namespace tread::setup {
namespace {

constexpr double kDeadShare = 0.15;        // relative to the motion of the other side
constexpr double kTurnedBesideDead = 0.8;  // [rad]
constexpr double kSteadyShare = 0.04;      // settling error that a pulse may still have at its end

double motionOf(const WiringFit& fit, int side) {
  return fit.atFull() *
         std::max(fit.response.block<2, 1>(0, side).norm(), 0.3 * std::abs(fit.response(2, side)));
}

class Check {
 public:
  Check(const std::vector<TimedCommand>& commands, const std::vector<TimedPose>& fixes,
        const WiringExpectation& expected)
      : commands_(commands),
        fixes_(fixes),
        rows_(commands, fixes),
        expected_(expected),
        tolerance_(expected.brief ? kSeconds : kMinute) {}

  WiringReport run() {
    if (rows_.size() < kFewRows) {
      report_.unsure = "the INS gave too few positions with a heading during the drive; look at " +
                       std::string("its fix and its line");
      return report_;
    }
    const auto all = [](size_t) { return true; };
    const WiringFit plain = rows_.fit(false, all);
    const WiringFit mirrored = rows_.fit(true, all);
    mirrored_ = mirrored.velocity_rms < kMirrorGain * plain.velocity_rms;
    report_.fit = mirrored_ ? mirrored : plain;
    if (!moves()) return report_;
    const WiringGeometry best = chosen(report_.fit);
    measure(best);
    describe(best);
    judge();
    return report_;
  }

 private:
  /// Whether the vehicle moves at all; also finds a dead side.
  bool moves() {
    const double left = motionOf(report_.fit, 0), right = motionOf(report_.fit, 1);
    report_.dead = {left < std::max(kStandsStill, kDeadShare * right),
                    right < std::max(kStandsStill, kDeadShare * left)};
    if (!report_.dead[0] || !report_.dead[1]) return true;
    report_.faults.push_back(nothingMoves());
    return false;
  }

  bool oneIsDead() const { return report_.dead[0] || report_.dead[1]; }

  WiringGeometry chosen(const WiringFit& fit) {
    if (oneIsDead()) return geometryOfOne(fit, report_.dead[0] ? 1 : 0);
    WiringGeometry plain = geometryOf(fit, false), swapped = geometryOf(fit, true);
    if (!expected_.seen) {
      const int more = changesOf(plain) - changesOf(swapped);
      const bool straighter = std::abs(swapped.of[kYaw]) < std::abs(plain.of[kYaw]);
      return more > 0 || (more == 0 && straighter) ? swapped : plain;
    }
    const bool is_swapped = expected_.seen->side == Side::kRight;
    const WiringGeometry& found = is_swapped ? swapped : plain;
    contradicts_ = found.reverse_left == expected_.seen->forward;
    return found;
  }

  /// Number of parts that deviate from the configuration: of two explanations the one with fewer
  /// holds.
  int changesOf(const WiringGeometry& geometry) const {
    return geometry.swapped + geometry.reverse_left + geometry.reverse_right +
           (std::abs(geometry.of[kYaw]) > std::max(tolerance_.turn, kTurnedForSure));
  }

  void measure(const WiringGeometry& best) {
    std::vector<Quantities> parts;
    for (size_t part = 0; part < kParts; ++part) {
      const auto use = [&](size_t row) { return row * kParts / rows_.size() != part; };
      const WiringFit fit = rows_.refine(report_.fit, mirrored_, use);
      parts.push_back(oneIsDead() ? geometryOfOne(fit, report_.dead[0] ? 1 : 0).of
                                  : geometryOf(fit, best.swapped).of);
    }
    ConfidenceInterval* const intervals[kQuantities] = {
        &report_.full_left,    &report_.full_right, &report_.gauge,
        &report_.mounting_yaw, &report_.antenna_x,  &report_.antenna_y,
        &report_.delay,        &report_.lag,        &report_.dead_power};
    for (size_t q = 0; q < kQuantities; ++q) *intervals[q] = intervalOf(q, best.of, parts);
    measureStraight(best);
  }

  /// Straight driving at full command measures the speeds better.
  void measureStraight(const WiringGeometry& best) {
    if (oneIsDead() || mirrored_) return;
    const std::vector<StraightSpeed> speeds = straightSpeeds(commands_, fixes_, best);
    if (speeds.size() < 3) return;
    std::vector<double> left, right;
    for (const StraightSpeed& speed : speeds) {
      left.push_back(speed.left);
      right.push_back(speed.right);
    }
    report_.full_left = meanOf(left);
    report_.full_right = meanOf(right);
  }

  static ConfidenceInterval meanOf(const std::vector<double>& values) {
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

  static ConfidenceInterval intervalOf(size_t q, const Quantities& best,
                                       const std::vector<Quantities>& parts) {
    std::vector<double> values;
    for (const Quantities& part : parts) values.push_back(part[q]);
    return leavingOneOut(best[q], values, q == kYaw);
  }

  void describe(const WiringGeometry& best) {
    report_.moves[0] = {best.swapped ? Side::kRight : Side::kLeft, !best.reverse_left};
    report_.moves[1] = {best.swapped ? Side::kLeft : Side::kRight, !best.reverse_right};
  }

  void add(FaultKind kind, std::optional<Side> side, double amount, const std::string& words) {
    report_.faults.push_back({kind, side, amount, words});
  }

  void judge() {
    judgeIns();
    judgeSides();
    if (oneIsDead()) return;
    judgeStrength();
    judgeGauge();
  }

  void judgeIns() {
    if (mirrored_ || contradicts_) report_.faults.push_back(insMirrored(mirrored_));
    const ConfidenceInterval& yaw = report_.mounting_yaw;
    // With one dead track the vehicle may turn about another point than the middle of that track.
    const double least = oneIsDead() ? kTurnedBesideDead : tolerance_.turn;
    if (yaw.low > least || yaw.high < -least)
      report_.faults.push_back(insTurned(
          yaw,
          std::abs(yaw.value) > 0.9 * kPi && !expected_.seen
              ? "; or both motors run backwards and are swapped: look in which direction it drives"
              : ""));
    const double off = std::hypot(report_.antenna_x.value, report_.antenna_y.value);
    const bool sure = !report_.antenna_x.holds(0.0) || !report_.antenna_y.holds(0.0);
    if (!oneIsDead() && off > tolerance_.elsewhere && sure)
      report_.faults.push_back(insElsewhere(report_.antenna_x, report_.antenna_y));
  }

  void judgeSides() {
    if (report_.moves[0].side != Side::kLeft)
      add(FaultKind::kSwapped, {}, 0.0,
          "the sides are swapped: the configured left channel drives the right track; change "
          "left_channel of robot.yaml, or the wires");
    for (const int i : {0, 1}) {
      const Side configured = i == 0 ? Side::kLeft : Side::kRight;
      const Side real = report_.moves[static_cast<size_t>(i)].side;
      if (report_.dead[static_cast<size_t>(i)]) {
        add(FaultKind::kDead, real, 0.0,
            std::string("the ") + nameOf(real) + " track does not move when it is commanded (" +
                nameOf(configured) +
                " in the configuration): look at its motor, its fuse and its "
                "channel of the controller");
      } else if (!report_.moves[static_cast<size_t>(i)].forward) {
        add(FaultKind::kReversed, real, 0.0,
            std::string("the ") + nameOf(real) + " track runs backwards; change invert_" +
                nameOf(real) + " of robot.yaml, or the motor's wires");
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
        std::string("the ") + nameOf(side) + " track gives " + fixedText(100.0 * share, 0) +
            " % of the other one's speed (" + fixedText(weak.value, 2) + " against " +
            fixedText(strong.value, 2) +
            " m/s): look for a dragging brake, a slack chain or a limit of the controller");
  }

  void judgeGauge() {
    const ConfidenceInterval& gauge = report_.gauge;
    if (expected_.gauge <= 0.0 || gauge.holds(expected_.gauge) ||
        std::abs(gauge.value / expected_.gauge - 1.0) < tolerance_.gauge)
      return;
    add(FaultKind::kGauge, {}, gauge.value,
        "it turns as if it were " + inMetres(gauge.value) + " wide (" + inMetres(gauge.low) +
            " to " + inMetres(gauge.high) + "), and " + inMetres(expected_.gauge) +
            " is configured; set gauge of robot.yaml");
  }

  const std::vector<TimedCommand>& commands_;
  const std::vector<TimedPose>& fixes_;
  WiringRows rows_;
  WiringExpectation expected_;
  Tolerance tolerance_;
  WiringReport report_;
  bool mirrored_ = false;
  bool contradicts_ = false;  // observation and INS disagree
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
  if (expected.wheelbase > 0.0) return checkCar(commands, fixes, expected);
  return Check(commands, fixes, expected).run();
}

}  // namespace tread::setup
