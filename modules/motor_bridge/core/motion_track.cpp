// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/motion_track.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/microseconds.hpp"
#include "common/geometry/se2.hpp"

namespace tread::motor {
namespace {

constexpr int64_t kKept = 3'500'000;      // [us] of history: longer than the longest window
constexpr int64_t kPiece = 20'000;        // [us] integration step of the bands
constexpr int64_t kMaxGap = 300'000;      // [us] beyond which windows restart
constexpr int64_t kSettling = 3'000'000;  // [us] in which the bands forget earlier commands
constexpr double kBrokenSpeed = 10.0;     // [1] of full speed: no valid measurement
constexpr double kMostTravel = 1.25;      // [1] of the commanded: slopes, tyres, calibration
constexpr double kMostTurn = 1.4;         // [1]
constexpr double kTurnToTravel = 0.25;    // [1] travel caused by turning, of half the gauge

/// Lower bound of a speed if a share of it beyond `dead`, or `most` of it, is executed.
double atLeast(double speed, double dead, double share, double most) {
  return speed > 0.0 ? share * std::max(0.0, speed - dead) : most * speed;
}

/// [1] cross-coupling between sideways and forward motion of a holonomic base: its wheels do not
/// slip equally.
constexpr double kAskew = 0.25;
constexpr double kRounding =
    1e-9;  // [m/s] rounding error of a holonomic base's wheels, converted to a motion

}  // namespace

Command MotionLimits::motion(const Command& command) const {
  if (isOmni()) {
    const Twist2 twist = wheels.twist(command);
    const double turn = 0.5 * gauge * twist.omega;
    // Rounding errors are no commanded direction.
    const auto exact = [](double value) { return std::abs(value) < kRounding ? 0.0 : value; };
    Command motion(exact(twist.v_x - turn), exact(twist.v_x + turn));
    motion[kSideways] = exact(twist.v_y);
    return motion;
  }
  if (wheelbase <= 0.0) return command.tracks();
  return rearWheels(command[0], command[1], wheelbase, gauge);
}

void TrackBand::follow(double least, double most, const MotionLimits& limits, double dt) {
  const double share = 1.0 - std::exp(-dt / limits.lag);
  const double step = limits.acceleration * dt;
  low_ = std::min(least, low_ + std::min(share * (least - low_), step));
  high_ = std::max(most, high_ + std::max(share * (most - high_), -step));
}

MotionSums MotionSums::operator-(const MotionSums& start) const {
  MotionSums out;
  out.utime = utime - start.utime;
  out.forward = forward - start.forward;
  out.left = left - start.left;
  out.position = position - start.position;
  out.turned = turned - start.turned;
  out.travel_min = travel_min - start.travel_min;
  out.travel_max = travel_max - start.travel_max;
  out.turn_min = turn_min - start.turn_min;
  out.turn_max = turn_max - start.turn_max;
  out.low = low - start.low;
  out.high = high - start.high;
  out.travel = travel - start.travel;
  out.turn = turn - start.turn;
  out.side_min = side_min - start.side_min;
  out.side_max = side_max - start.side_max;
  out.tracks_min = tracks_min - start.tracks_min;
  out.reach = reach - start.reach;
  out.turn_reach = turn_reach - start.turn_reach;
  out.ins_way = ins_way - start.ins_way;
  out.ins_path = ins_path - start.ins_path;
  out.gyro = gyro - start.gyro;
  out.gyro_path = gyro_path - start.gyro_path;
  out.turned_with_gyro = turned_with_gyro - start.turned_with_gyro;
  out.no_velocity = no_velocity - start.no_velocity;
  out.no_rate = no_rate - start.no_rate;
  return out;
}

void MotionTrack::command(const Command& motion, int64_t now) {
  const Eigen::Array3d speed =
      (Eigen::Array3d(motion[0], motion[1], motion[kSideways]) * limits_.speed_per_command)
          .cwiseMax(-limits_.full_speed)
          .cwiseMin(limits_.full_speed);
  if ((given_.back().speed == speed).all() || now < given_.back().utime) return;
  given_.push_back({now, speed});
}

bool MotionTrack::reachable(const InsMotion& ins, double slack, double yaw_slack) const {
  const int64_t passed = ins.utime - last_.utime;
  if (history_.empty() || passed > kMaxGap) return true;
  const double time = 1e-6 * static_cast<double>(passed) + limits_.time_error;
  const double far = slack + kMostTravel * limits_.full_speed * time;
  const double turn = yaw_slack + kMostTurn * 2.0 * limits_.full_speed / limits_.gauge * time;
  const bool too_far = std::hypot(ins.x - last_.x, ins.y - last_.y) > far;
  return !too_far && !(std::abs(wrapAngle(ins.yaw - last_.yaw)) > turn);
}

bool MotionTrack::add(const InsMotion& ins) {
  const bool known = std::isfinite(ins.x) && std::isfinite(ins.y) && std::isfinite(ins.yaw);
  if (!known || ins.utime <= last_.utime) return false;
  MotionSums sums;
  if (history_.empty() || ins.utime - last_.utime > kMaxGap) {
    history_.clear();
    repeats_.reset();
    follow(sums, std::max(last_.utime, ins.utime - kSettling), ins.utime);
    sums = MotionSums{};
  } else {
    sums = history_.back();
    follow(sums, last_.utime, ins.utime);
    measure(sums, ins, 1e-6 * static_cast<double>(ins.utime - last_.utime));
  }
  sums.utime = ins.utime;
  sums.position = {ins.x, ins.y};
  const bool same = ins.x == last_.x && ins.y == last_.y && ins.yaw == last_.yaw;
  if (!same || !repeats_) repeats_ = sums;
  history_.push_back(sums);
  last_ = ins;
  while (history_[1 % history_.size()].utime < ins.utime - kKept) history_.pop_front();
  const int64_t needed = ins.utime - kSettling - toMicroseconds(limits_.delay);
  while (given_.size() > 1 && given_[1].utime < needed) given_.pop_front();
  return true;
}

void MotionTrack::follow(MotionSums& sums, int64_t from, int64_t until) {
  for (int64_t t = from; t < until; t += kPiece) followPiece(sums, t, std::min(t + kPiece, until));
}

void MotionTrack::followPiece(MotionSums& sums, int64_t from, int64_t until) {
  const double dt = 1e-6 * static_cast<double>(until - from);
  const int64_t oldest = until - toMicroseconds(limits_.delay);
  Eigen::Array3d low = Eigen::Array3d::Constant(limits_.full_speed);
  Eigen::Array3d high = -low;
  Eigen::Array3d newest = Eigen::Array3d::Zero();
  for (size_t i = 0; i < given_.size(); ++i) {
    if (given_[i].utime >= until) break;
    newest = given_[i].speed;
    if (i + 1 < given_.size() && given_[i + 1].utime <= oldest) continue;
    low = low.min(newest);
    high = high.max(newest);
  }
  for (int i = 0; i < 3; ++i) bands_[i].follow(low[i], high[i], limits_, dt);
  for (int i = 0; i < 2; ++i) {
    sums.low[i] += dt * bands_[i].low();
    sums.high[i] += dt * bands_[i].high();
  }
  const double v_low = 0.5 * (bands_[0].low() + bands_[1].low());
  const double v_high = 0.5 * (bands_[0].high() + bands_[1].high());
  const double w_low = (bands_[1].low() - bands_[0].high()) / limits_.gauge;
  const double w_high = (bands_[1].high() - bands_[0].low()) / limits_.gauge;
  const double v_most = std::max(std::abs(v_low), std::abs(v_high));
  const double w_most = std::max(std::abs(w_low), std::abs(w_high));
  const double s_low = bands_[kSideways].low(), s_high = bands_[kSideways].high();
  const double s_most = std::max(std::abs(s_low), std::abs(s_high));
  const double swing = kTurnToTravel * w_most * 0.5 * limits_.gauge + kAskew * s_most;
  const double pull = limits_.pull * (v_most + s_most) / limits_.gauge;
  const double dead = limits_.dead_band * limits_.full_speed;
  const double dead_turn = 2.0 * dead / limits_.gauge;
  const double travel = limits_.least_travel, turn = limits_.least_turn;
  sums.travel_min += dt * (atLeast(v_low, dead, travel, kMostTravel) - swing);
  sums.travel_max += dt * (-atLeast(-v_high, dead, travel, kMostTravel) + swing);
  sums.side_min += dt * atLeast(s_low, dead, travel, kMostTravel);
  sums.side_max += dt * -atLeast(-s_high, dead, travel, kMostTravel);
  sums.turn_min += dt * (atLeast(w_low, dead_turn, turn, kMostTurn) - pull);
  sums.turn_max += dt * (-atLeast(-w_high, dead_turn, turn, kMostTurn) + pull);
  sums.travel += dt * newest.head<2>().mean();
  sums.turn += dt * (newest[1] - newest[0]) / limits_.gauge;
  const auto leastOf = [this](const TrackBand& band) {
    return std::abs(beyondDeadBand(band.low(), band.high()));
  };
  sums.tracks_min +=
      dt * std::max(0.5 * (leastOf(bands_[0]) + leastOf(bands_[1])), leastOf(bands_[kSideways]));
  sums.reach += dt * std::max(std::hypot(v_most, s_most), 0.5 * limits_.gauge * w_most);
  sums.turn_reach += dt * w_most;
}

void MotionTrack::measure(MotionSums& sums, const InsMotion& ins, double dt) const {
  const double turned = wrapAngle(ins.yaw - last_.yaw);
  const double middle = last_.yaw + 0.5 * turned;
  const Eigen::Vector2d ahead(std::cos(middle), std::sin(middle));
  const Eigen::Vector2d aside(-ahead.y(), ahead.x());
  const Eigen::Vector2d moved(ins.x - last_.x, ins.y - last_.y);
  sums.forward += moved.dot(ahead);
  sums.left += moved.dot(aside);
  sums.turned += turned;
  const double forward = 0.5 * (ins.v_forward + last_.v_forward);
  const double left = 0.5 * (ins.v_left + last_.v_left);
  if (std::hypot(forward, left) < kBrokenSpeed * limits_.full_speed) {
    sums.ins_way += dt * (forward * ahead + left * aside);
    sums.ins_path += dt * std::hypot(forward, left);
  } else {
    sums.no_velocity += dt;
  }
  const double rate = 0.5 * (ins.yaw_rate + last_.yaw_rate);
  if (std::abs(rate) * limits_.gauge < kBrokenSpeed * limits_.full_speed) {
    sums.gyro += dt * rate;
    sums.gyro_path += dt * std::abs(rate);
    sums.turned_with_gyro += turned;
  } else {
    sums.no_rate += dt;
  }
}

double MotionTrack::beyondDeadBand(double low, double high) const {
  const double dead = limits_.dead_band * limits_.full_speed;
  return std::max(0.0, low - dead) + std::min(0.0, high + dead);
}

double MotionTrack::least(size_t wheel) const {
  if (!limits_.isOmni()) return beyondDeadBand(bands_[wheel].low(), bands_[wheel].high());
  // Forward speed, sideways speed and turn are anywhere in their bands.
  const Eigen::Vector3d row = limits_.wheels.row(wheel);
  const double turning = row[2] / limits_.gauge;
  const double weights[] = {0.5 * row[0] - turning, 0.5 * row[0] + turning, row[1]};
  double low = 0.0, high = 0.0;
  for (size_t i = 0; i < 3; ++i) {
    const double ends[] = {weights[i] * bands_[i].low(), weights[i] * bands_[i].high()};
    low += std::min(ends[0], ends[1]);
    high += std::max(ends[0], ends[1]);
  }
  return beyondDeadBand(low, high);
}

MotionSums MotionTrack::step() const {
  return history_.back() - history_[history_.size() - 2];
}

std::optional<MotionSums> MotionTrack::window(double seconds, double ago) const {
  const auto after = [this](int64_t utime) {
    return std::partition_point(history_.begin(), history_.end(),
                                [utime](const MotionSums& sums) { return sums.utime <= utime; });
  };
  const auto end = after(history_.back().utime - toMicroseconds(ago));
  if (end == history_.begin()) return std::nullopt;
  const auto begin = after(std::prev(end)->utime - toMicroseconds(seconds));
  if (begin == history_.begin()) return std::nullopt;
  return *std::prev(end) - *std::prev(begin);
}

MotionSums MotionTrack::repeats() const {
  return history_.back() - *repeats_;
}

double MotionTrack::zeroFor() const {
  const int64_t now = history_.back().utime;
  for (auto it = given_.rbegin(); it != given_.rend(); ++it) {
    if (it->utime >= now) continue;
    return (it->speed == 0.0).all() ? 1e-6 * static_cast<double>(now - it->utime) : 0.0;
  }
  return 0.0;
}

}  // namespace tread::motor
