// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/position_memory.hpp"

#include <cmath>

namespace tread::ins {
namespace {

constexpr int64_t kMaxBaseUs = 250'000;
/// Of a velocity whose accuracy the device does not report [m/s].
constexpr double kUsualVelocityStd = 0.1;

}  // namespace

void PositionMemory::add(int64_t utime, const PointInMap& point,
                         const std::optional<Eigen::Vector2d>& velocity, double velocity_std) {
  const int64_t base_us = utime - utime_;
  velocity_ = velocity;
  velocity_std_ = std::isfinite(velocity_std) ? velocity_std : kUsualVelocityStd;
  if (!velocity && newest_ && base_us > 0 && base_us <= kMaxBaseUs) {
    const double base = static_cast<double>(base_us) * 1e-6;
    velocity_ = (point.p_map - newest_->p_map).head<2>() / base;
    velocity_std_ = std::hypot(point.std.x(), newest_->std.x()) / base;
  }
  newest_ = point;
  utime_ = utime;
}

std::optional<PointInMap> PositionMemory::at(int64_t utime) const {
  const int64_t age_us = utime - utime_;
  if (!newest_ || !velocity_ || age_us < 0 || age_us > hold_us_) return std::nullopt;
  const double age = static_cast<double>(age_us) * 1e-6;
  PointInMap point = *newest_;
  point.p_map.head<2>() += *velocity_ * age;
  for (int axis = 0; axis < 3; ++axis)
    point.std[axis] = std::hypot(point.std[axis], velocity_std_ * age);
  return point;
}

}  // namespace tread::ins
