// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/mission_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/picture/plot.hpp"

namespace tread::missions {
namespace {

using namespace tread::picture;
using Eigen::Vector2d;

Colour surfaceColour(const std::string& surface) {
  if (surface == "cinder") return {0.93, 0.80, 0.72};
  if (surface == "tarmac") return {0.84, 0.86, 0.90};
  if (surface == "grass") return {0.80, 0.92, 0.76};
  if (surface == "gravel") return {0.95, 0.92, 0.76};
  return {0.95, 0.95, 0.95};
}

std::vector<Vector2d> rectangleAt(const Pose2& pose, double front, double rear, double half) {
  return {pose * Vector2d(front, half), pose * Vector2d(-rear, half), pose * Vector2d(-rear, -half),
          pose * Vector2d(front, -half)};
}

struct Bounds {
  Vector2d low{1e9, 1e9};
  Vector2d high{-1e9, -1e9};
  void add(const Vector2d& p, double margin) {
    low = low.cwiseMin(p - Vector2d(margin, margin));
    high = high.cwiseMax(p + Vector2d(margin, margin));
  }
};

Bounds boundsOf(const MissionResult& result, const MissionWorld& world) {
  Bounds bounds;
  bounds.add(world.T_map_start.position(), 6.0);
  bounds.add(world.T_map_goal.position(), 6.0);
  for (const TrackPoint& point : result.track) bounds.add(point.T_map_body.position(), 4.0);
  return bounds;
}

void drawSurfaces(Panel& panel, const MissionWorld& world, const Bounds& bounds) {
  const double more = 60.0;
  panel.polygon({bounds.low - Vector2d(more, more),
                 {bounds.high.x() + more, bounds.low.y() - more},
                 bounds.high + Vector2d(more, more),
                 {bounds.low.x() - more, bounds.high.y() + more}},
                surfaceColour(world.description.base_surface));
  for (const sim::SurfaceRegion& region : world.description.regions)
    panel.polygon(region.corners, surfaceColour(region.surface));
}

/// What mapping published: obstacles dark; free and unknown cells do not hide the world.
void drawMap(Panel& panel, const TileMap& map) {
  for (const auto& [index, tile] : map.tiles()) {
    const CellIndex lower{index.first * map.tileCells(), index.second * map.tileCells()};
    Grid grid(map.cellSize(), lower, map.tileCells(), map.tileCells());
    grid.cells() = tile.cells;
    for (Cell& cell : grid.cells())
      if (cell == kUnknown) cell = kFree;
    panel.grid(grid, 0.75);
  }
}

void drawObstacles(Panel& panel, const MissionWorld& world) {
  for (const sim::Obstacle& obstacle : world.description.obstacles) {
    const Colour fill{0.45, 0.38, 0.35, 0.55};
    if (obstacle.isDisc()) {
      panel.disc(obstacle.centre, obstacle.radius, fill);
    } else {
      panel.polygon(obstacle.corners, fill);
    }
  }
}

void drawTree(Panel& panel, const std::vector<TreeEdge>& tree) {
  for (const TreeEdge& edge : tree)
    if (!edge.chosen) panel.line({edge.from, edge.to}, {{0.34, 0.71, 0.91, 0.5}, 1.0, false, ""});
  for (const TreeEdge& edge : tree)
    if (edge.chosen) panel.line({edge.from, edge.to}, {kOrange, 2.5, false, ""});
}

void drawTrack(Panel& panel, const MissionResult& result) {
  std::vector<Vector2d> points;
  double next_outline = 0.0;
  for (const TrackPoint& point : result.track) {
    points.push_back(point.T_map_body.position());
    if (point.time < next_outline) continue;
    panel.polygon(rectangleAt(point.T_map_body, 0.65, 0.65, 0.34), {0.0, 0.45, 0.70, 0.13});
    next_outline = point.time + 2.0;
  }
  panel.line(points, {kBlue, 2.2, false, "driven"});
}

void drawWay(Picture& picture, const MissionResult& result, const MissionScene& scene) {
  const Bounds bounds = boundsOf(result, scene.world);
  Panel panel(picture, {60, 70, 760, 640},
              {"the way", "x [m]", "y [m]", bounds.low.x(), bounds.high.x(), bounds.low.y(),
               bounds.high.y(), true});
  drawSurfaces(panel, scene.world, bounds);
  drawObstacles(panel, scene.world);
  drawMap(panel, scene.map);
  drawTree(panel, scene.tree);
  drawTrack(panel, result);
  panel.dot(scene.world.T_map_start.position(), kGreen, 7.0);
  panel.dot(scene.world.T_map_goal.position(), kRed, 7.0);
  for (const Contact& contact : result.contacts)
    panel.dot(contact.T_map_body.position(), kPink, 6.0);
  if (!result.contacts.empty()) panel.legendEntry({kPink, 6.0, false, "contact"});
  panel.legendEntry({kOrange, 2.5, false, "a plan on the way"});
  panel.legendEntry({kSkyBlue, 1.0, false, "its tree"});
  panel.legendEntry({kGreen, 6.0, false, "start"});
  panel.legendEntry({kRed, 6.0, false, "goal"});
  panel.legendEntry({{0.15, 0.15, 0.15}, 6.0, false, "obstacle as mapped"});
  panel.finish();
}

void drawErrors(Picture& picture, Box box, const std::string& title, const std::string& unit,
                const MissionResult& result, double ScoredExecution::*error) {
  double largest = 0.02;
  for (const ScoredExecution& execution : result.executions)
    if (execution.measured) largest = std::max(largest, std::abs(execution.*error));
  Panel panel(picture, box,
              {title, "time [s]", unit, 0.0, std::max(1.0, result.time), 0.0, 1.15 * largest});
  for (const ScoredExecution& execution : result.executions) {
    if (!execution.measured) continue;
    const double value = std::abs(execution.*error);
    panel.line({{execution.time, 0.0}, {execution.time, value}}, {kSkyBlue, 1.5, false, ""});
    panel.dot({execution.time, value}, kBlue, 3.0);
  }
  for (const Crossing& change : result.crossings) {
    panel.verticalLine(change.time, {kRed, 1.2, true, ""});
    panel.text({change.time, 1.05 * largest}, " " + change.to, kRed);
  }
  panel.finish();
}

void drawSurfaceLegend(Picture& picture) {
  double x = 900;
  for (const char* surface : {"cinder", "tarmac", "grass", "gravel"}) {
    picture.fill({x, 648, 16, 16}, surfaceColour(surface));
    picture.text(x + 22, 661, surface, 12.0);
    x += 95;
  }
}

std::string titleOf(const MissionResult& result) {
  char text[300];
  std::snprintf(text, sizeof text,
                "Mission %llu: %s after %.0f s and %.1f m (straight line %.1f m), %d patterns, %d "
                "collisions%s%s",
                static_cast<unsigned long long>(result.seed), nameOf(result.outcome), result.time,
                result.distance, result.straight_line, result.completed, result.collisions,
                result.reason.empty() ? "" : ": ", result.reason.c_str());
  return text;
}

}  // namespace

void drawMission(const std::string& path, const MissionResult& result, const MissionScene& scene) {
  Picture picture(1300, 760, titleOf(result));
  drawWay(picture, result, scene);
  drawErrors(picture, {900, 70, 370, 210}, "prediction error of each pattern: position", "[m]",
             result, &ScoredExecution::error_position);
  drawErrors(picture, {900, 365, 370, 210}, "prediction error of each pattern: yaw", "[rad]",
             result, &ScoredExecution::error_yaw);
  drawSurfaceLegend(picture);
  picture.save(path);
}

}  // namespace tread::missions
