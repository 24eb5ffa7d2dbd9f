// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include "modules/planner/core/map/surroundings.hpp"

namespace tread::planner {

/// Where the vehicle can stand, and in which headings, on a coarse grid: what PoseToGo searches in.
/** A square is free in a heading if the footprint is at the point of the square with most room.
 * Found out when it is asked for, and kept: for all goals on the same map. */
class Places {
 public:
  static constexpr int kHeadings = 16;
  /// Squares of blocked ground around the map: no move goes farther.
  static constexpr int kRim = 2;

  /// `radius`: of the disc inside the footprint [m]; a square's side is a little less, so that no
  /// wall is lost between two squares. `grown`: by so much obstacles were grown before [m], which
  /// makes walls thicker. `surroundings` must stay.
  Places(const Surroundings& surroundings, double radius, double grown = 0.0);

  double size() const { return size_; }
  int width() const { return width_; }
  int height() const { return height_; }
  int stride() const { return width_ + 2 * kRim; }
  size_t count() const { return best_.size(); }
  size_t number(int column, int row) const {
    return static_cast<size_t>(row + kRim) * static_cast<size_t>(stride()) +
           static_cast<size_t>(column + kRim);
  }
  /// Column and row of the square that a point of map lies in; may be outside.
  int column(double x) const { return static_cast<int>(std::floor((x - lower_.x()) / size_)); }
  int row(double y) const { return static_cast<int>(std::floor((y - lower_.y()) / size_)); }
  Eigen::Vector2d centre(int column, int row) const {
    return lower_ + size_ * Eigen::Vector2d(column + 0.5, row + 0.5);
  }
  const Eigen::Vector2d& lower() const { return lower_; }

  /// Whether a disc has room somewhere in the square.
  bool passable(size_t square) const { return room_[square] != Room::kNone; }
  bool isFree(size_t square, int heading) {
    if (room_[square] == Room::kAll) return true;
    if (room_[square] == Room::kNone) return false;
    const auto bit = static_cast<uint16_t>(1U << static_cast<unsigned>(heading));
    if ((asked_[square] & bit) == 0) ask(square, heading);
    return (free_[square] & bit) != 0;
  }

 private:
  enum class Room : uint8_t { kNone, kSome, kAll };
  void ask(size_t square, int heading);

  const Surroundings& surroundings_;
  double size_ = 0.3;
  Eigen::Vector2d lower_{0.0, 0.0};
  int width_ = 0;
  int height_ = 0;
  std::vector<Room> room_;
  std::vector<CellIndex> best_;  // cell with most room, in map
  std::vector<uint16_t> asked_;
  std::vector<uint16_t> free_;
};

}  // namespace tread::planner
