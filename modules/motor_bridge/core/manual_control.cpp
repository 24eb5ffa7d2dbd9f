// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/manual_control.hpp"

#include <algorithm>
#include <cmath>

namespace tread::motor {
namespace {

const std::string kNotAtRest = "the stick was not seen at rest: let it go once";

/// Stopping is never delayed: a smaller command is given at once, and growth starts from there.
double limited(double wanted, double given, double growth) {
  const double from = wanted * given > 0.0 ? std::abs(given) : 0.0;
  return std::copysign(std::min(std::abs(wanted), from + growth), wanted);
}

}  // namespace

std::string ManualControl::receive(const ManualNotice& notice, int64_t now) {
  // With an unknown stick position (NaN), the message's buttons still count.
  if (std::abs(notice.left) > 1.0 || std::abs(notice.right) > 1.0)
    return "a command that is no share of the largest, -1 to 1";
  const bool same = notice.station == last_.station;
  if (same && notice.seq <= last_.seq) return "out of order";
  const OperatorNotice seen{
      notice.station, std::to_string(notice.station), true, notice.seen_utime, 0, ""};
  switch (lease_.receive(seen, now)) {
    case OperatorLease::Receipt::kTaken:
      break;
    case OperatorLease::Receipt::kOfAnother:
      return "another program has manual control";
    default:
      return "its program has not seen the robot within " +
             std::to_string(limits_.lease_us / 1000) + " ms";
  }
  const bool known = !std::isnan(notice.left) && !std::isnan(notice.right);
  if (!known) must_rest_ = true;
  last_ = notice;
  if (atRest()) must_rest_ = false;
  return "";
}

bool ManualControl::letGo(int64_t station) {
  if (station != last_.station) return false;
  return last_.give_back = true;
}

void ManualControl::update(int64_t now, bool has, bool armed) {
  lease_.update(now, false);
  fresh_ = lease_.valid(now);
  live_ = fresh_ && last_.hold && !last_.give_back;
  // After a stop the stick may still be deflected: arming must not move the robot.
  if (!fresh_ || (!armed && !atRest())) must_rest_ = true;
  if (has) return;
  command_ = TrackCommand{};
  commanded_.reset();
}

std::string ManualControl::bar() const {
  return live_ && must_rest_ ? kNotAtRest : "";
}

std::string ManualControl::words() const {
  if (!fresh_) return "in the hand of " + last_.name + ", who is silent";
  if (!last_.hold) return "in the hand of " + last_.name + ", dead-man's button released";
  if (must_rest_) return "in the hand of " + last_.name + ": " + kNotAtRest;
  return "driven by hand by " + last_.name;
}

namespace {

Command omniCommand(const TrackCommand& stick, const ManualLimits& limits) {
  Command command = limits.wheels.speeds(
      {0.5 * (stick.left + stick.right), 0.0, (stick.right - stick.left) / limits.gauge});
  double most = limits.max_command;
  for (size_t i = 0; i < limits.wheels.size(); ++i) most = std::max(most, std::abs(command[i]));
  for (size_t i = 0; i < limits.wheels.size(); ++i) command[i] *= limits.max_command / most;
  return command;
}

}  // namespace

Command commandOf(const TrackCommand& stick, const ManualLimits& limits) {
  if (!limits.wheels.empty() && limits.max_command > 0.0) return omniCommand(stick, limits);
  if (limits.max_steering <= 0.0 || limits.max_command <= 0.0) return stick;
  const double turn = 0.5 * (stick.right - stick.left) / limits.max_command;
  return {0.5 * (stick.left + stick.right), limits.max_steering * turn};
}

TrackCommand ManualControl::command(int64_t now) {
  if (!live_ || must_rest_ || atRest()) return command_ = TrackCommand{};
  const TrackCommand wanted{last_.left * limits_.max_command, last_.right * limits_.max_command};
  if (commanded_ && now - *commanded_ < kInterval) return command_;
  const double growth =
      commanded_
          ? limits_.slew * static_cast<double>(std::min(now - *commanded_, 2 * kInterval)) * 1e-6
          : 0.0;
  command_.left = limited(wanted.left, command_.left, growth);
  command_.right = limited(wanted.right, command_.right, growth);
  commanded_ = now;
  return command_;
}

}  // namespace tread::motor
