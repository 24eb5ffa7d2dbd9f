// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/fence_watch.hpp"

#include <algorithm>
#include <cmath>

namespace tread::motor {
namespace {

constexpr double kSigmas = 2.0;              // of the position's standard deviation
constexpr double kUnknownStd = 0.1;          // [m] where the INS tells none
constexpr double kStep = 0.1;                // [s] between the poses that are looked at
constexpr double kMuchTurn = 0.7;            // [1] of a commanded turn that is made at most
constexpr double kSlack = 0.05;              // [m] by which a pose outside may seem farther out
constexpr double kStill = 0.03;              // [m/s, rad/s] of a standing robot
constexpr double kMostAge = 0.5;             // [s] of a pose; an older one is a fault of its own
constexpr int64_t kBlindStands = 1'000'000;  // [us] for which it is

std::string centimetres(double metres) {
  const auto rounded = std::lround(100.0 * std::abs(metres));
  const std::string rest = std::to_string(rounded % 100);
  return std::to_string(rounded / 100) + "." + (rest.size() < 2 ? "0" : "") + rest + " m";
}

double effort(const TrackCommand& command) {
  return std::abs(command.left) + std::abs(command.right);
}

}  // namespace

void FenceWatch::receive(const InsMotion& ins) {
  const double known = ins_.position_std;
  ins_ = ins;
  // A device that tells its accuracy no more has not become better.
  if (!std::isfinite(ins_.position_std)) ins_.position_std = known;
}

void FenceWatch::command(const TrackCommand& command, int64_t now) {
  if (given_.empty() || given_.back().command != command) given_.push_back({now, command});
  // The last one before the window holds in it, too.
  const int64_t begin = now - static_cast<int64_t>(1e6 * motion_.delay);
  while (given_.size() > 1 && given_[1].utime <= begin) given_.pop_front();
}

std::vector<Twist2> FenceWatch::twists() const {
  std::vector<Twist2> twists;
  const bool measured =
      std::isfinite(ins_.v_forward) && std::isfinite(ins_.v_left) && std::isfinite(ins_.yaw_rate);
  // Unmeasured, it may be as fast as it can.
  if (measured)
    twists.push_back({ins_.v_forward, ins_.v_left, ins_.yaw_rate});
  else
    twists = {{motion_.full_speed, 0.0, 0.0}, {-motion_.full_speed, 0.0, 0.0}};
  if (given_.empty()) return twists;
  const auto fastest = std::max_element(
      given_.begin(), given_.end(),
      [](const Given& a, const Given& b) { return effort(a.command) < effort(b.command); });
  for (const TrackCommand& command : {given_.back().command, fastest->command}) {
    const double left = motion_.speed_per_command * command.left;
    const double right = motion_.speed_per_command * command.right;
    for (const double share : {motion_.least_turn, kMuchTurn})
      twists.push_back({0.5 * (left + right), 0.0, share * (right - left) / motion_.gauge});
  }
  const auto stands = [](const Twist2& twist) {
    return std::hypot(twist.v_x, twist.v_y) < kStill && std::abs(twist.omega) < kStill;
  };
  twists.erase(std::remove_if(twists.begin(), twists.end(), stands), twists.end());
  return twists;
}

std::string FenceWatch::faultOfFence(const Fence& fence, double& best,
                                     const std::vector<Pose2>& ways) const {
  const double std = std::isfinite(ins_.position_std) ? ins_.position_std : kUnknownStd;
  const FootprintSize grown = limits_.outline.widened(kSigmas * std);
  const double room = roomAt(fence, {ins_.x, ins_.y, ins_.yaw}, grown);
  best = room < 0.0 ? std::max(best, room) : -std::numeric_limits<double>::infinity();
  double least = room;
  for (const Pose2& pose : ways) least = std::min(least, roomAt(fence, pose, grown));
  if (room >= 0.0)
    return least >= 0.0 ? ""
                        : "fence " + fence.name + ": " + centimetres(room) +
                              " of room, less than it takes to stop; drive away from it";
  return least >= best - kSlack
             ? ""
             : "outside fence " + fence.name + " by " + centimetres(room) + ": only back in";
}

std::string FenceWatch::blindness(int64_t now) {
  const bool known = std::isfinite(ins_.x + ins_.y + ins_.yaw) &&
                     1e-6 * static_cast<double>(now - ins_.utime) <= kMostAge;
  if (known) {
    blind_since_.reset();
    return "";
  }
  blind_since_ = blind_since_.value_or(now);
  return now - *blind_since_ <= kBlindStands ? "position unknown: fences cannot be kept" : "";
}

std::string FenceWatch::fault(int64_t now) {
  const std::vector<Fence>& fences = book_.fences();
  if (fences.empty()) return "";
  const std::string blind = blindness(now);
  if (!blind.empty() || !std::isfinite(ins_.x + ins_.y + ins_.yaw)) return blind;
  if (best_revision_ != book_.revision() || best_.size() != fences.size()) {
    best_.assign(fences.size(), -std::numeric_limits<double>::infinity());
    best_revision_ = book_.revision();
  }
  const double age = std::clamp(1e-6 * static_cast<double>(now - ins_.utime), 0.0, kMostAge);
  const double end = age + limits_.stopping_time;
  const Pose2 here{ins_.x, ins_.y, ins_.yaw};
  std::vector<Pose2> ways;
  for (const Twist2& twist : twists()) {
    for (double t = kStep; t < end; t += kStep) ways.push_back(here * integrate(twist, t));
    ways.push_back(here * integrate(twist, end));
  }
  std::string worst;
  for (size_t i = 0; i < fences.size(); ++i) {
    const std::string fault = faultOfFence(fences[i], best_[i], ways);
    if (worst.empty()) worst = fault;
  }
  return worst;
}

}  // namespace tread::motor
