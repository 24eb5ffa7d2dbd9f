// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/grid/grid.hpp"

namespace tread {

/// Distance to the nearest blocked cell's area [m], for every point of a window.
/** Exact Euclidean distance from each cell's centre (Felzenszwalb and Huttenlocher 2012, two
 * passes, with the parabolas on the borders of cells instead of their centres). `unknown_blocks`
 * decides whether unknown cells block; everything outside the window counts as unknown. */
class ClearanceField {
 public:
  /// The true distance [m] lies between the two.
  struct Bounds {
    double lower = 0.0;
    double upper = 0.0;
  };

  ClearanceField() = default;
  /// `cap` [m]: larger clearances are not distinguished, which is faster; they have no upper bound.
  ClearanceField(const Grid& grid, bool unknown_blocks,
                 double cap = std::numeric_limits<double>::infinity());

  /// Clearance at a point of map [m]: a lower bound of the distance to the nearest blocked cell's
  /// area, at most 0.71 cells too low; 0 in a blocked cell; infinite if no cell blocks. Outside the
  /// window 0 if unknown blocks, else the value of the window's nearest point; 0 for NaN.
  double at(const Eigen::Vector2d& p_map) const { return bounds(p_map).lower; }

  /// Clearance at the centre of the cell that contains a point [m], where one cell is accurate
  /// enough.
  double quick(double x, double y) const {
    const double column = x * per_cell_ - lower_.x;
    const double row = y * per_cell_ - lower_.y;
    if (!(column >= 0.0 && row >= 0.0 && column < width_ && row < height_)) return 0.0;
    return static_cast<double>(
        clearance_[static_cast<size_t>(static_cast<int>(row)) * static_cast<size_t>(width_) +
                   static_cast<size_t>(static_cast<int>(column))]);
  }
  /// Clearances at the centres of a row of cells, counted from the window's lowest one [m].
  const float* row(int y) const {
    return clearance_.data() + static_cast<size_t>(y) * static_cast<size_t>(width_);
  }
  /// What is certain about the clearance compared with a distance.
  enum class Verdict { kLess, kAtLeast, kUnsure };
  /// Compares the lower bound at() and the upper bound with a distance [m]; usually needs one
  /// lookup.
  /** Equals at(p) >= distance and bounds(p).upper < distance, except for rounding. */
  Verdict compare(double x, double y, float distance) const {
    return compare(x, y, distance, distance);
  }
  /// kAtLeast if the clearance is certainly `far` or more, kLess if it is certainly less than
  /// `near`.
  Verdict compare(double x, double y, float near, float far) const {
    const double column = x * per_cell_ - lower_.x;
    const double row = y * per_cell_ - lower_.y;
    if (column >= 0.0 && row >= 0.0 && column < width_ && row < height_) {
      const int cx = static_cast<int>(column);
      const int cy = static_cast<int>(row);
      const float value = clearance_[static_cast<size_t>(cy) * static_cast<size_t>(width_) +
                                     static_cast<size_t>(cx)];
      if (value - half_diagonal_ >= far) return Verdict::kAtLeast;
      if (value + half_diagonal_ < near && value < cap_) return Verdict::kLess;
      return compareClosely(column - cx - 0.5, row - cy - 0.5, value, near, far);
    }
    return compareOutside(x, y, near, far);
  }

  /// Whether a disc overlaps no blocked cell: by one lookup, or by requiring every cell of the
  /// square around it to be free. False around a point outside the window.
  bool discFree(double x, double y, float radius) const {
    const double column = x * per_cell_ - lower_.x;
    const double row = y * per_cell_ - lower_.y;
    if (!(column >= 0.0 && row >= 0.0 && column < width_ && row < height_)) return false;
    const float value =
        clearance_[static_cast<size_t>(static_cast<int>(row)) * static_cast<size_t>(width_) +
                   static_cast<size_t>(static_cast<int>(column))];
    return value - half_diagonal_ >= radius || squareFree(column, row, radius);
  }

  /// Both bounds of the clearance; outside the window the upper one is infinite.
  Bounds bounds(const Eigen::Vector2d& p_map) const;

  CellIndex lower() const { return lower_; }
  double cellSize() const { return cell_size_; }

  /// Whether any of the cells (first..last, row) is blocked, in constant time. At most 65535 cells.
  bool anyBlocked(int row, int first, int last) const {
    const int y = row - lower_.y;
    const int x = first - lower_.x;
    const int end = last - lower_.x;
    if (x > end) return false;
    if (y < 0 || y >= height_ || x < 0 || end >= width_) return anyBlockedBeyond(y, x, end);
    return runs_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)] <=
           end - x;
  }

 private:
  /// Rounding error of a float: both bounds remain bounds.
  static constexpr double kRounding = 6e-8;

  void lookNearby(const std::vector<uint8_t>& blocked, int cap_steps);
  void lookEverywhere(const std::vector<uint8_t>& blocked, float cap_steps);
  double outside(const Eigen::Vector2d& p_map) const;
  bool squareFree(double column, double row, float reach) const;
  bool anyBlockedBeyond(int y, int x, int end) const;
  Verdict compareOutside(double x, double y, float near, float far) const;
  /// As bounds(), without the square root: at (dx, dy) [cells] from the centre of a cell.
  Verdict compareClosely(double dx, double dy, float clearance, float near, float far) const {
    const auto value = static_cast<double>(clearance);
    if (far <= 0.0F) return Verdict::kAtLeast;
    if (value == 0.0) return near > 0.0F ? Verdict::kLess : Verdict::kUnsure;
    const double off = (dx * dx + dy * dy) * cell_size_ * cell_size_;
    const double room = value - kRounding * value - static_cast<double>(far);
    if (room >= 0.0 && room * room >= off) return Verdict::kAtLeast;
    const double lack = static_cast<double>(near) - value - kRounding * value;
    return lack > 0.0 && lack * lack > off && clearance < cap_ ? Verdict::kLess : Verdict::kUnsure;
  }

  double cell_size_ = 0.1;
  double per_cell_ = 10.0;                              // [1/m]
  float cap_ = std::numeric_limits<float>::infinity();  // [m]
  float half_diagonal_ = 0.08F;                         // [m] of a cell, rounded up
  CellIndex lower_;
  int width_ = 0;
  int height_ = 0;
  std::vector<float> clearance_;  // from each cell's centre [m], row by row
  std::vector<uint16_t> runs_;    // number of free cells to the right of each cell, itself included
  bool unknown_blocks_ = true;
};

}  // namespace tread
