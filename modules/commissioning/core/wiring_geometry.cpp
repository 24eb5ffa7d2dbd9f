// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/commissioning/core/wiring_geometry.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace tread::commissioning {
namespace {

constexpr double kFull = 0.99;         // [1] a full command
constexpr double kLeastSteady = 0.25;  // [s] shortest time for measuring a speed
constexpr double kSettled = 2.5;       // [lags] after which a speed is steady

double angleOf(const Eigen::Vector2d& direction) {
  return std::atan2(direction.y(), direction.x());
}

/// Index of the first fix at or after a time.
size_t fixAt(const std::vector<TimedPose>& fixes, int64_t utime) {
  const auto later = [](const TimedPose& fix, int64_t time) { return fix.utime < time; };
  return static_cast<size_t>(std::lower_bound(fixes.begin(), fixes.end(), utime, later) -
                             fixes.begin());
}

TrackCommand ofRealSides(const TrackCommand& given, const WiringGeometry& geometry) {
  const double left = geometry.reverse_left ? -given.left : given.left;
  const double right = geometry.reverse_right ? -given.right : given.right;
  return geometry.swapped ? TrackCommand{right, left} : TrackCommand{left, right};
}

/// Adds the mounting of the INS, and the response in time.
void place(const WiringFit& fit, double yaw, const Eigen::Vector2d& ins, WiringGeometry& found) {
  found.of[kYaw] = yaw;
  found.of[kX] = ins.x();
  found.of[kY] = ins.y();
  found.of[kDelay] = fit.delay;
  found.of[kLag] = fit.lag;
  found.of[kDeadPower] = fit.dead;
}

}  // namespace

WiringGeometry geometryOf(const WiringFit& fit, bool swapped) {
  WiringGeometry found;
  found.swapped = swapped;
  const auto& response = fit.response;
  const double c_left = response(2, 0), c_right = response(2, 1);
  const Eigen::Vector2d straight =
      c_right * response.block<2, 1>(0, 0) - c_left * response.block<2, 1>(0, 1);
  // A forward track turns the vehicle away from its own side.
  const double sign = (c_left * c_right > 0.0) == swapped ? 1.0 : -1.0;
  const Eigen::Vector2d forward = sign * straight.normalized();
  const double width = straight.norm() / std::abs(c_left * c_right);
  const double speed_left = (swapped ? width : -width) * c_left;
  const double speed_right = (swapped ? -width : width) * c_right;
  found.reverse_left = speed_left < 0.0;
  found.reverse_right = speed_right < 0.0;
  const double full_left = fit.atFull() * std::abs(speed_left);
  const double full_right = fit.atFull() * std::abs(speed_right);
  // The remaining velocity is due to turning, at a point away from the middle.
  const double away = angleOf(forward);
  const Eigen::Rotation2D<double> to_body(-away);
  Eigen::Vector2d lever = Eigen::Vector2d::Zero();
  for (const int i : {0, 1}) {
    const double speed = i == 0 ? speed_left : speed_right;
    const double turn = response(2, i);
    const Eigen::Vector2d rest =
        to_body * Eigen::Vector2d(response(0, i), response(1, i)) - Eigen::Vector2d(speed / 2, 0);
    const double weight = turn * turn / (c_left * c_left + c_right * c_right);
    lever += weight * Eigen::Vector2d(rest.y(), -rest.x()) / turn;
  }
  found.of = {swapped ? full_right : full_left, swapped ? full_left : full_right, width};
  place(fit, wrapAngle(-away), lever, found);
  return found;
}

WiringGeometry geometryOfOne(const WiringFit& fit, int alive) {
  WiringGeometry found;
  const Eigen::Vector2d moved = fit.response.block<2, 1>(0, alive);
  const double turn = fit.response(2, alive);
  const bool ahead = std::abs(angleOf(moved)) < kPi / 2.0;
  const bool is_left = (turn < 0.0) == ahead;
  found.swapped = is_left != (alive == 0);
  (alive == 0 ? found.reverse_left : found.reverse_right) = !ahead;
  const double speed = 2.0 * moved.norm() * fit.atFull();
  found.of[is_left ? kLeft : kRight] = speed;
  found.of[kWidth] = 2.0 * moved.norm() / std::max(1e-6, std::abs(turn));
  place(fit, wrapAngle(-angleOf(ahead ? moved : Eigen::Vector2d(-moved))), {0.0, 0.0}, found);
  return found;
}

WiringGeometry geometryOfCar(const WiringFit& fit, bool backwards, double wheelbase) {
  WiringGeometry found;
  const double sign = backwards ? -1.0 : 1.0;
  found.of[kLeft] = found.of[kRight] = fit.atFull() * fit.ahead().norm();
  const double yaw = wrapAngle(-angleOf(sign * fit.ahead()));
  const Pose2 to_body{0.0, 0.0, yaw};
  place(fit, yaw, to_body * Eigen::Vector2d(fit.response(1, 1), -fit.response(0, 1)), found);
  const auto angle = [&](double u) { return std::atan(wheelbase * sign * fit.curvature(u)); };
  found.of[kSteeringLeft] = angle(1.0);
  found.of[kSteeringRight] = angle(-1.0);
  found.of[kSteeringStraight] = angle(0.0);
  found.of[kSteeringLag] = fit.steering_lag;
  found.reverse_left = backwards;
  found.reverse_right = found.of[kSteeringLeft] <= found.of[kSteeringRight];
  return found;
}

std::vector<StraightSpeed> straightSpeeds(const std::vector<TimedCommand>& commands,
                                          const std::vector<TimedPose>& fixes,
                                          const WiringGeometry& geometry) {
  std::vector<StraightSpeed> speeds;
  const double delay = geometry.of[kDelay], lag = geometry.of[kLag];
  for (size_t i = 0, next = 0; i < commands.size(); i = next) {
    while (next < commands.size() && commands[next].command == commands[i].command) ++next;
    const TrackCommand real = ofRealSides(commands[i].command.tracks(), geometry);
    if (next == commands.size() || real.left != real.right || std::abs(real.left) < kFull) continue;
    const double held = 1e-6 * static_cast<double>(commands[next].utime - commands[i].utime);
    const double settle = std::min(kSettled * lag, held - kLeastSteady);
    if (settle < lag) continue;
    const int64_t begins = commands[i].utime + std::llround(1e6 * delay);
    const size_t from = fixAt(fixes, begins + std::llround(1e6 * settle));
    const size_t to = fixAt(fixes, begins + std::llround(1e6 * held));
    if (to >= fixes.size() || to <= from) continue;
    const double time = 1e-6 * static_cast<double>(fixes[to].utime - fixes[from].utime);
    if (time < 0.5 * kLeastSteady) continue;
    // The part of the speed that the lag still withholds.
    const double reached =
        1.0 - lag / time * std::exp(-settle / lag) * (1.0 - std::exp(-time / lag));
    const double speed =
        distanceBetween(fixes[from].T_map_body, fixes[to].T_map_body) / time / reached;
    const double turn = wrapAngle(fixes[to].T_map_body.yaw - fixes[from].T_map_body.yaw) / time;
    const double more = std::copysign(0.5 * turn * geometry.of[kWidth], real.left * turn);
    speeds.push_back({speed - more, speed + more});
  }
  return speeds;
}

}  // namespace tread::commissioning
