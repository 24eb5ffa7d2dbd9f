// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/commissioning/core/wiring_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace tread::commissioning {
namespace {

constexpr double kStep = 0.01;     // [s] of integration
constexpr double kWindow = 0.1;    // [s] duration of a row
constexpr double kMostGap = 0.15;  // [s] largest gap between consecutive fixes
constexpr double kFinest = 0.001;  // resolution of the search, [s] and [1]
constexpr double kLeastCount = 10.0;
const Eigen::Vector3d kLeastShape(0.0, 0.005, 0.0), kMostShape(0.8, 1.5, 0.6);
// Of a car. Prior: a minute's drive outweighs it, a few seconds do not.
const Eigen::Vector3d kUsualShape(0.1, 0.15, 0.05), kShapeSpread(0.08, 0.15, 0.08);
constexpr double kPlaceDoubt = 0.06;  // prior weight: (.05 m/s of noise over .2 m of position)^2
constexpr double kCurveDoubt = 0.09;  // prior weight: (.03 rad/s over .1 1/m of curvature)^2
constexpr double kSteeringLags[] = {0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.6};  // [s]

using Series = std::vector<double>;

/// A delayed series; a delay between two steps is interpolated.
double delayedAt(const Series& held, size_t step, double delay) {
  const double back = static_cast<double>(step) - delay / kStep;
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

/// Command -> delay -> dead power -> first-order lag, as the mean of each step.
Series responseTo(const Series& held, double delay, double lag, double dead) {
  Series beyond, response;
  for (const double command : held)
    beyond.push_back(std::copysign(std::max(0.0, std::abs(command) - dead), command));
  const double decay = std::exp(-kStep / lag);
  double value = 0.0;
  for (size_t i = 0; i < beyond.size(); ++i) {
    const double target = delayedAt(beyond, i, delay);
    const double next = target + decay * (value - target);
    response.push_back(target + lag / kStep * (value - next));
    value = next;
  }
  return response;
}

/// Mean of a series over [from, to] s, from its integral.
class Mean {
 public:
  explicit Mean(const Series& series) : integral_(series.size() + 1, 0.0) {
    for (size_t i = 0; i < series.size(); ++i) integral_[i + 1] = integral_[i] + series[i];
  }
  double over(double from, double to) const { return (at(to) - at(from)) * kStep / (to - from); }

 private:
  double at(double time) const {
    const double place = std::clamp(time / kStep, 0.0, static_cast<double>(integral_.size() - 1));
    const size_t i = std::min(static_cast<size_t>(place), integral_.size() - 2);
    return integral_[i] + (place - static_cast<double>(i)) * (integral_[i + 1] - integral_[i]);
  }
  Series integral_;
};

using Cost = std::function<double(const Eigen::Vector3d& shape)>;

/// Local search for the least cost around `best`, with decreasing `step`.
/** Compass search; as delay and lag are correlated, it also moves along both. */
Eigen::Vector3d searchAround(Eigen::Vector3d best, double step, const Cost& cost) {
  using Shape = Eigen::Vector3d;
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

/// The same over the whole range of vehicles.
Eigen::Vector3d searchAll(const Cost& cost) {
  Eigen::Vector3d best = kUsualShape;
  double least = std::numeric_limits<double>::infinity();
  for (const double delay : {0.02, 0.1, 0.25})
    for (const double lag : {0.05, 0.15, 0.4})
      for (const double dead : {0.0, 0.15}) {
        const Eigen::Vector3d tried(delay, lag, dead);
        const double costs = cost(tried);
        if (costs >= least) continue;
        best = tried;
        least = costs;
      }
  return searchAround(best, 0.04, cost);
}

double secondsSince(int64_t start, int64_t utime) {
  return 1e-6 * static_cast<double>(utime - start);
}

}  // namespace

Eigen::Vector3d WiringRows::Row::seen(bool mirrored) const {
  const double at = mirrored ? -yaw : yaw;
  const double c = std::cos(at), s = std::sin(at);
  return {c * moved_map.x() + s * moved_map.y(), c * moved_map.y() - s * moved_map.x(),
          mirrored ? -turned : turned};
}

WiringRows::WiringRows(const std::vector<TimedCommand>& commands,
                       const std::vector<TimedPose>& fixes, bool car)
    : car_(car) {
  if (commands.empty() || fixes.empty()) return;
  hold(commands, fixes);
  addRows(commands.front().utime, fixes);
}

/// The command in force at each step, from the first command to the last fix.
void WiringRows::hold(const std::vector<TimedCommand>& commands,
                      const std::vector<TimedPose>& fixes) {
  const int64_t start = commands.front().utime;
  size_t at = 0;
  for (double t = 0.0; t < secondsSince(start, fixes.back().utime) + kStep; t += kStep) {
    while (at + 1 < commands.size() && secondsSince(start, commands[at + 1].utime) <= t) ++at;
    const TrackCommand held = commands[at].command.tracks();
    left_.push_back(held.left);
    right_.push_back(held.right);
  }
}

void WiringRows::addRows(int64_t start, const std::vector<TimedPose>& fixes) {
  const auto seconds = [&](size_t fix) { return secondsSince(start, fixes[fix].utime); };
  size_t first = 0;
  double turned = 0.0;
  for (size_t i = 1; i < fixes.size(); ++i) {
    if (seconds(i) - seconds(i - 1) > kMostGap || seconds(first) < 0.0) {
      first = i;
      turned = 0.0;
      continue;
    }
    turned += wrapAngle(fixes[i].T_map_body.yaw - fixes[i - 1].T_map_body.yaw);
    const Pose2& from = fixes[first].T_map_body;
    const double time = seconds(i) - seconds(first);
    if (time < kWindow - 1e-6) continue;
    rows_.push_back({seconds(first), seconds(i),
                     (fixes[i].T_map_body.position() - from.position()) / time,
                     from.yaw + 0.5 * turned, turned / time});
    first = i;
    turned = 0.0;
  }
}

/// Least squares of the motion for a shape.
WiringFit WiringRows::solve(const Shape& shape, bool mirrored, const Use& use) const {
  WiringFit fit;
  fit.delay = shape[0];
  fit.lag = shape[1];
  fit.dead = shape[2];
  const Mean left(responseTo(left_, shape[0], shape[1], shape[2]));
  const Mean right(car_ ? Series{} : responseTo(right_, shape[0], shape[1], shape[2]));
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 3, 2> product = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (size_t i = 0; i < rows_.size(); ++i) {
    if (!use(i)) continue;
    const Row& row = rows_[i];
    const Eigen::Vector3d seen = row.seen(mirrored);
    const Eigen::Vector2d by(left.over(row.from, row.to),
                             car_ ? seen.z() : right.over(row.from, row.to));
    normal += by * by.transpose();
    product += seen * by.transpose();
    squares += seen.cwiseProduct(seen);
    count += 1.0;
  }
  const bool moved = car_ ? normal(0, 0) >= 1e-6 : normal.determinant() >= 1e-9;
  if (count < kLeastCount || !moved) return fit;
  if (car_) normal(1, 1) += kPlaceDoubt;
  fit.response = product * normal.inverse();
  const Eigen::Vector3d rest = squares - fit.response.cwiseProduct(product).rowwise().sum();
  fit.velocity_rms = std::sqrt(std::max(0.0, rest[0] + rest[1]) / count);
  fit.turn_rms = std::sqrt(std::max(0.0, rest[2]) / count);
  return fit;
}

/// Negative log likelihood; each kind of residual is scaled by its own spread.
double WiringRows::costOf(const Shape& shape, bool mirrored, const Use& use) const {
  const WiringFit fit = solve(shape, mirrored, use);
  const double velocity = std::log(fit.velocity_rms + 1e-6);
  if (!car_) return 2.0 * velocity + std::log(fit.turn_rms + 1e-6);
  const double unusual = (shape - kUsualShape).cwiseQuotient(kShapeSpread).squaredNorm();
  return velocity + 0.5 * unusual / static_cast<double>(rows_.size());
}

/// Adds a car's turning: curvature over steering, at the best of the steering lags.
void WiringRows::steer(bool mirrored, const Use& use, WiringFit& fit) const {
  const Series s = responseTo(left_, fit.delay, fit.lag, fit.dead);
  const double speed = fit.ahead().norm();
  double least = std::numeric_limits<double>::infinity();
  fit.turn_rms = 0.0;
  for (const double lag : kSteeringLags) {
    const Series u = responseTo(right_, fit.delay, lag, 0.0);
    Series s_u(s.size()), s_uu(s.size());
    for (size_t i = 0; i < s.size(); ++i) {
      s_u[i] = s[i] * u[i];
      s_uu[i] = s_u[i] * u[i];
    }
    const Mean plain(s), linear(s_u), square(s_uu);
    Eigen::Matrix3d normal = Eigen::Vector3d(kCurveDoubt, 1e-6, kCurveDoubt).asDiagonal();
    Eigen::Vector3d product = Eigen::Vector3d::Zero();
    double squares = 0.0, count = 0.0;
    for (size_t i = 0; i < rows_.size(); ++i) {
      if (!use(i)) continue;
      const Row& row = rows_[i];
      const Eigen::Vector3d by =
          speed * Eigen::Vector3d(plain.over(row.from, row.to), linear.over(row.from, row.to),
                                  square.over(row.from, row.to));
      const double turned = row.seen(mirrored).z();
      normal += by * by.transpose();
      product += by * turned;
      squares += turned * turned;
      count += 1.0;
    }
    if (count < kLeastCount) return;
    const Eigen::Vector3d curve = normal.ldlt().solve(product);
    const double rms = std::sqrt(std::max(0.0, squares - curve.dot(product)) / count);
    if (rms >= least) continue;
    least = fit.turn_rms = rms;
    fit.curve = curve;
    fit.steering_lag = lag;
  }
}

WiringFit WiringRows::finished(const Shape& shape, bool mirrored, const Use& use) const {
  WiringFit fit = solve(shape, mirrored, use);
  if (car_) steer(mirrored, use, fit);
  return fit;
}

WiringFit WiringRows::fit(bool mirrored, const Use& use) const {
  if (rows_.empty()) return {};
  const auto cost = [&](const Shape& shape) { return costOf(shape, mirrored, use); };
  return finished(searchAll(cost), mirrored, use);
}

WiringFit WiringRows::refine(const WiringFit& near, bool mirrored, const Use& use) const {
  if (rows_.empty()) return {};
  const auto cost = [&](const Shape& shape) { return costOf(shape, mirrored, use); };
  return finished(searchAround({near.delay, near.lag, near.dead}, 0.008, cost), mirrored, use);
}

}  // namespace tread::commissioning
