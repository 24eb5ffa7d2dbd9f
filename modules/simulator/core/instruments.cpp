// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/instruments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

namespace tread::sim {
namespace {

OrnsteinUhlenbeck biasProcess(const InsParameters& parameters, Gaussian& gaussian) {
  return {parameters.bias_time, static_cast<double>(parameters.period_us) * 1e-6, gaussian};
}

/// R = Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Matrix3d rotationOf(const YawPitchRoll& angles) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(angles.yaw, Vector3d::UnitZ()) * AngleAxisd(angles.pitch, Vector3d::UnitY()) *
          AngleAxisd(angles.roll, Vector3d::UnitX()))
      .toRotationMatrix();
}

bool isAtOrigin(const Mounting& mounting) {
  const YawPitchRoll& angles = mounting.angles;
  return mounting.p_body.isZero(0.0) && angles.yaw == 0.0 && angles.pitch == 0.0 &&
         angles.roll == 0.0;
}

}  // namespace

BodyPose poseOnGround(const Pose2& T_map_body, double height, const Eigen::Vector2d& gradient) {
  const Eigen::Vector2d heading(std::cos(T_map_body.yaw), std::sin(T_map_body.yaw));
  const Eigen::Vector3d up = Eigen::Vector3d(-gradient.x(), -gradient.y(), 1.0).normalized();
  const Eigen::Vector3d forward =
      Eigen::Vector3d(heading.x(), heading.y(), gradient.dot(heading)).normalized();
  const Eigen::Vector3d left = up.cross(forward);
  BodyPose body;
  body.p_map = {T_map_body.x, T_map_body.y, height};
  body.R_map_body.col(0) = forward;
  body.R_map_body.col(1) = left;
  body.R_map_body.col(2) = up;
  body.pitch = -std::asin(std::clamp(forward.z(), -1.0, 1.0));
  body.roll = std::atan2(left.z(), up.z());
  return body;
}

Ins::Ins(const InsParameters& parameters, uint64_t seed, int64_t start_utime)
    : parameters_(parameters),
      at_origin_(isAtOrigin(parameters.mounting)),
      gaussian_(seed),
      bias_x_(biasProcess(parameters, gaussian_)),
      bias_y_(biasProcess(parameters, gaussian_)),
      bias_yaw_(biasProcess(parameters, gaussian_)),
      next_(start_utime) {}

Eigen::Vector3d Ins::noise3(double sigma) {
  const double x = gaussian_.draw();
  const double y = gaussian_.draw();
  const double z = gaussian_.draw();
  return sigma * Eigen::Vector3d(x, y, z);
}

InsInput Ins::atInstrument(InsInput truth) const {
  if (at_origin_) return truth;
  const Eigen::Vector3d& p_body = parameters_.mounting.p_body;
  truth.body.p_map += truth.body.R_map_body * p_body;
  truth.v_body += truth.rate_body.cross(p_body);
  const Eigen::Matrix3d R_body_device = rotationOf(parameters_.mounting.angles);
  const Eigen::Matrix3d R = truth.body.R_map_body * R_body_device;
  // It reports its velocity over the ground in any attitude, and its rates about its own axes.
  const Eigen::Vector3d v_map = truth.body.R_map_body * truth.v_body;
  truth.rate_body = R_body_device.transpose() * truth.rate_body;
  truth.yaw += wrapAngle(std::atan2(R(1, 0), R(0, 0)) - truth.yaw);
  truth.v_body = Eigen::AngleAxisd(-truth.yaw, Eigen::Vector3d::UnitZ()) * v_map;
  truth.body.pitch = -std::asin(R(2, 0));
  truth.body.roll = std::atan2(R(2, 1), R(2, 2));
  return truth;
}

void Ins::measure(int64_t utime, const InsInput& of_body) {
  const InsInput truth = atInstrument(of_body);
  next_ += parameters_.period_us;
  bias_x_.step(gaussian_);
  bias_y_.step(gaussian_);
  bias_yaw_.step(gaussian_);
  InsMeasurement sample;
  sample.utime = utime;
  sample.p_map = truth.body.p_map + noise3(parameters_.position_noise);
  sample.p_map.x() += parameters_.position_bias * bias_x_.value();
  sample.p_map.y() += parameters_.position_bias * bias_y_.value();
  sample.p_map.z() = truth.body.p_map.z() + parameters_.height_noise * gaussian_.draw();
  sample.yaw = truth.yaw + parameters_.heading_noise * gaussian_.draw() +
               parameters_.heading_bias * bias_yaw_.value();
  sample.pitch = truth.body.pitch + parameters_.attitude_noise * gaussian_.draw();
  sample.roll = truth.body.roll + parameters_.attitude_noise * gaussian_.draw();
  sample.v_body = truth.v_body + noise3(parameters_.velocity_noise);
  sample.rate_body = truth.rate_body + noise3(parameters_.rate_noise);
  pending_.push_back(sample);
}

std::vector<InsMeasurement> Ins::takeSamples(int64_t utime) {
  std::vector<InsMeasurement> out;
  while (!pending_.empty() && pending_.front().utime + parameters_.latency_us <= utime) {
    out.push_back(pending_.front());
    pending_.pop_front();
  }
  return out;
}

Laser::Laser(const LaserParameters& parameters, uint64_t seed, int64_t start_utime)
    : parameters_(parameters),
      R_body_sensor_(rotationOf(parameters.mounting.angles)),
      gaussian_(streamSeed(seed, 0)),
      dropouts_(streamSeed(seed, 1)) {
  current_.angle_min = -parameters.field_of_view / 2.0;
  current_.angle_step = parameters.field_of_view / (parameters.beams - 1);
  for (int i = 0; i < parameters.beams; ++i) {
    const double angle = current_.angle_min + i * current_.angle_step;
    directions_.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  startSweep(start_utime);
}

void Laser::startSweep(int64_t utime) {
  current_.utime = utime;
  current_.sweep_us = parameters_.sweep_us;
  current_.ranges.clear();
  current_.ranges.reserve(directions_.size());
}

int64_t Laser::beamTime(int beam) const {
  return current_.utime + parameters_.sweep_us * beam / (parameters_.beams - 1);
}

void Laser::advanceTo(int64_t utime, const World& world, const BodyPose& body) {
  if (utime < beamTime(static_cast<int>(current_.ranges.size()))) return;
  const Eigen::Vector3d p_map = body.p_map + body.R_map_body * parameters_.mounting.p_body;
  const Eigen::Matrix3d R_map_sensor = body.R_map_body * R_body_sensor_;
  int beam = static_cast<int>(current_.ranges.size());
  while (beam < parameters_.beams && beamTime(beam) <= utime)
    current_.ranges.push_back(measure(world, p_map, R_map_sensor, beam++));
  if (beam < parameters_.beams) return;
  finished_.push_back(current_);
  startSweep(current_.utime + parameters_.period_us);
}

float Laser::measure(const World& world, const Eigen::Vector3d& p_map,
                     const Eigen::Matrix3d& R_map_sensor, int beam) {
  constexpr float kNothing = std::numeric_limits<float>::infinity();
  constexpr float kNoMeasurement = std::numeric_limits<float>::quiet_NaN();
  const Eigen::Vector3d direction = R_map_sensor * directions_[static_cast<size_t>(beam)];
  const auto distance = world.castRay(p_map, direction, parameters_.range_max);
  if (!distance) return kNothing;
  if (parameters_.dropout > 0.0 &&
      static_cast<double>(dropouts_() >> 11) * 0x1.0p-53 < parameters_.dropout) {
    return kNoMeasurement;
  }
  const double measured = *distance + parameters_.range_noise * gaussian_.draw();
  if (measured < parameters_.range_min) return kNoMeasurement;
  if (measured > parameters_.range_max) return kNothing;
  return static_cast<float>(measured);
}

std::vector<LaserScan> Laser::takeScans() {
  return std::exchange(finished_, {});
}

}  // namespace tread::sim
