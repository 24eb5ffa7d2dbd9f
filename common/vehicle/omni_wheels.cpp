// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/omni_wheels.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace tread {
namespace {

/// Ratio of the least to the greatest singular value of J, its yaw column divided by the radius.
/// Three wheels at equal angles have 0.7; below this limit one direction costs ten times the rim
/// speed of another.
constexpr double kLeastSpan = 0.1;
constexpr int kDirections = 360;  // in which reach() looks

Eigen::Vector3d rowOf(const OmniWheel& wheel) {
  const double axis = wheel.heading + wheel.rollers;
  const Eigen::Vector3d row(std::cos(axis), std::sin(axis),
                            wheel.x * std::sin(axis) - wheel.y * std::cos(axis));
  return row / std::cos(wheel.rollers);
}

}  // namespace

CommandChannels omniChannels(CommandKind kind, size_t wheels) {
  const double limit = commandLimit(kind);
  CommandChannels channels;
  for (size_t i = 1; i <= wheels; ++i)
    channels.push_back({"wheel" + std::to_string(i), kind, -limit, limit});
  return channels;
}

std::optional<OmniWheels> OmniWheels::make(std::vector<OmniWheel> wheels, std::string& why) {
  if (wheels.size() < 3 || wheels.size() > Command::kMaxChannels) {
    why = std::to_string(wheels.size()) + (wheels.size() == 1 ? " wheel" : " wheels") +
          "; forward, sideways and yaw need 3 to " + std::to_string(Command::kMaxChannels);
    return std::nullopt;
  }
  OmniWheels omni;
  omni.wheels_ = std::move(wheels);
  const auto count = static_cast<Eigen::Index>(omni.size());
  Eigen::MatrixXd jacobian(count, 3);
  for (const OmniWheel& wheel : omni.wheels_) {
    const auto i = static_cast<Eigen::Index>(omni.rows_.size());
    omni.rows_.push_back(rowOf(wheel));
    jacobian.row(i) = omni.rows_.back();
  }
  const double radius = omni.radius();
  Eigen::MatrixXd scaled = jacobian;
  if (radius > 0.0) scaled.col(2) /= radius;
  // Squares of the singular values, in increasing order; decomposing `scaled` itself would take
  // seconds to compile.
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spans;
  spans.computeDirect(scaled.transpose() * scaled, Eigen::EigenvaluesOnly);
  if (!(spans.eigenvalues()[0] >= kLeastSpan * kLeastSpan * spans.eigenvalues()[2])) {
    why =
        "cannot move it forwards, sideways and turn it independently: change where the wheels "
        "stand or roll";
    return std::nullopt;
  }
  const Eigen::MatrixXd inverse =
      (jacobian.transpose() * jacobian).inverse() * jacobian.transpose();
  for (Eigen::Index i = 0; i < count; ++i) omni.columns_.emplace_back(inverse.col(i));
  return omni;
}

Command OmniWheels::speeds(const Twist2& v_body) const {
  const Eigen::Vector3d twist(v_body.v_x, v_body.v_y, v_body.omega);
  Command speeds;
  for (size_t i = 0; i < rows_.size(); ++i) speeds[i] = rows_[i].dot(twist);
  return speeds;
}

Twist2 OmniWheels::twist(const Command& speeds) const {
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < columns_.size(); ++i) twist += speeds[i] * columns_[i];
  return {twist[0], twist[1], twist[2]};
}

double OmniWheels::radius() const {
  double radius = 0.0;
  for (const OmniWheel& wheel : wheels_) radius = std::max(radius, std::hypot(wheel.x, wheel.y));
  return radius;
}

double OmniWheels::reach() const {
  double reach = 0.0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * kPi * k / kDirections;
    // Each wheel at its largest speed: the point moves by translation and rotation.
    const Eigen::Vector3d point(std::cos(angle), std::sin(angle), radius());
    double speed = 0.0;
    for (const Eigen::Vector3d& column : columns_) speed += std::abs(column.dot(point));
    reach = std::max(reach, speed);
  }
  return reach;
}

}  // namespace tread
