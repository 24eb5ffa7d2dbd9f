// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/twist_line.hpp"

#include "common/recordings/sessions.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "common/statistics/statistics.hpp"

namespace tread::recordings {
namespace {

constexpr int kIterations = 30;
constexpr double kHuber = 1.345;  // 95 % efficiency for normal errors

/// Length of each observation's residual, per row.
Eigen::VectorXd lengths(const Eigen::VectorXd& residuals, int group) {
  const Eigen::Index count = residuals.size() / group;
  Eigen::VectorXd result(count);
  for (Eigen::Index i = 0; i < count; ++i)
    result[i] = residuals.segment(i * group, group).norm() / std::sqrt(group);
  return result;
}

double scaleOf(const Eigen::VectorXd& length, const Eigen::VectorXd& prior, double least) {
  std::vector<double> counted;
  for (Eigen::Index i = 0; i < length.size(); ++i)
    if (prior[i] > 0.0) counted.push_back(length[i]);
  return std::max(least, kMadToSigma * medianOf(std::move(counted), 0.0));
}

constexpr double kMaxGap = 0.4;          // [s] between poses, and to either end of the window
constexpr int kMinPoses = 5;             // in a window
constexpr double kYawNoise = 0.005;      // [rad] lower limit of the residual scale
constexpr double kPositionNoise = 0.01;  // [m] the same
constexpr double kFineStep = 0.01;       // [s] of the numerical integral

/// Integrals from 0 to t of (cos yaw, sin yaw) and of (s - T/2) times them.
struct HeadingIntegrals {
  double cosine = 0.0, sine = 0.0, timed_cosine = 0.0, timed_sine = 0.0;
};

/// yaw(t) = c_0 + c_1 (t - T/2) + c_2 (t - T/2)^2.
double yawAt(const Eigen::VectorXd& c, double centred) {
  return c[0] + centred * (c[1] + centred * c[2]);
}

Eigen::VectorXd fitYaw(const std::vector<PoseSample>& poses, double duration) {
  const auto n = static_cast<Eigen::Index>(poses.size());
  Eigen::MatrixXd A(n, 3);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PoseSample& pose = poses[static_cast<size_t>(i)];
    const double centred = pose.time - duration / 2.0;
    A.row(i) << 1.0, centred, centred * centred;
    b[i] = pose.T_map_body.yaw;
  }
  return huberFit(A, b, Eigen::VectorXd::Ones(n), {1, kYawNoise});
}

/// Integrals from 0 to t of (cos yaw, sin yaw) and of (s - T/2) times these.
void advance(HeadingIntegrals& integrals, const Eigen::VectorXd& yaw, double from, double to,
             double duration) {
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / kFineStep)));
  const double h = (to - from) / steps;
  for (int i = 0; i < steps; ++i) {
    const double centred = from + (i + 0.5) * h - duration / 2.0;
    const double c = std::cos(yawAt(yaw, centred));
    const double s = std::sin(yawAt(yaw, centred));
    integrals.cosine += h * c;
    integrals.sine += h * s;
    integrals.timed_cosine += h * centred * c;
    integrals.timed_sine += h * centred * s;
  }
}

/// p_0, v_x, v_x', v_y, v_y' as a vector of six.
Eigen::VectorXd fitPosition(const std::vector<PoseSample>& poses, const Eigen::VectorXd& yaw,
                            double duration) {
  const auto n = static_cast<Eigen::Index>(poses.size());
  Eigen::MatrixXd A(2 * n, 6);
  Eigen::VectorXd b(2 * n);
  HeadingIntegrals k;
  double reached = poses.front().time;
  for (Eigen::Index i = 0; i < n; ++i) {
    const PoseSample& pose = poses[static_cast<size_t>(i)];
    advance(k, yaw, reached, pose.time, duration);
    reached = pose.time;
    A.row(2 * i) << 1.0, 0.0, k.cosine, k.timed_cosine, -k.sine, -k.timed_sine;
    A.row(2 * i + 1) << 0.0, 1.0, k.sine, k.timed_sine, k.cosine, k.timed_cosine;
    b.segment<2>(2 * i) = pose.T_map_body.position() - poses.front().T_map_body.position();
  }
  return huberFit(A, b, Eigen::VectorXd::Ones(n), {2, kPositionNoise});
}

std::string hundredths(double value) {
  const std::string text = std::to_string(std::round(value * 100.0) / 100.0);
  return text.substr(0, text.find('.') + 3);
}

}  // namespace

Eigen::VectorXd huberFit(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                         const Eigen::VectorXd& prior, const HuberLimits& limits) {
  Eigen::VectorXd weight = prior;
  Eigen::VectorXd x;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::VectorXd root(A.rows());
    for (Eigen::Index row = 0; row < A.rows(); ++row)
      root[row] = std::sqrt(weight[row / limits.group]);
    x = (root.asDiagonal() * A).colPivHouseholderQr().solve(root.cwiseProduct(b));
    const Eigen::VectorXd length = lengths(A * x - b, limits.group);
    const double bound = kHuber * scaleOf(length, prior, limits.least_scale);
    for (Eigen::Index i = 0; i < weight.size(); ++i)
      weight[i] = prior[i] * (length[i] > bound ? bound / length[i] : 1.0);
  }
  return x;
}

Eigen::Matrix<double, 6, 1> TwistLine::vector() const {
  Eigen::Matrix<double, 6, 1> all;
  all << mean.v_x, mean.v_y, mean.omega, slope.v_x, slope.v_y, slope.omega;
  return all;
}

TwistLine TwistLine::of(const Eigen::Matrix<double, 6, 1>& vector) {
  return {{vector[0], vector[1], vector[2]}, {vector[3], vector[4], vector[5]}};
}

Twist2 TwistLine::at(double time, double duration) const {
  const double centred = time - duration / 2.0;
  return {mean.v_x + centred * slope.v_x, mean.v_y + centred * slope.v_y,
          mean.omega + centred * slope.omega};
}

TwistLine TwistLine::mirrored() const {
  return {{mean.v_x, -mean.v_y, -mean.omega}, {slope.v_x, -slope.v_y, -slope.omega}};
}

std::string windowProblem(const std::vector<PoseSample>& poses, double duration) {
  double last = 0.0;
  double gap = 0.0;
  for (const PoseSample& pose : poses) {
    gap = std::max(gap, pose.time - last);
    last = pose.time;
  }
  gap = std::max(gap, duration - last);
  if (gap > kMaxGap + 1e-9) return "no new pose for more than " + hundredths(kMaxGap) + " s";
  if (static_cast<int>(poses.size()) < kMinPoses)
    return "fewer than " + std::to_string(kMinPoses) + " poses";
  return "";
}

TwistLine smoothed(const std::vector<PoseSample>& poses, double duration) {
  const Eigen::VectorXd yaw = fitYaw(poses, duration);
  const Eigen::VectorXd motion = fitPosition(poses, yaw, duration);
  return {{motion[2], motion[4], yaw[1]}, {motion[3], motion[5], 2.0 * yaw[2]}};
}

std::vector<Pose2> integrated(const TwistLine& profile, size_t samples, double period) {
  const double duration = static_cast<double>(samples) * period;
  std::vector<Pose2> trajectory;
  trajectory.reserve(samples);
  Pose2 pose;
  for (size_t i = 0; i < samples; ++i) {
    const double middle = (static_cast<double>(i) + 0.5) * period;
    pose = pose * integrate(profile.at(middle, duration), period);
    trajectory.push_back(pose);
  }
  return trajectory;
}

}  // namespace tread::recordings
