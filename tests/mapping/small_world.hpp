// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "common/geometry/se3.hpp"
#include "modules/mapping/core/occupancy_map.hpp"

namespace tread::mapping {

/// A standing or hanging box in the world [m], with sides along the axes of map.
struct Box {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

/// Ground as a height over map, and boxes.
struct SmallWorld {
  std::function<double(double, double)> ground = [](double, double) { return 0.0; };
  std::vector<Box> boxes;

  bool isSolid(const Eigen::Vector3d& p) const {
    if (p.z() < ground(p.x(), p.y())) return true;
    for (const Box& box : boxes)
      if ((p.array() > box.low.array()).all() && (p.array() < box.high.array()).all()) return true;
    return false;
  }

  /// Pose of a body on the ground: its plane touches the ground at the origin.
  Eigen::Isometry3d stand(double x, double y, double yaw) const {
    constexpr double kStep = 0.3;
    const double along_x = (ground(x + kStep, y) - ground(x - kStep, y)) / (2.0 * kStep);
    const double along_y = (ground(x, y + kStep) - ground(x, y - kStep)) / (2.0 * kStep);
    const Eigen::Vector3d up = Eigen::Vector3d(-along_x, -along_y, 1.0).normalized();
    const Eigen::Vector3d left =
        up.cross(Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0.0)).normalized();
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear().col(0) = left.cross(up);
    T.linear().col(1) = left;
    T.linear().col(2) = up;
    T.translation() = Eigen::Vector3d(x, y, ground(x, y));
    return T;
  }
};

/// A level range finder 0.5 m above the ground with 270 degrees.
struct RangeFinder {
  Eigen::Isometry3d T_body_sensor = isometryFrom({0.25, 0.0, 0.5}, {});
  double field_of_view = 1.5 * kPi;
  int beams = 541;
  double range_max = 15.0;

  Beam cast(const SmallWorld& world, const Eigen::Isometry3d& T_map_body, int i) const {
    const double angle = field_of_view * (static_cast<double>(i) / (beams - 1) - 0.5);
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Isometry3d T_map_sensor = T_map_body * T_body_sensor;
    const auto isSolidAt = [&](double r) {
      return world.isSolid(T_map_sensor * Eigen::Vector3d(direction * r));
    };
    double range = 0.05;  // no object in these worlds is thinner than the step
    while (range < range_max && !isSolidAt(range)) range += 0.1;
    const bool hit = range < range_max;
    double clear = range - 0.1;
    while (hit && range - clear > 0.01) {
      const double middle = 0.5 * (clear + range);
      (isSolidAt(middle) ? range : clear) = middle;
    }
    return {direction * (hit ? range : range_max), static_cast<double>(i) / (beams - 1), hit};
  }

  Scan scan(const SmallWorld& world, int64_t utime, const Eigen::Isometry3d& T_map_body) const {
    Scan scan{utime, T_map_body, T_map_body, T_body_sensor, {}};
    for (int i = 0; i < beams; ++i) scan.beams.push_back(cast(world, T_map_body, i));
    return scan;
  }
};

/// The default map of a robot of usual size.
inline OccupancyMapConfig usualMap() {
  OccupancyMapConfig config;
  config.robot = {0.65, 0.65, 0.34};
  config.obstacle.robot_height = 1.2;
  config.start_free_radius = 1.0;
  return config;
}

/// A map with its range finder and clock.
struct Mapper {
  explicit Mapper(const OccupancyMapConfig& config = usualMap()) : map(config) {}

  OccupancyMap::Refusal look(const SmallWorld& world, const Eigen::Isometry3d& T_map_body,
                             int scans = 1) {
    OccupancyMap::Refusal refusal = OccupancyMap::Refusal::kNone;
    for (int i = 0; i < scans; ++i)
      refusal = map.insert(range_finder.scan(world, utime += 100'000, T_map_body));
    return refusal;
  }
  /// Drives straight, with a scan every 10 cm.
  void drive(const SmallWorld& world, Eigen::Vector2d from, Eigen::Vector2d to) {
    const Eigen::Vector2d way = to - from;
    const double yaw = std::atan2(way.y(), way.x());
    for (double s = 0.0; s <= way.norm() + 1e-9; s += 0.1) {
      const Eigen::Vector2d p = from + way.normalized() * s;
      look(world, world.stand(p.x(), p.y(), yaw));
    }
  }
  Cell at(double x, double y) const { return map.grid().at(map.grid().indexOf({x, y})); }

  OccupancyMap map;
  RangeFinder range_finder;
  int64_t utime = 1'000'000;
};

}  // namespace tread::mapping
