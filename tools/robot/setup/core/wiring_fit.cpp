// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/core/wiring_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tread::setup {
namespace {

constexpr double kWindow = 0.1;    // [s] duration of a row
constexpr double kMostGap = 0.15;  // [s] largest gap between consecutive fixes
constexpr double kFinest = 0.001;  // resolution of the search, [s] and [1]
const Eigen::Vector3d kLeastShape(0.0, 0.005, 0.0), kMostShape(0.8, 1.5, 0.6);

}  // namespace

double beyondDead(double command, double dead) {
  return std::copysign(std::max(0.0, std::abs(command) - dead), command);
}

double delayedAt(const std::vector<double>& held, size_t step, double delay) {
  const double back = static_cast<double>(step) - delay / kFitStep;
  const double floor = std::floor(back);
  double value = 0.0;
  for (const int k : {0, 1}) {
    const double index = floor + k;
    if (index < 0.0) continue;
    const double share = k == 0 ? 1.0 - (back - floor) : back - floor;
    value += share * held[std::min(held.size() - 1, static_cast<size_t>(index))];
  }
  return value;
}

Eigen::Vector3d MotionRow::seen(bool mirrored) const {
  const double at = mirrored ? -yaw : yaw;
  const double c = std::cos(at), s = std::sin(at);
  return {c * moved_map.x() + s * moved_map.y(), c * moved_map.y() - s * moved_map.x(),
          mirrored ? -turned : turned};
}

std::vector<TrackCommand> heldCommands(const std::vector<TimedCommand>& commands,
                                       const std::vector<TimedPose>& fixes) {
  std::vector<TrackCommand> held;
  if (commands.empty() || fixes.empty()) return held;
  const int64_t start = commands.front().utime;
  const auto seconds = [start](int64_t utime) { return 1e-6 * static_cast<double>(utime - start); };
  size_t at = 0;
  for (double t = 0.0; t < seconds(fixes.back().utime) + kFitStep; t += kFitStep) {
    while (at + 1 < commands.size() && seconds(commands[at + 1].utime) <= t) ++at;
    held.push_back(commands[at].command.tracks());
  }
  return held;
}

std::vector<MotionRow> motionRows(const std::vector<TimedCommand>& commands,
                                  const std::vector<TimedPose>& fixes) {
  std::vector<MotionRow> rows;
  if (commands.empty() || fixes.empty()) return rows;
  const int64_t start = commands.front().utime;
  const auto seconds = [start](int64_t utime) { return 1e-6 * static_cast<double>(utime - start); };
  size_t first = 0;
  double turned = 0.0;
  for (size_t i = 1; i < fixes.size(); ++i) {
    const double step = seconds(fixes[i].utime) - seconds(fixes[i - 1].utime);
    if (step > kMostGap || seconds(fixes[first].utime) < 0.0) {
      first = i;
      turned = 0.0;
      continue;
    }
    turned += wrapAngle(fixes[i].T_map_body.yaw - fixes[i - 1].T_map_body.yaw);
    const Pose2& from = fixes[first].T_map_body;
    const double time = seconds(fixes[i].utime) - seconds(fixes[first].utime);
    if (time < kWindow - 1e-6) continue;
    rows.push_back({seconds(fixes[first].utime), seconds(fixes[i].utime),
                    (fixes[i].T_map_body.position() - from.position()) / time,
                    from.yaw + 0.5 * turned, turned / time});
    first = i;
    turned = 0.0;
  }
  return rows;
}

WiringRows::WiringRows(const std::vector<TimedCommand>& commands,
                       const std::vector<TimedPose>& fixes)
    : held_(heldCommands(commands, fixes)), rows_(motionRows(commands, fixes)) {}

/// Integral of s up to each step [s].
std::vector<Eigen::Vector2d> WiringRows::integralOf(const Eigen::Vector3d& shape) const {
  std::vector<Eigen::Vector2d> integral(held_.size() + 1, Eigen::Vector2d::Zero());
  Eigen::Vector2d speed = Eigen::Vector2d::Zero();
  const double decay = std::exp(-kFitStep / shape[1]);
  for (size_t i = 0; i < held_.size(); ++i) {
    // A delay between two steps is interpolated.
    const double back = static_cast<double>(i) - shape[0] / kFitStep;
    const double floor = std::floor(back);
    Eigen::Vector2d target = Eigen::Vector2d::Zero();
    for (const int k : {0, 1}) {
      const double index = floor + k;
      if (index < 0.0) continue;
      const TrackCommand& command = held_[std::min(held_.size() - 1, static_cast<size_t>(index))];
      const double share = k == 0 ? 1.0 - (back - floor) : back - floor;
      target += share * Eigen::Vector2d(beyondDead(command.left, shape[2]),
                                        beyondDead(command.right, shape[2]));
    }
    const Eigen::Vector2d next = target + decay * (speed - target);
    integral[i + 1] = integral[i] + kFitStep * target + shape[1] * (speed - next);
    speed = next;
  }
  return integral;
}

WiringFit WiringRows::solve(const Eigen::Vector3d& shape, bool mirrored, const Use& use) const {
  const std::vector<Eigen::Vector2d> integral = integralOf(shape);
  const auto passed = [&](double time) -> Eigen::Vector2d {
    const double at = std::clamp(time / kFitStep, 0.0, static_cast<double>(integral.size() - 1));
    const size_t i = std::min(static_cast<size_t>(at), integral.size() - 2);
    return integral[i] + (at - static_cast<double>(i)) * (integral[i + 1] - integral[i]);
  };
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 3, 2> product = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (size_t i = 0; i < rows_.size(); ++i) {
    if (!use(i)) continue;
    const MotionRow& row = rows_[i];
    const Eigen::Vector2d s = (passed(row.to) - passed(row.from)) / (row.to - row.from);
    const Eigen::Vector3d seen = row.seen(mirrored);
    normal += s * s.transpose();
    product += seen * s.transpose();
    squares += seen.cwiseProduct(seen);
    count += 1.0;
  }
  WiringFit fit;
  fit.delay = shape[0];
  fit.lag = shape[1];
  fit.dead = shape[2];
  const double determinant = normal.determinant();
  if (count < 10.0 || determinant < 1e-9) return fit;
  Eigen::Matrix2d inverted;
  inverted << normal(1, 1), -normal(0, 1), -normal(1, 0), normal(0, 0);
  fit.response = product * inverted / determinant;
  const Eigen::Vector3d left = squares - fit.response.cwiseProduct(product).rowwise().sum();
  fit.velocity_rms = std::sqrt(std::max(0.0, left[0] + left[1]) / count);
  fit.turn_rms = std::sqrt(std::max(0.0, left[2]) / count);
  return fit;
}

/// Negative log likelihood; each kind of residual is scaled by its own spread.
double WiringRows::costOf(const WiringFit& fit) const {
  return 2.0 * std::log(fit.velocity_rms + 1e-6) + std::log(fit.turn_rms + 1e-6);
}

Shape searchShape(Shape best, double step, const std::function<double(const Shape&)>& cost) {
  static const std::array<Shape, 5> kDirections{Shape(1, 0, 0), Shape(0, 1, 0), Shape(0, 0, 1),
                                                Shape(1, -1, 0), Shape(0, 1, 1)};
  double least = cost(best);
  while (step >= kFinest) {
    bool better = false;
    for (const Shape& direction : kDirections)
      for (const double sign : {1.0, -1.0}) {
        const Shape tried =
            (best + sign * step * direction).cwiseMax(kLeastShape).cwiseMin(kMostShape);
        const double costs = cost(tried);
        if (costs >= least - 1e-9) continue;
        best = tried;
        least = costs;
        better = true;
      }
    if (!better) step /= 2.0;
  }
  return best;
}

Shape searchShape(const std::function<double(const Shape&)>& cost) {
  std::optional<Shape> best;
  double least = 0.0;
  for (const double delay : {0.02, 0.1, 0.25})
    for (const double lag : {0.05, 0.15, 0.4})
      for (const double dead : {0.0, 0.15}) {
        const Shape tried(delay, lag, dead);
        const double costs = cost(tried);
        if (best && costs >= least) continue;
        best = tried;
        least = costs;
      }
  return searchShape(*best, 0.04, cost);
}

WiringFit WiringRows::fit(bool mirrored, const Use& use) const {
  if (rows_.empty()) return {};
  const auto cost = [&](const Shape& shape) { return costOf(solve(shape, mirrored, use)); };
  return solve(searchShape(cost), mirrored, use);
}

WiringFit WiringRows::refine(const WiringFit& near, bool mirrored, const Use& use) const {
  if (rows_.empty()) return {};
  const auto cost = [&](const Shape& shape) { return costOf(solve(shape, mirrored, use)); };
  return solve(searchShape({near.delay, near.lag, near.dead}, 0.008, cost), mirrored, use);
}

}  // namespace tread::setup
