// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/map/places.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {
namespace {

constexpr double kSizeShare = 0.9;
/// A cell's corner may have so much more room than its centre, in cells.
constexpr double kCorner = 0.71;
constexpr double kTurn = 2.0 * kPi / Places::kHeadings;

}  // namespace

Places::Places(const Surroundings& surroundings, double radius, double grown)
    : surroundings_(surroundings) {
  const Grid& grid = surroundings.grid();
  const double cell = grid.cellSize();
  const int side = std::max(1, static_cast<int>(kSizeShare * (radius + grown) / cell));
  size_ = cell * side;
  lower_ = cell * Eigen::Vector2d(grid.lower().x, grid.lower().y);
  width_ = (grid.width() + side - 1) / side;
  height_ = (grid.height() + side - 1) / side;
  const size_t squares = static_cast<size_t>(stride()) * static_cast<size_t>(height_ + 2 * kRim);
  best_.resize(squares);
  room_.assign(squares, Room::kNone);
  asked_.assign(squares, 0);
  free_.assign(squares, 0);
  std::vector<float> clearance(squares, 0.0F);
  for (int y = 0; y < grid.height(); ++y) {
    const float* row = surroundings.field().row(y);
    for (int x = 0; x < grid.width(); ++x) {
      const size_t square = number(x / side, y / side);
      if (row[x] <= clearance[square]) continue;
      clearance[square] = row[x];
      best_[square] = {grid.lower().x + x, grid.lower().y + y};
    }
  }
  const auto whole = static_cast<float>(surroundings.circumscribedRadius());
  const auto least = static_cast<float>(radius - kCorner * cell);
  for (size_t i = 0; i < squares; ++i)
    if (clearance[i] > 0.0F && clearance[i] >= least)
      room_[i] = clearance[i] >= whole ? Room::kAll : Room::kSome;
}

void Places::ask(size_t square, int heading) {
  const double yaw = heading * kTurn;
  const Eigen::Vector2d p_map = surroundings_.grid().centre(best_[square]);
  const TurnedPose pose{p_map.x(), p_map.y(), std::cos(yaw), std::sin(yaw)};
  const auto bit = static_cast<uint16_t>(1U << static_cast<unsigned>(heading));
  asked_[square] = static_cast<uint16_t>(asked_[square] | bit);
  if (surroundings_.isFree(pose, Surroundings::kBare))
    free_[square] = static_cast<uint16_t>(free_[square] | bit);
}

}  // namespace tread::planner
