// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/ins.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace tread::sim {
namespace {

OrnsteinUhlenbeck biasProcess(const InsParameters& parameters, Gaussian& gaussian) {
  return {parameters.bias_time, static_cast<double>(parameters.period_us) * 1e-6, gaussian};
}

}  // namespace

Ins::Ins(const InsParameters& parameters, uint64_t seed, int64_t start_utime)
    : parameters_(parameters),
      at_origin_(parameters.p_body.isZero(0.0) && parameters.yaw == 0.0 &&
                 parameters.pitch == 0.0 && parameters.roll == 0.0),
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
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  truth.body.p_map += truth.body.R_map_body * parameters_.p_body;
  truth.v_body += truth.rate_body.cross(parameters_.p_body);
  const Eigen::Matrix3d R_body_device = (AngleAxisd(parameters_.yaw, Vector3d::UnitZ()) *
                                         AngleAxisd(parameters_.pitch, Vector3d::UnitY()) *
                                         AngleAxisd(parameters_.roll, Vector3d::UnitX()))
                                            .toRotationMatrix();
  const Eigen::Matrix3d R = truth.body.R_map_body * R_body_device;
  truth.v_body = R_body_device.transpose() * truth.v_body;
  truth.yaw += wrapAngle(std::atan2(R(1, 0), R(0, 0)) - truth.yaw);
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
  InsSample sample;
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

std::vector<InsSample> Ins::takeSamples(int64_t utime) {
  std::vector<InsSample> out;
  while (!pending_.empty() && pending_.front().utime + parameters_.latency_us <= utime) {
    out.push_back(pending_.front());
    pending_.pop_front();
  }
  return out;
}

}  // namespace tread::sim
