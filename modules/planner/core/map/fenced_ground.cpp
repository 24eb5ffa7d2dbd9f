// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/map/fenced_ground.hpp"

#include <algorithm>

namespace tread::planner {
namespace {

/// Larger clearances are not distinguished [m].
constexpr float kFar = 1.5F;

/// Cells of a rectangle, half-open.
struct CellBox {
  int x_from, y_from, x_to, y_to;

  bool single() const { return x_to - x_from == 1 && y_to - y_from == 1; }
};

/// Visits the cells of a box whose clearance is less than `far` [m], each with the clearance of its
/// centre; boxes that certainly have more, or less than `near`, are not divided.
/** Clearance changes by at most a metre per metre: a box is classified from its middle. */
template <class Room, class Visit>
void visitNear(const CellBox& box, double size, double near, double far, const Room& room,
               const Visit& visit) {
  const Eigen::Vector2d centre(0.5 * size * (box.x_from + box.x_to),
                               0.5 * size * (box.y_from + box.y_to));
  const double half =
      0.5 * size * Eigen::Vector2d(box.x_to - box.x_from, box.y_to - box.y_from).norm();
  const double here = room(centre);
  if (here - half >= far) return;
  if (box.single() || here + half < near) return visit(box, here);
  const int x = box.x_from + std::max(1, (box.x_to - box.x_from) / 2);
  const int y = box.y_from + std::max(1, (box.y_to - box.y_from) / 2);
  for (const CellBox& part :
       {CellBox{box.x_from, box.y_from, x, y}, CellBox{x, box.y_from, box.x_to, y},
        CellBox{box.x_from, y, x, box.y_to}, CellBox{x, y, box.x_to, box.y_to}})
    if (part.x_from < part.x_to && part.y_from < part.y_to)
      visitNear(part, size, near, far, room, visit);
}

}  // namespace

double FencedGround::depth(const Pose2& T_map_body, const FootprintSize& footprint) const {
  if (fences_.empty()) return 0.0;
  return std::max(0.0, growth_ - roomAt(fences_, T_map_body, footprint).metres);
}

void FencedGround::stamp(Grid& grid) const {
  const CellIndex lower = grid.lower();
  const double half_diagonal = 0.5 * std::sqrt(2.0) * grid.cellSize();
  for (const Fence& fence : fences_) {
    visitNear(
        {lower.x, lower.y, lower.x + grid.width(), lower.y + grid.height()}, grid.cellSize(),
        growth_, growth_ + half_diagonal,
        [&](const Eigen::Vector2d& p) { return roomAt(fence, p); },
        [&](const CellBox& box, double room) {
          if (room >= growth_ + half_diagonal) return;
          for (int y = box.y_from; y < box.y_to; ++y)
            for (int x = box.x_from; x < box.x_to; ++x) grid.set({x, y}, kObstacle);
        });
  }
}

void FencedGround::stamp(ClearanceWindow& window, double size) const {
  for (const Fence& fence : fences_) {
    visitNear(
        {window.lower_x, window.lower_y, window.lower_x + window.width,
         window.lower_y + window.height},
        size, growth_, growth_ + static_cast<double>(kFar),
        [&](const Eigen::Vector2d& p) { return roomAt(fence, p); },
        [&](const CellBox& box, double room) {
          const auto clearance = static_cast<float>(std::max(0.0, room - growth_));
          for (int y = box.y_from; y < box.y_to; ++y)
            for (int x = box.x_from; x < box.x_to; ++x) {
              float& cell = window.clearance[window.at(x, y)];
              cell = std::min(cell, clearance);
            }
        });
  }
}

}  // namespace tread::planner
