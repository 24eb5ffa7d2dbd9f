// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/twist_test.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace tread::learner {
namespace {

constexpr double kSameTime = 1e-6;  // [s]

Eigen::Vector3d asVector(const Twist2& twist) {
  return {twist.v_x, twist.v_y, twist.omega};
}

bool isFinitePose(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
}

}  // namespace

Eigen::Matrix3d twistCovariance(const Pose2& end, const PoseCovariance& covariance,
                                double seconds) {
  Eigen::Matrix3d P;
  P << covariance[0], covariance[1], covariance[2], covariance[1], covariance[3], covariance[4],
      covariance[2], covariance[4], covariance[5];
  const Eigen::Vector3d mean = asVector(twistTo(end, seconds));
  constexpr double kStep = 1e-6;  // [m/s, rad/s]
  Eigen::Matrix3d J;
  for (Eigen::Index i = 0; i < 3; ++i) {
    Eigen::Vector3d ahead = mean, back = mean;
    ahead[i] += kStep;
    back[i] -= kStep;
    const Pose2 a = integrate({ahead[0], ahead[1], ahead[2]}, seconds);
    const Pose2 b = integrate({back[0], back[1], back[2]}, seconds);
    J.col(i) << (a.x - b.x) / (2.0 * kStep), (a.y - b.y) / (2.0 * kStep),
        (a.yaw - b.yaw) / (2.0 * kStep);
  }
  // After a whole turn the end says nothing of the way.
  if (std::abs(J.determinant()) < 1e-3 * std::pow(seconds, 3.0)) return P / (seconds * seconds);
  const Eigen::Matrix3d inverse = J.inverse();
  return inverse * P * inverse.transpose();
}

double chiSquare3(double probability) {
  double low = 0.0, high = 200.0;
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (low + high);
    const double exceeds =
        std::erfc(std::sqrt(0.5 * x)) + std::sqrt(2.0 * x / kPi) * std::exp(-0.5 * x);
    (exceeds > probability ? low : high) = x;
  }
  return 0.5 * (low + high);
}

TwistTest::TwistTest(const TwistTestLimits& limits)
    : limits_(limits), threshold_(chiSquare3(limits.chance)) {}

void TwistTest::begin(const std::vector<Pose2>& predicted, const PoseCovariance& end,
                      double period) {
  predicted_ = predicted;
  period_ = period;
  next_ = 0;
  last_ = {};
  V_ = Eigen::Matrix3d::Constant(kUnknown);
  if (!predicted.empty())
    V_ = twistCovariance(predicted.back(), end, period * static_cast<double>(predicted.size()));
}

bool TwistTest::add(const Pose2& T_start_body) {
  if (!isFinitePose(T_start_body) || next_ >= predicted_.size()) {
    clear();
    return false;
  }
  const Pose2 before = next_ == 0 ? Pose2{} : predicted_[next_ - 1];
  steps_.push_back({between(last_, T_start_body), between(before, predicted_[next_]), V_,
                    period_ * static_cast<double>(predicted_.size()), period_});
  last_ = T_start_body;
  ++next_;
  seconds_ += period_;
  while (seconds_ - steps_.front().period > limits_.window - kSameTime) {
    seconds_ -= steps_.front().period;
    steps_.pop_front();
  }
  statistic_ = seconds_ > limits_.window - kSameTime ? statisticOfWindow() : kUnknown;
  far_ = statistic_ > threshold_ ? far_ + 1 : 0;
  return far_ >= limits_.in_a_row;
}

void TwistTest::clear() {
  steps_.clear();
  seconds_ = 0.0;
  statistic_ = kUnknown;
  far_ = 0;
}

double TwistTest::statisticOfWindow() const {
  Pose2 measured, predicted;
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  for (const Step& step : steps_) {
    measured = measured * step.measured;
    predicted = predicted * step.predicted;
    S += step.V * std::max(1.0, step.pattern / seconds_) * (step.period / seconds_);
  }
  const Eigen::Vector3d noise(limits_.position, limits_.position, limits_.heading);
  S.diagonal() += 2.0 * noise.cwiseAbs2() / (seconds_ * seconds_);
  if (!S.allFinite()) return kUnknown;
  const Eigen::Vector3d d =
      asVector(twistTo(measured, seconds_)) - asVector(twistTo(predicted, seconds_));
  const Eigen::LDLT<Eigen::Matrix3d> root(S);
  if (root.info() != Eigen::Success || !(root.vectorD().minCoeff() > 0.0)) return kUnknown;
  return d.dot(root.solve(d));
}

}  // namespace tread::learner
