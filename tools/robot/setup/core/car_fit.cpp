// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/core/car_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace tread::setup {
namespace {

constexpr double kLeastCount = 10.0;
// Prior: a minute's drive outweighs it, a few seconds do not.
const Shape kUsualShape(0.1, 0.15, 0.05), kShapeSpread(0.08, 0.15, 0.08);
constexpr double kPlaceDoubt = 0.06;  // prior weight: (.05 m/s of noise over .2 m of position)^2
constexpr double kCurveDoubt = 0.09;  // prior weight: (.03 rad/s over .1 1/m of curvature)^2
constexpr double kSteeringLags[] = {0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.6};  // [s]

/// Mean of a series over [from, to] s, from its integral.
class Mean {
 public:
  explicit Mean(const std::vector<double>& series) : integral_(series.size() + 1, 0.0) {
    for (size_t i = 0; i < series.size(); ++i) integral_[i + 1] = integral_[i] + series[i];
  }
  double over(double from, double to) const { return (at(to) - at(from)) * kFitStep / (to - from); }

 private:
  double at(double time) const {
    const double place =
        std::clamp(time / kFitStep, 0.0, static_cast<double>(integral_.size() - 1));
    const size_t i = std::min(static_cast<size_t>(place), integral_.size() - 2);
    return integral_[i] + (place - static_cast<double>(i)) * (integral_[i + 1] - integral_[i]);
  }
  std::vector<double> integral_;
};

/// First-order lag, as the mean of each step.
std::vector<double> lagged(const std::vector<double>& series, double lag) {
  std::vector<double> out;
  const double decay = std::exp(-kFitStep / lag);
  double value = 0.0;
  for (const double target : series) {
    const double next = target + decay * (value - target);
    out.push_back(target + lag / kFitStep * (value - next));
    value = next;
  }
  return out;
}

}  // namespace

CarRows::CarRows(const std::vector<TimedCommand>& commands, const std::vector<TimedPose>& fixes)
    : rows_(motionRows(commands, fixes)) {
  for (const TrackCommand& command : heldCommands(commands, fixes)) {
    throttle_.push_back(command.left);
    steering_.push_back(command.right);
  }
}

std::vector<double> CarRows::throttleOf(const Shape& shape) const {
  std::vector<double> beyond, delayed;
  for (const double throttle : throttle_) beyond.push_back(beyondDead(throttle, shape[2]));
  for (size_t i = 0; i < beyond.size(); ++i) delayed.push_back(delayedAt(beyond, i, shape[0]));
  return lagged(delayed, shape[1]);
}

std::vector<double> CarRows::steeringOf(double delay, double lag) const {
  std::vector<double> delayed;
  for (size_t i = 0; i < steering_.size(); ++i) delayed.push_back(delayedAt(steering_, i, delay));
  return lagged(delayed, lag);
}

/// The velocity is along one direction, plus the contribution of turning at a point away from the
/// rear axle.
CarFit CarRows::drive(const Shape& shape, bool mirrored, const Use& use) const {
  CarFit fit;
  fit.shape = shape;
  const Mean throttle(throttleOf(shape));
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d product = Eigen::Matrix2d::Zero();  // of vx, vy with s, omega
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (size_t i = 0; i < rows_.size(); ++i) {
    if (!use(i)) continue;
    const Eigen::Vector3d seen = rows_[i].seen(mirrored);
    const Eigen::Vector2d by(throttle.over(rows_[i].from, rows_[i].to), seen.z());
    normal += by * by.transpose();
    product += seen.head<2>() * by.transpose();
    squares += seen.head<2>().cwiseProduct(seen.head<2>());
    count += 1.0;
  }
  if (count < kLeastCount || normal(0, 0) < 1e-6) return fit;
  normal(1, 1) += kPlaceDoubt;
  const Eigen::Matrix2d found = product * normal.inverse();
  fit.ahead = found.col(0);
  fit.place = {found(1, 1), -found(0, 1)};
  const Eigen::Vector2d left = squares - found.cwiseProduct(product).rowwise().sum();
  fit.velocity_rms = std::sqrt(std::max(0.0, left.sum()) / count);
  return fit;
}

void CarRows::turn(bool mirrored, const Use& use, CarFit& fit) const {
  const std::vector<double> s = throttleOf(fit.shape);
  const double speed = fit.ahead.norm();
  double least = -1.0;
  for (const double lag : kSteeringLags) {
    const std::vector<double> u = steeringOf(fit.shape[0], lag);
    std::vector<double> s_u(s.size()), s_uu(s.size());
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
      const MotionRow& row = rows_[i];
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
    if (least >= 0.0 && rms >= least) continue;
    least = fit.turn_rms = rms;
    fit.curve = curve;
    fit.steering_lag = lag;
  }
}

/// Negative log likelihood of a row.
double CarRows::costOf(const Shape& shape, bool mirrored, const Use& use) const {
  const double unusual = (shape - kUsualShape).cwiseQuotient(kShapeSpread).squaredNorm();
  return std::log(drive(shape, mirrored, use).velocity_rms + 1e-6) +
         0.5 * unusual / static_cast<double>(rows_.size());
}

CarFit CarRows::finished(const Shape& shape, bool mirrored, const Use& use) const {
  CarFit fit = drive(shape, mirrored, use);
  turn(mirrored, use, fit);
  return fit;
}

CarFit CarRows::fit(bool mirrored, const Use& use) const {
  if (rows_.empty()) return {};
  const auto cost = [&](const Shape& shape) { return costOf(shape, mirrored, use); };
  return finished(searchShape(cost), mirrored, use);
}

CarFit CarRows::refine(const CarFit& near, bool mirrored, const Use& use) const {
  if (rows_.empty()) return {};
  const auto cost = [&](const Shape& shape) { return costOf(shape, mirrored, use); };
  return finished(searchShape(near.shape, 0.008, cost), mirrored, use);
}

}  // namespace tread::setup
