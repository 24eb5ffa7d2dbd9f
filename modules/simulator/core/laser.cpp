// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/laser.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

namespace tread::sim {

Laser::Laser(const LaserParameters& parameters, uint64_t seed, int64_t start_utime)
    : parameters_(parameters), gaussian_(streamSeed(seed, 0)), dropouts_(streamSeed(seed, 1)) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  R_body_sensor_ = (AngleAxisd(parameters.yaw, Vector3d::UnitZ()) *
                    AngleAxisd(parameters.pitch, Vector3d::UnitY()) *
                    AngleAxisd(parameters.roll, Vector3d::UnitX()))
                       .toRotationMatrix();
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
  const Eigen::Vector3d p_map = body.p_map + body.R_map_body * parameters_.p_body;
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
