// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/planner/kit/playground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>

namespace tread::planner::testkit {
namespace {

int floorDivide(int a, int b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

/// Signed distance from a point to a box: negative inside.
double distanceTo(const Box& box, const Eigen::Vector2d& p_map) {
  const Eigen::Vector2d p = inverse(box.T_map_box) * p_map;
  const double dx = std::abs(p.x()) - box.half_length;
  const double dy = std::abs(p.y()) - box.half_width;
  const double outside = std::hypot(std::max(dx, 0.0), std::max(dy, 0.0));
  return outside + std::min(std::max(dx, dy), 0.0);
}

/// Distance along a ray, from a point in the box's frame, to the box; infinite if it misses.
double enter(const Box& box, const Eigen::Vector2d& p, double angle) {
  const double heading = angle - box.T_map_box.yaw;
  const double direction[2] = {std::cos(heading), std::sin(heading)};
  const double half[2] = {box.half_length, box.half_width};
  double from = 0.0;
  double to = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 2; ++k) {
    const double at = k == 0 ? p.x() : p.y();
    const double along = std::abs(direction[k]) < 1e-12 ? 1e-12 : direction[k];
    const double a = (-half[k] - at) / along;
    const double b = (half[k] - at) / along;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to ? from : std::numeric_limits<double>::infinity();
}

/// Cells whose centre is closer to a box become obstacles.
void markNear(const std::vector<Box>& boxes, double distance, Grid& grid) {
  for (const Box& box : boxes) {
    const double reach = std::hypot(box.half_length, box.half_width) + distance;
    const Eigen::Vector2d p = box.T_map_box.position();
    const CellIndex from = grid.indexOf(p - Eigen::Vector2d(reach, reach));
    const CellIndex to = grid.indexOf(p + Eigen::Vector2d(reach, reach));
    for (int y = from.y; y <= to.y; ++y)
      for (int x = from.x; x <= to.x; ++x)
        if (distanceTo(box, grid.centre({x, y})) <= distance) grid.set({x, y}, kObstacle);
  }
}

using Corners = std::array<Eigen::Vector2d, 4>;

Corners cornersOf(const Box& box) {
  const double l = box.half_length;
  const double w = box.half_width;
  return {box.T_map_box * Eigen::Vector2d(-l, -w), box.T_map_box * Eigen::Vector2d(l, -w),
          box.T_map_box * Eigen::Vector2d(l, w), box.T_map_box * Eigen::Vector2d(-l, w)};
}

/// Largest gap between a box and another box's corners along the first one's axes; negative if
/// they overlap on both axes.
double gapAlongAxes(const Box& box, const Corners& others) {
  const Pose2 T_box_map = inverse(box.T_map_box);
  Eigen::Array2d least = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d most = -least;
  for (const Eigen::Vector2d& corner : others) {
    const Eigen::Array2d p = (T_box_map * corner).array();
    least = least.min(p);
    most = most.max(p);
  }
  const Eigen::Array2d half(box.half_length, box.half_width);
  return (least - half).max(-half - most).maxCoeff();
}

/// Distance between two boxes; negative overlap if they intersect. The nearest points of separate
/// boxes are a corner of one box and a point of the other.
double distanceBetween(const Box& a, const Box& b) {
  const Corners of_a = cornersOf(a);
  const Corners of_b = cornersOf(b);
  const double gap = std::max(gapAlongAxes(a, of_b), gapAlongAxes(b, of_a));
  if (gap <= 0.0) return gap;
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& corner : of_a) least = std::min(least, distanceTo(b, corner));
  for (const Eigen::Vector2d& corner : of_b) least = std::min(least, distanceTo(a, corner));
  return least;
}

}  // namespace

void Playground::addWall(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double thickness) {
  const Eigen::Vector2d along = to - from;
  const Eigen::Vector2d middle = (from + to) / 2.0;
  add({{middle.x(), middle.y(), std::atan2(along.y(), along.x())},
       along.norm() / 2.0,
       thickness / 2.0});
}

bool Playground::isObstacle(const Eigen::Vector2d& p_map) const {
  return std::any_of(boxes_.begin(), boxes_.end(),
                     [&](const Box& box) { return distanceTo(box, p_map) <= 0.0; });
}

Sight::Sight(const Playground& ground, const Eigen::Vector2d& p_map, double range) : range_(range) {
  for (const Box& box : ground.boxes())
    if (distanceTo(box, p_map) <= range) near_.push_back({box, inverse(box.T_map_box) * p_map});
}

double Sight::cast(double angle) const {
  double range = range_;
  for (const auto& [box, p_box] : near_) range = std::min(range, enter(box, p_box, angle));
  return range;
}

double Playground::clearance(const FootprintSize& size, const Pose2& T_map_body) const {
  const double shift = (size.front - size.rear) / 2.0;
  const Box body{T_map_body * Pose2{shift, 0.0, 0.0}, (size.front + size.rear) / 2.0,
                 size.half_width};
  const Eigen::Vector2d p = T_map_body.position();
  double least = std::numeric_limits<double>::infinity();
  for (const Box& box : boxes_) {
    if (distanceTo(box, p) > 3.0) continue;
    least = std::min(least, distanceBetween(body, box));
  }
  return least;
}

Grid Playground::paint(double cell_size, const Eigen::Vector2d& lower,
                       const Eigen::Vector2d& upper) const {
  const CellIndex first{static_cast<int>(std::floor(lower.x() / cell_size)),
                        static_cast<int>(std::floor(lower.y() / cell_size))};
  Grid grid(cell_size, first, static_cast<int>(std::ceil((upper.x() - lower.x()) / cell_size)),
            static_cast<int>(std::ceil((upper.y() - lower.y()) / cell_size)));
  std::fill(grid.cells().begin(), grid.cells().end(), kFree);
  markNear(boxes_, 0.5 * cell_size, grid);
  return grid;
}

bool Playground::connected(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                           double radius) const {
  Grid grid = Playground{}.paint(0.1, from.cwiseMin(to) - Eigen::Vector2d(15.0, 15.0),
                                 from.cwiseMax(to) + Eigen::Vector2d(15.0, 15.0));
  markNear(boxes_, radius, grid);
  std::deque<CellIndex> open{grid.indexOf(from)};
  const CellIndex goal = grid.indexOf(to);
  while (!open.empty()) {
    const CellIndex here = open.front();
    open.pop_front();
    if (here == goal) return true;
    const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (const auto& [dx, dy] : steps) {
      const CellIndex next{here.x + dx, here.y + dy};
      if (grid.at(next) != kFree) continue;
      grid.set(next, kUnknown);  // seen
      open.push_back(next);
    }
  }
  return false;
}

std::vector<Tile> tilesOf(const Grid& grid, int tile_cells, int64_t utime) {
  std::vector<Tile> tiles;
  const int x_first = floorDivide(grid.lower().x, tile_cells);
  const int y_first = floorDivide(grid.lower().y, tile_cells);
  const int x_last = floorDivide(grid.lower().x + grid.width() - 1, tile_cells);
  const int y_last = floorDivide(grid.lower().y + grid.height() - 1, tile_cells);
  for (int ty = y_first; ty <= y_last; ++ty) {
    for (int tx = x_first; tx <= x_last; ++tx) {
      Tile tile{tx, ty, utime, {}};
      for (int y = 0; y < tile_cells; ++y)
        for (int x = 0; x < tile_cells; ++x)
          tile.cells.push_back(grid.at({tx * tile_cells + x, ty * tile_cells + y}));
      tiles.push_back(tile);
    }
  }
  return tiles;
}

void ToyMapping::note(CellIndex cell, int evidence) {
  const std::pair<int, int> key{floorDivide(cell.x, kTileCells), floorDivide(cell.y, kTileCells)};
  std::vector<int8_t>& cells = evidence_[key];
  if (cells.empty()) cells.assign(kTileCells * kTileCells, 0);
  const int index =
      (cell.y - key.second * kTileCells) * kTileCells + cell.x - key.first * kTileCells;
  int8_t& value = cells[static_cast<size_t>(index)];
  value = static_cast<int8_t>(std::clamp(value + evidence, -6, 12));
  touched_[key] = true;
}

std::vector<Tile> ToyMapping::scan(const Playground& ground, const Pose2& T_map_body,
                                   int64_t utime) {
  std::normal_distribution<double> noise(0.0, 0.01);
  const Eigen::Vector2d p = T_map_body * Eigen::Vector2d(0.4, 0.0);
  const Grid lattice(kCell, {}, 0, 0);
  const Sight sight(ground, p, 10.0);
  for (double bearing = -135.0; bearing <= 135.0; bearing += 0.5) {
    const double angle = T_map_body.yaw + bearing * kPi / 180.0;
    const double range = sight.cast(angle);
    const double measured = range < 10.0 ? range + noise(random_) : range;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const CellIndex hit = lattice.indexOf(p + measured * along);
    CellIndex last{INT32_MAX, 0};
    for (double r = 0.0; r < measured; r += 0.05) {
      const CellIndex cell = lattice.indexOf(p + r * along);
      if (cell == last || cell == hit) continue;
      last = cell;
      note(cell, -1);
    }
    if (range < 10.0) note(hit, 4);
  }
  std::vector<Tile> tiles;
  for (const auto& [key, touched] : touched_) {
    Tile tile{key.first, key.second, utime, {}};
    for (const int8_t value : evidence_[key])
      tile.cells.push_back(value == 0 ? kUnknown : value > 0 ? kObstacle : kFree);
    tiles.push_back(tile);
  }
  touched_.clear();
  return tiles;
}

Mission randomMission(uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  while (true) {
    Mission mission;
    Playground& ground = mission.ground;
    const double x_goal = draw(25.0, 32.0);
    mission.T_map_start = {0.0, 0.0, draw(-0.6, 0.6)};
    mission.goal = {1, {x_goal, draw(-6.0, 6.0), 0.0}, 0.5, 4.0};
    const Eigen::Vector2d lower(-5.0, -10.0), upper(x_goal + 5.0, 10.0);
    ground.addWall(lower, {upper.x(), lower.y()});
    ground.addWall({upper.x(), lower.y()}, upper);
    ground.addWall(upper, {lower.x(), upper.y()});
    ground.addWall({lower.x(), upper.y()}, lower);
    for (const double share : {0.3, 0.6, 0.85}) {
      const double x = share * x_goal + draw(-1.5, 1.5);
      const double gap = draw(1.08, 2.2);
      const double y = draw(-8.0, 8.0);
      ground.addWall({x, -10.0}, {x, y - gap / 2.0});
      ground.addWall({x, y + gap / 2.0}, {x, 10.0});
    }
    const double pocket = draw(0.35, 0.55) * x_goal;
    const double middle = draw(-4.0, 4.0);
    ground.addWall({pocket, middle - 1.5}, {pocket, middle + 1.5});
    ground.addWall({pocket - 2.5, middle - 1.5}, {pocket, middle - 1.5});
    ground.addWall({pocket - 2.5, middle + 1.5}, {pocket, middle + 1.5});
    for (int i = 0; i < 18; ++i) {
      const Box box{{draw(2.0, x_goal - 1.5), draw(-9.0, 9.0), draw(-kPi, kPi)},
                    draw(0.15, 0.8),
                    draw(0.15, 0.8)};
      ground.add(box);
    }
    const Eigen::Vector2d p_goal = mission.goal.T_map_goal.position();
    const bool roomy = ground.clearance({}, mission.T_map_start) > 0.7 &&
                       ground.clearance({}, {p_goal.x(), p_goal.y(), 0.0}) > 0.5;
    if (roomy && ground.connected({0.0, 0.0}, p_goal, 0.52)) return mission;
  }
}

}  // namespace tread::planner::testkit
