// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/local_frame.hpp"

#include <cmath>

#include "common/geometry/se2.hpp"

namespace tread::ins {
namespace {

constexpr double kDegPerRad = 180.0 / kPi;

}  // namespace

LocalFrame::LocalFrame(const GeoOrigin& origin)
    : origin_(origin),
      cartesian_(origin.point.latitude * kDegPerRad, origin.point.longitude * kDegPerRad,
                 origin.altitude) {}

Eigen::Vector3d LocalFrame::toMap(const GeoPoint& point, double altitude) const {
  double east = 0.0;
  double north = 0.0;
  double up = 0.0;
  cartesian_.Forward(point.latitude * kDegPerRad, point.longitude * kDegPerRad, altitude, east,
                     north, up);
  const double c = std::cos(origin_.yaw);
  const double s = std::sin(origin_.yaw);
  return {c * east + s * north, c * north - s * east, up};
}

}  // namespace tread::ins
