// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/soundness/core/command_check.hpp"

#include <algorithm>
#include <cmath>

#include "common/soundness/core/heading_fit.hpp"
#include "common/soundness/core/log_validation_motion.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::gap {
namespace {

constexpr double kPlausibleSpeed = 15.0;  // [m/s] of a ground vehicle
constexpr double kPlausibleTurn = 10.0;   // [rad/s]
constexpr double kNearlyAll = 0.98;       // of the measurements: the rest may be jumps
constexpr double kClearer = 0.25;         // required lead over the other sign
constexpr double kWeak = 0.4;

/// The largest value, ignoring a few outliers; 0 for no values.
double nearlyLargest(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(),
                              [](double value) { return !std::isfinite(value); }),
               values.end());
  for (double& value : values) value = std::abs(value);
  return quantileOf(std::move(values), kNearlyAll, 0.0);
}

/// Measured over commanded, and the unit that it suggests.
struct UnitGain {
  double gain;
  const char* words;
};

/// The unit that explains such a gain; nullptr if the gain is possible for a vehicle.
/** Vehicles lose up to a quarter of their speed to slip. */
const char* unitOf(double gain) {
  static constexpr UnitGain kGains[] = {
      {1.0 / 3.6, "are the commands in km/h?"},
      {30.0 / kPi, "are the commands in rad/s, not in revolutions a minute?"},
      {kPi / 30.0, "are the commands in revolutions a minute, not in rad/s?"},
      {100.0, "are the positions in cm?"},
      {1000.0, "are the positions in mm?"},
      {0.01, "are the commands in cm/s or per cent, or the positions not in cm?"},
      {0.001, "are the commands in mm/s, or the positions not in mm?"}};
  if (gain > 0.3 && gain < 3.0) return nullptr;
  for (const UnitGain& unit : kGains)
    if (gain > 0.75 * unit.gain && gain < 1.12 * unit.gain) return unit.words;
  return gain > 0.15 && gain < 5.0 ? nullptr : "are unit, scale and wheel_radius right?";
}

class Checker {
 public:
  Checker(const Drive& drive, const std::vector<PoseIncrement>& increments, Diagnostics& notes)
      : drive_(drive), increments_(increments), notes_(notes) {
    const double reach = lagReach(drive);
    lags_ = lagGrid(-reach, reach, 0.1);
  }

  void run() {
    checkPlausible();
    if (drive_.layout != VehicleLayout::kOmni) compare();
    notes_.append(problems_.notes());
  }

 private:
  void compare() {
    if (!problems_.hasFatal()) checkHeading();
    describe();
    if (!problems_.hasFatal()) checkSigns();
    if (!problems_.hasFatal()) checkGains();
  }

  using Rate = std::function<double(const TrackCommand&)>;

  LagTable table(const std::vector<double>& rates, const Rate& command) const {
    return {increments_, rates, commandSums(drive_, command), lags_};
  }
  /// The clearest correlation at a lag possible for a vehicle; 0 if too little is known.
  double correlation(const LagTable& table, double sign) const {
    const auto match = table.best(0, increments_.size(), sign, -kEarlier, kLongestLag);
    return match && match->rows >= kFewestLegs ? match->correlation : 0.0;
  }
  /// Whether other lags explain clearly less.
  bool tellsLag(const LagTable& table, const LagMatch& match) const {
    constexpr double kLess = 0.1;  // of correlation^2
    double least = match.correlation;
    for (const double lag : lags_)
      if (const auto other = table.near(lag, 0, increments_.size()))
        least = std::min(least, std::max(0.0, other->correlation));
    return match.correlation * match.correlation - least * least > kLess;
  }
  /// +1, -1: the rate follows the command, or does the opposite; 0 = not clear.
  /** A robot that moves sideways as much as along its heading is no vehicle with two sides: its
   * turns explain little of the commands. */
  int follows(const LagTable& table) const {
    const double against = -correlation(table, -1.0);
    const bool sideways = heading_.legs >= kFewestLegs && heading_.coherence < kNotTogether;
    if (goesAgainst(table, -kEarlier, kLongestLag))
      return sideways && against < kVeryClear ? 0 : -1;
    return correlation(table, 1.0) > kClear ? 1 : 0;
  }

  std::vector<double> turns(double factor) const {
    std::vector<double> rates = ratesOf(increments_, &PoseIncrement::omega);
    for (double& rate : rates) rate *= factor;
    return rates;
  }
  std::vector<double> speeds(const HeadingFit& fit) const {
    std::vector<double> rates;
    const bool turned = fit.factor != 1.0 || isTurned(fit);
    for (const PoseIncrement& increment : increments_)
      rates.push_back(
          turned ? way(increment) / increment.duration() *
                       std::cos(course(increment) - heading(increment, fit.factor) - fit.offset)
                 : increment.v());
    return rates;
  }
  void checkPlausible() {
    std::vector<double> way_rates, gyro;
    for (const PoseIncrement& increment : increments_)
      way_rates.push_back(way(increment) / increment.duration());
    for (const Segment& segment : drive_.segments)
      for (const InsSample& sample : segment.ins) gyro.push_back(sample.omega);
    const double speed = nearlyLargest(way_rates);
    const double rate = nearlyLargest(gyro);
    const double turn = nearlyLargest(turns(1.0));
    if (rate > kPlausibleTurn) problems_.add(findings::kGyroTooFast, {digits(rate)});
    if (turn > kPlausibleTurn) problems_.add(findings::kHeadingTooFast, {digits(turn)});
    if (speed > std::max(kPlausibleSpeed, fastestOf(drive_.layout)))
      problems_.add(findings::kPositionsTooFast, {digits(speed)});
  }

  void checkHeading() {
    heading_ = bestHeading(increments_);
    turn_factor_ = heading_.factor;
    // Doubled angles do not distinguish forward from reverse: the direction driven on a forward
    // command does.
    if (isTurned(heading_) && follows(table(speeds(heading_), driveRate())) < 0)
      heading_.offset = wrapAngle(heading_.offset + kPi);
    if (heading_.factor == kDegree)
      problems_.add(findings::kHeadingInDegrees);
    else if (heading_.factor == 1.0 / kDegree)
      problems_.add(findings::kHeadingInRadians);
    else if (heading_.factor == -1.0)
      nameMirror();
    else if (isTurned(heading_))
      problems_.add(findings::kHeadingTurned, {digits(std::abs(heading_.offset) / kDegree, 0),
                                               heading_.offset > 0.0 ? "left" : "right"});
  }

  /// Course and heading are mirror images of each other: the commands show which is wrong.
  void nameMirror() {
    const int turn = follows(table(turns(1.0), turnRate()));
    const bool quarter = std::abs(heading_.offset) > kPi / 4.0;
    std::string which = "yaw is clockwise, or x or y is inverted";
    if (turn > 0) {
      turn_factor_ = 1.0;
      which = quarter ? "x and y are swapped"
                      : "y (or x) is inverted; the heading turns with the commands";
    } else if (turn < 0) {
      which = std::string("yaw counts clockwise") +
              (quarter ? " from north, as a compass does (heading: {sense: clockwise, zero: 90})"
                       : " (heading: {sense: clockwise})") +
              "; it turns against the commands, too";
    }
    problems_.add(findings::kMirrored, {which});
  }

  static Rate driveRate() {
    return [](const TrackCommand& c) { return 0.5 * (c.left + c.right); };
  }
  static Rate turnRate() {
    return [](const TrackCommand& c) { return c.right - c.left; };
  }

  void describe() {
    const LagTable speed = table(speeds(heading_), driveRate());
    const LagTable turn = table(turns(turn_factor_), turnRate());
    speed_ = speed.best(0, increments_.size(), 1.0, -kEarlier, kLongestLag);
    turn_ = turn.best(0, increments_.size(), 1.0, -kEarlier, kLongestLag);
    const bool speed_commands = drive_.kind == CommandKind::kTrackSpeed;
    const double gauge = drive_.imported ? drive_.imported->baseline : 0.0;
    const bool car = drive_.layout == VehicleLayout::kCar;
    gauge_ = speed_commands && !car && gauge > 0.0 ? gauge : 0.0;
    const auto line = [&](const char* what, const LagTable& of,
                          const std::optional<LagMatch>& match, const std::string& gain) {
      if (!match) return notes_.add(findings::kTooSteady, {what});
      notes_.add(findings::kFollows,
                 {what, gain, digits(match->correlation, 2), std::to_string(match->rows),
                  tellsLag(of, *match) ? digits(match->lag, 2) + " s after the commands"
                                       : "commands too steady to see the delay"});
    };
    const double v = speed_ ? speed_->slope : 0.0;
    const double w = turn_ ? turn_->slope : 0.0;
    line("speed", speed, speed_,
         speed_commands ? "measured is " + digits(v, 3) + " of the commanded"
                        : digits(v, 2) + " m/s at full power");
    line("turn", turn, turn_,
         gauge_ > 0.0 ? "measured is " + digits(w * gauge_, 3) + " of the commanded"
         : car        ? digits(w, 2) + " rad/s at " + (speed_commands ? "1 m/s" : "full power") +
                     " for a tangent of the steering angle of 1"
         : speed_commands ? digits(w, 3) + " rad/s for each m/s of right over left"
                          : digits(2.0 * w, 2) + " rad/s at full power of both against each other");
  }

  void checkSigns() {
    const std::vector<double> v = speeds(heading_);
    const std::vector<double> omega = turns(turn_factor_);
    const LagTable speed = table(v, driveRate());
    const LagTable turn = table(omega, turnRate());
    const int forward = follows(speed);
    const int left = follows(turn);
    const auto against = [&](const LagTable& of) { return digits(correlation(of, -1.0), 2); };
    if (forward < 0 && left < 0) return problems_.add(findings::kBothReversed, {against(turn)});
    if (left < 0) return problems_.add(findings::kTurnsAgainst, {against(turn)});
    if (forward < 0) return problems_.add(findings::kGoesBackwards, {against(speed)});
    if (forward > 0 && left > 0) return checkBody(v, omega, speed, turn);
    checkOneSide(v, omega, speed, turn);
    if (!problems_.hasFatal()) checkBody(v, omega, speed, turn);
  }

  /// Speed follows the difference of the sides, and turn their sum: one of them is negative.
  void checkOneSide(const std::vector<double>& v, const std::vector<double>& omega,
                    const LagTable& speed, const LagTable& turn) {
    if (correlation(speed, 1.0) > kWeak || correlation(turn, 1.0) > kWeak) return;
    const LagTable speed_by_turn = table(v, turnRate());
    const LagTable turn_by_speed = table(omega, driveRate());
    for (const double sign : {1.0, -1.0})
      if (sign * correlation(speed_by_turn, sign) > kClear &&
          sign * correlation(turn_by_speed, sign) > kClear)
        problems_.add(findings::kOneSideReversed, {sign > 0.0 ? "left" : "right"});
  }

  /// Speed follows one column, and turn the other: they are body speeds, not sides.
  void checkBody(const std::vector<double>& v, const std::vector<double>& omega,
                 const LagTable& speed, const LagTable& turn) {
    const Rate sides[] = {[](const TrackCommand& c) { return c.left; },
                          [](const TrackCommand& c) { return c.right; }};
    constexpr double kBodyClear = 0.9, kBodyClearer = 0.4;
    if (drive_.layout != VehicleLayout::kTracks || differentCommands(drive_) < 10) return;
    const double as_sides = correlation(speed, 1.0) + correlation(turn, 1.0);
    for (const int speed_side : {0, 1}) {
      const double along = correlation(table(v, sides[speed_side]), 1.0);
      const LagTable by_side = table(omega, sides[1 - speed_side]);
      const double about = std::max(correlation(by_side, 1.0), -correlation(by_side, -1.0));
      if (along > kBodyClear && about > kBodyClear && along + about > as_sides + kBodyClearer)
        return problems_.add(findings::kBodySpeeds, {speed_side == 0 ? "left" : "right"});
    }
  }

  void checkGains() {
    const auto clear = [](const std::optional<LagMatch>& match) {
      return match && match->correlation > kVeryClear;
    };
    if (drive_.kind == CommandKind::kTrackSpeed && clear(speed_))
      if (const char* unit = unitOf(speed_->slope); unit != nullptr)
        problems_.add(findings::kSpeedUnit,
                      {digits(speed_->slope, speed_->slope < 0.1 ? 4 : 2), unit});
    checkWheels();
    checkGyroUnit();
    if (gauge_ > 0.0 && clear(turn_) && clear(speed_) && !problems_.hasFatal()) {
      const double gain = turn_->slope * gauge_;
      if (gain < 3.0 * kDegree)
        problems_.add(findings::kTurnInRadians, {digits(gain, 4)});
      else if (gain > 0.2 / kDegree)
        problems_.add(findings::kTurnInDegrees, {digits(gain, 1)});
    }
  }

  /// Compares the wheels' speeds with the motion.
  void checkWheels() {
    const auto by = [&](const std::vector<double>& rates, const Rate& rate) {
      return LagTable{increments_, rates, encoderSums(drive_, rate), lags_};
    };
    if (drive_.encoders.empty()) return;
    const LagTable turn = by(turns(turn_factor_), turnRate());
    const bool with_commands = turn_ && turn_->correlation > kClear;
    if (with_commands && goesAgainst(turn, -1.0, 1.0))
      problems_.add(findings::kWheelsSwapped,
                    {digits(turn.best(0, increments_.size(), -1.0)->correlation, 2)});
    const auto along = by(speeds(heading_), driveRate()).best(0, increments_.size());
    if (!along || along->correlation < kVeryClear) return;
    if (unitOf(along->slope) != nullptr)
      problems_.add(findings::kWheelUnit, {digits(along->slope, along->slope < 0.1 ? 4 : 2)});
  }

  void checkGyroUnit() {
    const auto match = headingBesideGyro(drive_);
    if (!match || std::abs(match->correlation) < kVeryClear) return;
    const double slope = std::abs(match->slope);
    if (slope > 0.7 / kDegree && slope < 1.4 / kDegree)
      problems_.add(findings::kGyroInRadians, {digits(slope)});
    if (slope > 0.7 * kDegree && slope < 1.4 * kDegree)
      problems_.add(findings::kGyroInDegrees, {digits(slope, 4)});
  }

  const Drive& drive_;
  const std::vector<PoseIncrement>& increments_;
  std::vector<double> lags_;
  Diagnostics& notes_;
  Diagnostics problems_{drive_.name};  ///< they follow the comparisons
  HeadingFit heading_;
  double turn_factor_ = 1.0;  ///< of the heading's rate, as far as its unit and sign are known
  double gauge_ = 0.0;        ///< [m] 0 = turns are not commanded in rad/s
  std::optional<LagMatch> speed_, turn_;
};

}  // namespace

bool goesAgainst(const LagTable& table, double from, double to) {
  const auto against = table.best(0, table.increments(), -1.0, from, to);
  const auto with = table.best(0, table.increments(), 1.0, from, to);
  if (!against || against->correlation > -kClear) return false;
  return !with || with->correlation < -against->correlation - kClearer;
}

double lagReach(const Drive& drive) {
  std::vector<double> lengths;
  for (const Segment& segment : drive.segments) lengths.push_back(segment.end - segment.begin());
  std::sort(lengths.begin(), lengths.end());
  double sum = 0.0;
  for (const double length : lengths)
    if ((sum += length) >= 0.5 * drive.driven()) return std::clamp(0.2 * length, 0.5, 10.0);
  return 0.5;
}

void checkMotion(const Drive& drive, const std::vector<PoseIncrement>& increments,
                 Diagnostics& notes) {
  Checker(drive, increments, notes).run();
}

}  // namespace tread::gap
