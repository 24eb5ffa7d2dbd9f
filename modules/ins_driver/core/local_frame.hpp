// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <GeographicLib/LocalCartesian.hpp>

#include "common/geometry/se2.hpp"

namespace tread::ins {

/// A point on the WGS84 ellipsoid [rad].
struct GeoPoint {
  double latitude = 0.0;   ///< north positive
  double longitude = 0.0;  ///< east positive
};

/// Where the map frame lies on the Earth.
struct GeoOrigin {
  GeoPoint point;         ///< WGS84 [rad]
  double altitude = 0.0;  ///< above mean sea level [m]
  double yaw = 0.0;       ///< direction of the map's x axis, counter-clockwise from east [rad]
};

/// The map frame as a plane that touches the Earth at the origin.
/** Heights are above mean sea level throughout: not every device tells the geoid separation, and
   leaving it out scales the plane by less than 2e-5 (100 m of 6378 km). */
class LocalFrame {
 public:
  explicit LocalFrame(const GeoOrigin& origin)
      : origin_(origin),
        cartesian_(origin.point.latitude * kDegPerRad, origin.point.longitude * kDegPerRad,
                   origin.altitude) {}

  /// p_map of a point [m].
  Eigen::Vector3d toMap(const GeoPoint& point, double altitude) const {
    double east = 0.0, north = 0.0, up = 0.0;
    cartesian_.Forward(point.latitude * kDegPerRad, point.longitude * kDegPerRad, altitude, east,
                       north, up);
    const double c = std::cos(origin_.yaw);
    const double s = std::sin(origin_.yaw);
    return {c * east + s * north, c * north - s * east, up};
  }
  const GeoOrigin& origin() const { return origin_; }

 private:
  static constexpr double kDegPerRad = 180.0 / kPi;

  GeoOrigin origin_;
  GeographicLib::LocalCartesian cartesian_;
};

}  // namespace tread::ins
