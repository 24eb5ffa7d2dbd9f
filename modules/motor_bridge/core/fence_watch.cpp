// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/fence_watch.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/microseconds.hpp"

namespace tread::motor {
namespace {

constexpr double kStep = 0.1;         // [s] between the checked poses
constexpr double kMuchTurn = 0.7;     // [1] upper limit of the executed share of a commanded turn
constexpr double kSlack = 0.05;       // [m] by which a pose outside may appear farther out
constexpr double kStillTwist = 0.03;  // [m/s, rad/s] of a robot at rest
constexpr double kMostAge = 0.5;      // [s] of a pose; an older one is a fault of its own
constexpr int64_t kBlindStands = 1'000'000;  // [us] for which the fault stays

std::string centimetres(double metres) {
  const auto rounded = std::lround(100.0 * std::abs(metres));
  const std::string rest = std::to_string(rounded % 100);
  return std::to_string(rounded / 100) + "." + (rest.size() < 2 ? "0" : "") + rest + " m";
}

double effort(const Command& motion) {
  return std::abs(motion[0]) + std::abs(motion[1]) + std::abs(motion[kSideways]);
}

/// Adds a twist that is not zero and not yet in the list.
void add(const Twist2& twist, std::vector<Twist2>& twists) {
  if (std::hypot(twist.v_x, twist.v_y) < kStillTwist && std::abs(twist.omega) < kStillTwist) return;
  for (const Twist2& other : twists)
    if (other.v_x == twist.v_x && other.v_y == twist.v_y && other.omega == twist.omega) return;
  twists.push_back(twist);
}

}  // namespace

void FenceWatch::receive(const InsMotion& ins) {
  const double known = ins_.position_std;
  ins_ = ins;
  // A device that no longer reports its accuracy has not become more accurate.
  if (!std::isfinite(ins_.position_std)) ins_.position_std = known;
}

void FenceWatch::command(const Command& motion, int64_t now) {
  if (given_.empty() || given_.back().command != motion) given_.push_back({now, motion});
  // The last one before the window acts in it, too.
  const int64_t begin = now - toMicroseconds(motion_.delay);
  while (given_.size() > 1 && given_[1].utime <= begin) given_.pop_front();
  if (motion[0] > 0.0 || motion[1] > 0.0) ahead_ = now;
  if (motion[0] < 0.0 || motion[1] < 0.0) back_ = now;
  if (motion[kSideways] > 0.0) left_ = now;
  if (motion[kSideways] < 0.0) right_ = now;
}

std::vector<Eigen::Vector2d> FenceWatch::velocities(int64_t now) const {
  // By then the last command has begun and ended: the stopping time, learned on this ground,
  // includes lag and braking.
  const int64_t begin = now - toMicroseconds(motion_.delay + limits_.stopping_time);
  const auto possible = [&](double measured, const std::optional<int64_t>& plus,
                            const std::optional<int64_t>& minus) -> std::vector<double> {
    if (std::isfinite(measured)) return {measured};
    std::vector<double> speeds;
    if (plus && *plus > begin) speeds.push_back(motion_.full_speed);
    if (minus && *minus > begin) speeds.push_back(-motion_.full_speed);
    if (speeds.empty()) speeds.push_back(0.0);
    return speeds;
  };
  std::vector<Eigen::Vector2d> velocities;
  for (const double forward : possible(ins_.v_forward, ahead_, back_))
    for (const double left : possible(ins_.v_left, left_, right_))
      velocities.emplace_back(forward, left);
  return velocities;
}

std::vector<Twist2> FenceWatch::twists(int64_t now) const {
  std::vector<Twist2> twists;
  std::vector<double> rates;
  if (std::isfinite(ins_.yaw_rate)) rates.push_back(ins_.yaw_rate);
  if (!given_.empty()) {
    const auto fastest = std::max_element(given_.begin(), given_.end(),
                                          [](const TimedCommand& a, const TimedCommand& b) {
                                            return effort(a.command) < effort(b.command);
                                          });
    for (const Command& motion : {given_.back().command, fastest->command}) {
      const double left = motion_.speed_per_command * motion[0];
      const double right = motion_.speed_per_command * motion[1];
      const double aside = motion_.speed_per_command * motion[kSideways];
      const double turn = (right - left) / motion_.gauge;
      for (const double share : {motion_.least_turn, kMuchTurn})
        add({0.5 * (left + right), aside, share * turn}, twists);
      if (!std::isfinite(ins_.yaw_rate)) rates.push_back(kMuchTurn * turn);
    }
  }
  if (rates.empty()) rates.push_back(0.0);
  for (const Eigen::Vector2d& velocity : velocities(now))
    for (const double rate : rates) add({velocity.x(), velocity.y(), rate}, twists);
  return twists;
}

Reason FenceWatch::faultOfFence(const Fence& fence, double& best, const Ways& ways) const {
  const Pose2 here{ins_.x, ins_.y, ins_.yaw};
  const FootprintSize grown = limits_.outline.widened(positionMargin(ins_.position_std));
  // Fences farther away need no exact check, which costs a hundred times as much.
  const bool far = roomAt(fence, here.position()) > reachOf(grown) + ways.farthest;
  const double room = far ? 0.0 : roomAt(fence, here, grown);
  best = room < 0.0 ? std::max(best, room) : -std::numeric_limits<double>::infinity();
  if (far) return {};
  double least = std::min(room, 0.0);
  for (const Pose2& pose : ways.poses) least = std::min(least, -depthOver(fence, pose, grown));
  if (room >= 0.0)
    return least >= 0.0 ? Reason()
                        : Reason(StopReason::kFenceNear,
                                 "fence " + fence.name + ": " + centimetres(room) +
                                     " of room, less than it takes to stop; drive away from it");
  return least >= best - kSlack
             ? Reason()
             : Reason(StopReason::kFenceNear, "outside fence " + fence.name + " by " +
                                                  centimetres(room) + ": only back in");
}

Reason FenceWatch::blindness(int64_t now) {
  const bool known = std::isfinite(ins_.x + ins_.y + ins_.yaw) &&
                     1e-6 * static_cast<double>(now - ins_.utime) <= kMostAge;
  if (known) {
    blind_since_.reset();
    return {};
  }
  blind_since_ = blind_since_.value_or(now);
  return now - *blind_since_ <= kBlindStands ? Reason(StopReason::kFenceBlind) : Reason();
}

Reason FenceWatch::fault(int64_t now) {
  const std::vector<Fence>& fences = book_.fences();
  if (fences.empty()) return {};
  if (!book_.bar().empty()) return {StopReason::kFencesLost, book_.bar()};
  const Reason blind = blindness(now);
  if (!blind.empty() || !std::isfinite(ins_.x + ins_.y + ins_.yaw)) return blind;
  if (best_revision_ != book_.revision() || best_.size() != fences.size()) {
    best_.assign(fences.size(), -std::numeric_limits<double>::infinity());
    best_revision_ = book_.revision();
  }
  const double age = std::clamp(1e-6 * static_cast<double>(now - ins_.utime), 0.0, kMostAge);
  const double end = age + limits_.stopping_time;
  const Pose2 here{ins_.x, ins_.y, ins_.yaw};
  Ways ways;
  for (const Twist2& twist : twists(now)) {
    for (double t = kStep; t < end; t += kStep) ways.poses.push_back(here * integrate(twist, t));
    ways.poses.push_back(here * integrate(twist, end));
  }
  for (const Pose2& pose : ways.poses)
    ways.farthest = std::max(ways.farthest, distanceBetween(here, pose));
  Reason worst;
  for (size_t i = 0; i < fences.size(); ++i) {
    const Reason fault = faultOfFence(fences[i], best_[i], ways);
    if (worst.empty()) worst = fault;
  }
  return worst;
}

}  // namespace tread::motor
