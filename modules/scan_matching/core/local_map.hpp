// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "modules/scan_matching/core/scan_points.hpp"

namespace tread::scan_matching {

/// Points of recent scans in the map, found by place.
class LocalMap {
 public:
  /// Keeps the last `scans` scans, limited to `reach` [m] around the newest.
  LocalMap(size_t scans, double reach) : most_(scans), reach_(reach) {}

  /// Adds a scan to the map, and drops the oldest if there are too many.
  void add(const Pose2& T_map_body, const std::vector<ScanPoint>& points);
  void clear();

  bool empty() const { return scans_.empty(); }
  /// All points, p_map.
  const std::vector<ScanPoint>& points() const { return points_; }
  /// Pose of the newest scan.
  const Pose2& newest() const { return scans_.back().T_map_body; }
  /// The nearest point within `radius` (at most kCell) that faces `p_map_sensor`; else nullptr.
  const ScanPoint* nearest(const Eigen::Vector2d& p_map, double radius,
                           const Eigen::Vector2d& p_map_sensor) const;

  static constexpr double kCell = 0.5;  ///< [m]

 private:
  struct KeyScan {
    Pose2 T_map_body;
    std::vector<ScanPoint> points;  ///< p_map
  };

  void collect();
  void index();
  int column(double x) const;
  int row(double y) const;

  size_t most_;
  double reach_;
  std::deque<KeyScan> scans_;
  std::vector<ScanPoint> points_;  ///< cell by cell
  std::vector<uint32_t> starts_;   ///< of each cell in points_, and the end
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  int columns_ = 0;
  int rows_ = 0;
};

/// Likelihood of a return at a position given the map: 255 at a point, falling off around it. For
/// searches that test many poses.
class LikelihoodGrid {
 public:
  static constexpr double kCell = 0.1;  ///< [m]

  explicit LikelihoodGrid(const std::vector<ScanPoint>& map_points);

  int at(const Eigen::Vector2d& p_map) const {
    const auto x = static_cast<int>(std::floor((p_map.x() - low_.x()) / kCell));
    const auto y = static_cast<int>(std::floor((p_map.y() - low_.y()) / kCell));
    if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return 0;
    return cells_[static_cast<size_t>(y) * static_cast<size_t>(columns_) + static_cast<size_t>(x)];
  }

 private:
  void raise(int x, int y);

  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  int columns_ = 0;
  int rows_ = 0;
  std::vector<uint8_t> cells_;
};

}  // namespace tread::scan_matching
