// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/motion_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "common/geometry/degrees.hpp"

namespace tread::motor {
namespace {

constexpr double kWindows[] = {1.0, 3.0};  // [s]: the long one for slow deviations
constexpr int64_t kSuspicion = 100'000;    // [us] for which a window must stay suspicious
constexpr int64_t kStands = 1'300'000;     // [us] for which a fault stays
constexpr double kRepeats = 0.4;           // [s] of the same pose, bit for bit
constexpr double kRepeatedMotion = 0.05;   // [m], [rad] that should have changed it
constexpr double kPositionSlack = 0.15;    // [m] of a window
constexpr double kYawSlack = 0.12;         // [rad] of a window
constexpr double kCreep = 0.25;            // [rad] by which it turns back after zero is commanded
constexpr double kWander = 0.2;            // [1] of the INS's standard deviation in a window
constexpr double kFade = 0.99;             // [1] of the last standard deviation, per measurement
constexpr double kStill = 0.04;            // [m], [rad] limit of a standstill
constexpr double kStillTracks = 0.12;      // [m] of the tracks that should have moved it
constexpr double kPositionJump = 0.3;      // [m] of a step
constexpr double kYawJump = 0.25;          // [rad] of a step
constexpr double kDoubts = 1.5;            // [1] limit of unreachable poses
constexpr double kForgiven = 0.05;         // [1] reduction of that count per good one
constexpr double kVelocityError = 0.12;    // [1] of the INS's velocity, latency included
constexpr double kRateError = 0.12;        // [1] of its rate
constexpr double kSideways = 0.25;         // [1] of the travel: sideslip
constexpr double kSwing = 0.5;             // [m/rad] sideways by turning about another point
constexpr int64_t kTrackStands = 700'000;  // [us] against its command
constexpr double kStandingTrack = 0.1;     // [1] of the commanded speed: blocked
constexpr double kDepartureWindow = 0.7;   // [s] compared with the usual motion
constexpr double kLearnedWindow = 1.0;     // [s]
constexpr double kLearnedAfter = 1.5;      // [s] by which a fault in it would have been detected

const std::string kTracks = "tracks";
const std::string kWheels = "wheels";

const std::string& drivenBy(const MotionLimits& limits) {
  return limits.isOmni() ? kWheels : kTracks;
}

/// The pattern with %0, %1, %2 replaced by the values, rounded to that many decimals.
std::string words(std::string_view pattern, std::initializer_list<double> values) {
  std::string text;
  auto value = values.begin();
  for (size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '%') {
      text += pattern[i];
      continue;
    }
    const int decimals = pattern[++i] - '0';
    const double scale = std::pow(10.0, decimals);
    const std::string number = std::to_string(std::round(*value * scale) / scale + 0.0);
    const size_t length = number.find('.') + static_cast<size_t>(decimals + (decimals > 0));
    text += std::isfinite(*value++) ? number.substr(0, length) : "?";
  }
  return text;
}

/// Excess over [min, max], with its sign; 0 inside.
double beyond(double value, double min, double max) {
  return value < min ? value - min : std::max(0.0, value - max);
}

/// The value in [min, max] closest to zero.
double leastOf(double min, double max) {
  return min > 0.0 ? min : std::min(0.0, max);
}

/// Commanded but not executed: the motors' data name the fault. `least` [m] of the tracks'
/// distance.
Reason tooLittle(const MotionSums& sums, const MotorTelemetry& motors, double least,
                 const std::string& what) {
  const double left = std::abs(motors.measured[0]), right = std::abs(motors.measured[1]);
  const double asked = least / sums.seconds();
  const std::string told =
      words("%2 m, %0 deg in %1 s where " + what + " make %2 m at least",
            {sums.position.norm(), toDegrees(sums.turned), sums.seconds(), least});
  // For a wheel with rollers these two alone determine no share of the motion.
  if (what == kTracks && std::min(left, right) > 0.5 * asked)
    return {StopReason::kStuck, "tracks spin or pose frozen: " + told + "; look, then ARM"};
  if (std::isfinite(motors.current[0]) && std::isfinite(motors.current[1]))
    return {StopReason::kStuck,
            "stuck or pose frozen: " + told +
                words(" (%0, %0 A); look, then ARM", {motors.current[0], motors.current[1]})};
  return {StopReason::kStuck, "stuck or pose frozen: " + told + "; look, then ARM"};
}

/// One window and the data for evaluating it.
struct Judge {
  const MotionSums& sums;
  const MotionSums& half;  ///< its newer half: the present direction of motion
  const MotorTelemetry& motors;
  const MotionLimits& limits;
  double wander;     ///< [m] of a position at rest
  double slack;      ///< [m] of a position's change
  double yaw_slack;  ///< [rad] of a heading's
  bool stands;       ///< commanded to zero throughout

  Reason verdict() const {
    Reason verdict = ownRate();
    if (verdict.empty()) verdict = ownVelocity();
    if (verdict.empty()) verdict = still();
    if (verdict.empty()) verdict = travel();
    if (verdict.empty()) verdict = turn();
    if (verdict.empty()) verdict = sideways();
    return verdict;
  }

 private:
  /// Effect of a time error on an unevenly driven path [rad].
  double lateRate(double path) const { return 2.0 * limits.time_error * path / sums.seconds(); }

  Reason ownRate() const {
    if (sums.no_rate > 0.2 * sums.seconds()) return {};
    if (std::abs(sums.turned_with_gyro - sums.gyro) <=
        kYawSlack + lateRate(sums.gyro_path) + kRateError * sums.gyro_path)
      return {};
    return {StopReason::kInsDisagrees,
            words("heading and gyro differ: %0 and %0 deg in %1 s; check the INS, then ARM",
                  {toDegrees(sums.turned_with_gyro), toDegrees(sums.gyro), sums.seconds()})};
  }
  Reason ownVelocity() const {
    if (sums.no_velocity > 0.2 * sums.seconds()) return {};
    const double off = (sums.position - sums.ins_way).norm();
    if (off <= slack + kVelocityError * sums.ins_path) return {};
    return {StopReason::kInsDisagrees,
            words("position and INS velocity differ by %2 m in %1 s (%2 m driven); check the "
                  "INS, then ARM",
                  {off, sums.seconds(), sums.ins_path})};
  }
  /// Slip reduces a command's motion, but not to zero.
  Reason still() const {
    const bool still = std::max(sums.position.norm(), half.position.norm()) < kStill + wander &&
                       std::max(std::abs(sums.turned), std::abs(half.turned)) < kStill;
    return still && sums.tracks_min > kStillTracks
               ? tooLittle(sums, motors, sums.tracks_min, drivenBy(limits))
               : Reason();
  }
  Reason travel() const {
    const double off = beyond(sums.forward, sums.travel_min - slack, sums.travel_max + slack);
    if (off == 0.0) return {};
    if (stands) return uncommanded();
    const double expected = leastOf(sums.travel_min, sums.travel_max);
    if (off * expected < 0.0)
      return half.forward * expected < 0.0 && std::abs(half.forward) > kPositionSlack
                 ? backwards()
                 : tooLittle(sums, motors, std::abs(expected), drivenBy(limits));
    return {StopReason::kUnexplainedMotion,
            words("travels %2 m in %1 s, commands explain %2 to %2; check INS and tracks, "
                  "then ARM",
                  {sums.forward, sums.seconds(), sums.travel_min, sums.travel_max})};
  }
  Reason uncommanded() const {
    return {StopReason::kUnexplainedMotion,
            words("moves %2 m, %0 deg in %1 s though zero is commanded: slides or rolls, or "
                  "the INS drifts",
                  {sums.position.norm(), toDegrees(sums.turned), sums.seconds()})};
  }
  Reason backwards() const {
    return {StopReason::kUnexplainedMotion,
            words("travels %2 m in %1 s where %2 is the least: check heading and motor "
                  "wiring, then ARM",
                  {half.forward, half.seconds(), leastOf(half.travel_min, half.travel_max)})};
  }
  Reason turn() const {
    const double off = beyond(sums.turned, sums.turn_min - yaw_slack, sums.turn_max + yaw_slack);
    if (off == 0.0) return {};
    if (stands) return uncommanded();
    const std::string told = words("turns %0 deg in %1 s, commands explain %0 to %0",
                                   {toDegrees(sums.turned), sums.seconds(),
                                    toDegrees(sums.turn_min), toDegrees(sums.turn_max)});
    if (sums.turned * sums.turn < 0.0 && std::abs(sums.turned) > 0.3 * std::abs(sums.turn))
      return {StopReason::kTrackDead, told + ": the wrong way; check heading and tracks"};
    if (limits.isOmni()) return {StopReason::kTrackDead, told + ": a wheel dead or blocked?"};
    if (std::abs(sums.turned) < std::abs(sums.turn))
      return {StopReason::kStuck, told + "; is the heading frozen, a track stuck?"};
    const bool left = off * (sums.travel < 0.0 ? -1.0 : 1.0) > 0.0;
    return {StopReason::kTrackDead,
            told + (left ? ": left" : ": right") + " track dead or blocked?"};
  }
  Reason sideways() const {
    const double allowed =
        slack + kSideways * std::abs(sums.forward) +
        kSwing * std::abs(sums.turned) * (1.0 + std::max(std::abs(sums.forward), 0.5 * sums.reach));
    const double off = beyond(sums.left, sums.side_min - allowed, sums.side_max + allowed);
    if (off == 0.0) return {};
    if (stands) return uncommanded();
    if (limits.isOmni()) return besideCommand(off);
    return {StopReason::kUnexplainedMotion,
            words("moves %2 m sideways in %1 s, %2 explained: slides, or the heading is off; "
                  "check, then ARM",
                  {sums.left, sums.seconds(), allowed})};
  }
  /// Including sideways commands.
  Reason besideCommand(double off) const {
    const double expected = leastOf(sums.side_min, sums.side_max);
    if (off * expected < 0.0 && sums.left * expected >= 0.0)
      return tooLittle(sums, motors, std::abs(expected), drivenBy(limits));
    return {
        StopReason::kUnexplainedMotion,
        words(
            "moves %2 m to the left in %1 s, commands explain %2 to %2; check heading and wheels, "
            "then ARM",
            {sums.left, sums.seconds(), sums.side_min, sums.side_max})};
  }
};

}  // namespace

void MotionMonitor::receive(const InsMotion& ins) {
  // A single broken message among good ones does not stop the robot; two do, or one of a few.
  const bool good = track_.reachable(ins, kPositionJump + position_std_, kYawJump);
  doubts_ = good ? std::max(0.0, doubts_ - kForgiven) : doubts_ + 1.0;
  if (!good && doubts_ < kDoubts) return;
  if (!track_.add(ins)) return;
  // An improving fix moves by its earlier error.
  const double position_std = std::isfinite(ins.position_std) ? ins.position_std : 0.0;
  position_std_ = std::max(position_std, kFade * position_std_);
  if (track_.empty()) return;
  watchTracks(ins.utime);
  const Reason sure = surelyWrong();
  if (!sure.empty()) return tell(sure, ins.utime);
  Reason suspected = suspicion();
  if (suspected.empty()) suspected = departure();
  if (suspected.empty()) {
    suspected_since_ = -1;
    learn();
  } else if (suspected_since_ < 0) {
    suspected_since_ = ins.utime;
  } else if (ins.utime - suspected_since_ >= kSuspicion) {
    tell(suspected, ins.utime);
  }
}

void MotionMonitor::tell(const Reason& verdict, int64_t utime) {
  verdict_ = verdict;
  told_ = utime;
  suspected_since_ = -1;
  track_.forget();
}

Reason MotionMonitor::fault(int64_t now) const {
  return now - told_ <= kStands ? verdict_ : Reason();
}

void MotionMonitor::watchTracks(int64_t utime) {
  for (size_t i = 0; i < wheel_stands_since_.size(); ++i) {
    const double least = track_.least(i), speed = motors_.measured[i];
    const double along = least < 0.0 ? -speed : speed;
    const bool stands = std::abs(least) > kStandingTrack * track_.limits().full_speed &&
                        along < kStandingTrack * std::abs(least);
    if (!stands) wheel_stands_since_[i] = utime;
  }
}

Reason MotionMonitor::standingWheel(int64_t utime) const {
  for (size_t i = 0; i < wheel_stands_since_.size(); ++i)
    if (utime - wheel_stands_since_[i] >= kTrackStands)
      return {StopReason::kTrackDead,
              "wheel " + std::to_string(i + 1) +
                  words(" dead or blocked: %2 m/s where %2 is the least; free or mend it, then ARM",
                        {motors_.measured[i], track_.least(i)})};
  return {};
}

Reason MotionMonitor::standingTrack(int64_t utime) const {
  if (track_.limits().isOmni()) return standingWheel(utime);
  const bool left = utime - wheel_stands_since_[0] >= kTrackStands;
  const bool right = utime - wheel_stands_since_[1] >= kTrackStands;
  if (!left && !right) return {};
  return {StopReason::kTrackDead,
          std::string(left && right ? "both tracks blocked"
                      : left        ? "left track dead"
                                    : "right track dead") +
              words(": %2 and %2 m/s where %2 and %2 are the least; free or mend it, then ARM",
                    {motors_.measured[0], motors_.measured[1], track_.least(0), track_.least(1)})};
}

Reason MotionMonitor::surelyWrong() const {
  const MotionSums same = track_.repeats();
  const double travel = leastOf(same.travel_min, same.travel_max);
  const double turn = leastOf(same.turn_min, same.turn_max);
  const double must = std::max({std::abs(travel), std::abs(turn), same.ins_path, same.gyro_path});
  if (same.seconds() >= kRepeats && must > kRepeatedMotion)
    return {StopReason::kInsFrozen,
            words("pose frozen: the same for %1 s, at least %2 m, %2 rad expected; check the "
                  "INS, then ARM",
                  {same.seconds(), travel, turn})};
  const MotionSums step = track_.step();
  const double late = track_.limits().time_error / step.seconds();
  const double far = kPositionJump + position_std_ + (1.3 + late) * step.reach;
  if (step.position.norm() > far)
    return {StopReason::kInsJump,
            words("pose jumps %2 m in %2 s, %2 m explained; check the INS, then ARM",
                  {step.position.norm(), step.seconds(), far})};
  const double much = kYawJump + late * step.turn_reach;
  if (beyond(step.turned, step.turn_min - much, step.turn_max + much) != 0.0)
    return {StopReason::kInsJump, words("heading jumps %0 deg in %2 s; check the INS, then ARM",
                                        {toDegrees(step.turned), step.seconds()})};
  return standingTrack(track_.utime());
}

Reason MotionMonitor::suspicion() const {
  const double wander = kWander * position_std_;
  for (const double seconds : kWindows) {
    const std::optional<MotionSums> window = track_.window(seconds);
    if (!window) return {};
    const double late = track_.limits().time_error / window->seconds();
    const double creep = track_.zeroFor() > 0.5 ? kCreep : 0.0;
    const MotionSums half = *track_.window(0.5 * seconds);
    const Judge judge{*window,
                      half,
                      motors_,
                      track_.limits(),
                      wander,
                      kPositionSlack + wander + late * window->reach,
                      kYawSlack + creep + late * window->turn_reach,
                      track_.zeroFor() >= seconds};
    const Reason verdict = judge.verdict();
    if (!verdict.empty()) return verdict;
  }
  return {};
}

Reason MotionMonitor::departure() const {
  using Kind = TrackFault::Kind;
  if (track_.limits().isOmni()) return {};
  const std::optional<MotionSums> window = track_.window(kDepartureWindow);
  if (!window) return {};
  const std::optional<TrackFault> fault = response_.fault(*window);
  if (!fault) return {};
  // A reversal passes through zero.
  const MotionSums half = *track_.window(0.5 * kDepartureWindow);
  const bool backwards = half.forward * fault->travel < 0.0 && std::abs(half.forward) > kStill;
  const bool mirrored = half.turned * fault->turn < 0.0 && std::abs(half.turned) > kStill;
  const bool blocked = fault->kind == Kind::kBothBlocked;
  if (blocked && !backwards && !mirrored)
    return tooLittle(*window, motors_, window->tracks_min, drivenBy(track_.limits()));
  const std::string name = fault->kind == Kind::kLeftDead    ? "left track dead"
                           : fault->kind == Kind::kRightDead ? "right track dead"
                           : blocked && backwards            ? "travels the wrong way"
                                                             : "turns the wrong way";
  return {StopReason::kTrackDead,
          name + words(": %2 m, %0 deg in %1 s, usual %2 m, %0 deg; check tracks and INS, then ARM",
                       {window->forward, toDegrees(window->turned), window->seconds(),
                        fault->travel, toDegrees(fault->turn)})};
}

void MotionMonitor::learn() {
  const std::optional<MotionSums> window = track_.window(kLearnedWindow, kLearnedAfter);
  if (window) response_.learn(*window, track_.step().seconds() / kLearnedWindow);
}

}  // namespace tread::motor
