// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/commissioning/core/wiring_drive.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/microseconds.hpp"

namespace tread::commissioning {
namespace {

constexpr double kLongestPulse = 2.0;    // [s]
constexpr double kMovedAway = 0.04;      // [m] that counts as motion
constexpr double kMovedRound = 0.06;     // [rad]
constexpr int64_t kSpeedSpan = 300'000;  // [us]
constexpr int64_t kBlind = 500'000;      // [us] without a pose that it tolerates
constexpr double kTurnAsTravel = 0.35;   // [m] per rad, to keep turns short

using Pulse = WiringDrive::Pulse;

/// Back and forth, so that it stays in place. Return turns are shorter, so that it faces all
/// directions by the end.
constexpr Pulse kRound[] = {
    {1, 0, false, 1},    {-1, 0, false, 0.8},   {0, 1, false, 1},    {0, -1, false, 0.8},
    {1, 1, true, 1},     {-1, -1, true, 1},     {1, -1, true, 1},    {-1, 1, true, 0.6},
    {1, 1, true, 1},     {-1, -1, true, 1},     {1, 0, true, 0.8},   {-1, 0, true, 0.7},
    {0, 1, true, 0.8},   {0, -1, true, 0.7},    {1, 1, true, 1},     {-1, -1, true, 1},
    {1, 1, false, 0.7},  {-1, -1, false, 0.7},  {-1, 1, false, 1},   {1, -1, false, 0.6},
    {1, 0.5, true, 0.8}, {-1, -0.5, true, 0.8}, {0.5, 1, true, 0.8}, {-0.5, -1, true, 0.8}};
constexpr size_t kPulses = sizeof kRound / sizeof kRound[0];

/// The same for throttle and steering: driving back with the same steering returns to the start.
constexpr Pulse kCarRound[] = {{1, 1, false, 1},   {-1, 1, false, 1},  {1, -1, false, 1},
                               {-1, -1, false, 1}, {1, 0, false, 1},   {-1, 0, false, 1},
                               {1, 0, true, 1},    {-1, 0, true, 1},   {1, 1, true, 1},
                               {-1, 1, true, 1},   {1, -1, true, 1},   {-1, -1, true, 1},
                               {1, 0, true, 1},    {-1, 0, true, 1},   {1, 0.5, true, 1},
                               {-1, 0.5, true, 1}, {1, -0.5, true, 1}, {-1, -0.5, true, 1}};
constexpr size_t kCarPulses = sizeof kCarRound / sizeof kCarRound[0];
constexpr double kHomeward = 0.3;  // of the room: from here a car drives back

}  // namespace

WiringDriveConfig preDrive(bool car) {
  WiringDriveConfig config;
  config.room = 1.0;
  config.seconds = 8.0;
  config.travel = 0.1;
  config.shortest = 0.3;
  config.pause = 0.35;
  config.first_level = 0.3;
  config.most_path = 0.75;
  if (!car) return config;
  config.car = true;
  config.seconds = 12.0;
  config.shortest = 0.25;
  config.first_level = 0.12;
  config.level_step = 0.06;
  return config;
}

WiringDrive::WiringDrive(const WiringDriveConfig& config)
    : config_(config), level_(config.first_level) {}

void WiringDrive::end(const std::string& problem) {
  done_ = true;
  problem_ = problem;
  command_ = {};
}

void WiringDrive::follow(const Pose2& pose) {
  if (!home_) home_ = pose;
  if (last_) path_ += distanceBetween(*last_, pose);
  last_ = pose;
}

TrackCommand WiringDrive::step(int64_t utime, const std::optional<Pose2>& T_map_body) {
  if (done_) return {};
  if (!start_) start_ = last_seen_ = utime;
  if (T_map_body) {
    last_seen_ = utime;
    // Noise at standstill accumulates: only larger steps count as path.
    if (!last_ || distanceBetween(*last_, *T_map_body) > 0.02) follow(*T_map_body);
    recent_.emplace_back(utime, *T_map_body);
    while (recent_.front().first < utime - kSpeedSpan) recent_.pop_front();
  }
  if (utime - *last_seen_ > kBlind) {
    end("the INS has no position with a heading; driving without one is not allowed");
  } else if (home_ && distanceBetween(*home_, *last_) > 0.9 * config_.room) {
    end("the vehicle has left the free circle; drive it back to the middle, or allow more room");
  } else if (path_ > config_.most_path) {
    end("");
  } else if (home_) {
    if (config_.car && utime >= pulse_begin_ && utime < pulse_end_) command_.left = throttle_;
    const bool moves = command_.left != 0.0 || (!config_.car && command_.right != 0.0);
    if (utime >= pulse_end_ && moves) feel();
    if (utime >= pause_end_ && !done_) begin(utime);
  }
  return command_;
}

/// Evaluates the pulse that has ended.
void WiringDrive::feel() {
  const double share = config_.car ? std::abs(command_.left)
                                   : std::max(std::abs(command_.left), std::abs(command_.right));
  command_ = {0.0, config_.car ? command_.right : 0.0};
  const Pose2& now = recent_.back().second;
  const Pose2& then = recent_.front().second;
  const double time =
      std::max(0.1, 1e-6 * static_cast<double>(recent_.back().first - recent_.front().first));
  const double went =
      distanceBetween(then, now) + kTurnAsTravel * std::abs(wrapAngle(now.yaw - then.yaw));
  fastest_ = std::max(fastest_, went / time / share);
  if (config_.car && distanceBetween(pulse_start_, now) > kMovedAway)
    way_ = std::copysign(1.0, throttle_) * (now.position() - pulse_start_.position());
  tried_ = true;
}

/// Whether the last pulse moved it, judged after the pause: on soft ground it starts late and
/// coasts.
void WiringDrive::judge() {
  const Pose2& now = recent_.empty() ? *last_ : recent_.back().second;
  felt_ = distanceBetween(pulse_start_, now) > kMovedAway ||
          std::abs(wrapAngle(now.yaw - pulse_start_.yaw)) > kMovedRound;
  if (!felt_ && level_ >= 1.0) end("");  // full command on both sides does not move it
  if (!felt_) level_ = std::min(1.0, level_ + config_.level_step);
}

WiringDrive::Pulse WiringDrive::nextPulse() {
  // One side alone: the other one may be dead or reversed.
  if (!felt_) return {1, config_.car ? 1.0 : 0.5, false, 1};
  const size_t at = pulse_++;
  if (!config_.car) return kRound[at % kPulses];
  Pulse pulse = kCarRound[at % kCarPulses];
  const Eigen::Vector2d home = home_->position() - last_->position();
  if (way_ && home.norm() > kHomeward * config_.room)
    pulse.left = std::copysign(pulse.left, home.dot(*way_));
  return pulse;
}

double WiringDrive::levelOf(const Pulse& pulse) const {
  if (!felt_) return level_;
  const bool brief = config_.travel < 0.5;
  if (pulse.full && !brief) return 1.0;
  if (config_.car && brief) return std::min(1.0, level_ + config_.level_step);
  return std::min(1.0, std::max(0.5, level_ + config_.level_step));
}

void WiringDrive::begin(int64_t utime) {
  if (tried_ && !felt_) judge();
  if (done_) return;
  if (utime - *start_ > toMicroseconds(config_.seconds) && pulse_ % 2 == 0) return end("");
  const Pulse pulse = nextPulse();
  const double level = levelOf(pulse);
  const double far = distanceBetween(*home_, *last_) > 0.5 * config_.room ? 0.5 : 1.0;
  const double speed = std::max(0.05, fastest_ * level);
  const double time = felt_ ? std::clamp(far * pulse.share * config_.travel / speed,
                                         pulse.share * config_.shortest, kLongestPulse)
                            : config_.shortest;
  pulse_start_ = *last_;
  pulse_begin_ = utime;
  if (config_.car) {
    // Wheels first: a servo is slow.
    if (command_.right != pulse.right) pulse_begin_ += toMicroseconds(config_.pause);
    throttle_ = level * pulse.left;
    command_ = {0.0, pulse.right};
  } else {
    command_ = {level * pulse.left, level * pulse.right};
  }
  pulse_end_ = pulse_begin_ + toMicroseconds(time);
  pause_end_ = pulse_end_ + toMicroseconds(config_.pause);
}

}  // namespace tread::commissioning
