// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/report/drive_report.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include <tread/plan_tree_t.hpp>

#include "common/report/plot.hpp"

namespace tread::report {
namespace {

using Eigen::Vector2d;

struct NamedColour {
  const char* surface;
  Colour colour;
};
constexpr NamedColour kSurfaces[] = {{"cinder", {0.93, 0.80, 0.72}}, {"tarmac", {0.84, 0.86, 0.90}},
                                     {"grass", {0.80, 0.92, 0.76}},  {"gravel", {0.95, 0.92, 0.76}},
                                     {"ice", {0.72, 0.90, 0.97}},    {"mud", {0.76, 0.66, 0.55}},
                                     {"sand", {0.97, 0.87, 0.55}}};

Colour surfaceColour(const std::string& surface) {
  for (const NamedColour& known : kSurfaces)
    if (surface == known.surface) return known.colour;
  return {0.95, 0.95, 0.95};
}

std::vector<Vector2d> outlineAt(const FootprintSize& size, const Pose2& pose) {
  return {
      pose * Vector2d(size.front, size.half_width), pose * Vector2d(-size.rear, size.half_width),
      pose * Vector2d(-size.rear, -size.half_width), pose * Vector2d(size.front, -size.half_width)};
}

struct Bounds {
  Vector2d low{1e9, 1e9};
  Vector2d high{-1e9, -1e9};
  void add(const Vector2d& p, double margin) {
    low = low.cwiseMin(p - Vector2d(margin, margin));
    high = high.cwiseMax(p + Vector2d(margin, margin));
  }
};

Bounds boundsOf(const DriveScene& scene) {
  Bounds bounds;
  bounds.add(scene.T_map_start.position(), 6.0);
  bounds.add(scene.T_map_goal.position(), 6.0);
  for (const PoseSample& point : scene.track) bounds.add(point.T_map_body.position(), 4.0);
  return bounds;
}

void drawSurfaces(Panel& panel, const DriveScene& scene, const Bounds& bounds) {
  if (!scene.world) return;
  const Vector2d more(60.0, 60.0);
  const Vector2d low = bounds.low - more;
  const Vector2d high = bounds.high + more;
  panel.polygon({low, {high.x(), low.y()}, high, {low.x(), high.y()}},
                surfaceColour(scene.world->base_surface));
  for (const sim::SurfaceRegion& region : scene.world->regions)
    panel.polygon(region.corners, surfaceColour(region.surface));
  for (const sim::RoughRegion& rough : scene.world->rough)
    panel.polygon(rough.corners, {0.35, 0.25, 0.15, 0.18});
}

/// The map published by mapping: obstacles dark; free and unknown cells do not hide the world.
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

void drawObstacles(Panel& panel, const DriveScene& scene) {
  if (!scene.world) return;
  const Colour fill{0.45, 0.38, 0.35, 0.55};
  for (const sim::Obstacle& obstacle : scene.world->obstacles) {
    if (obstacle.corners.empty()) {
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

void drawTrack(Panel& panel, const DriveScene& scene, Colour colour = kBlue) {
  std::vector<Vector2d> points;
  double next_outline = 0.0;
  for (const PoseSample& point : scene.track) {
    points.push_back(point.T_map_body.position());
    if (!scene.outline || point.time < next_outline) continue;
    panel.polygon(outlineAt(*scene.outline, point.T_map_body),
                  {colour.red, colour.green, colour.blue, 0.13});
    next_outline = point.time + 2.0;
  }
  panel.line(points, {colour, 2.2, false, "driven"});
}

void drawWay(Picture& picture, const DriveScene& scene) {
  const Bounds bounds = boundsOf(scene);
  Panel panel(picture, {60, 70, 760, 640},
              {"track", "x [m]", "y [m]", bounds.low.x(), bounds.high.x(), bounds.low.y(),
               bounds.high.y(), true});
  drawSurfaces(panel, scene, bounds);
  drawObstacles(panel, scene);
  drawMap(panel, scene.map);
  drawTree(panel, scene.tree);
  drawTrack(panel, scene);
  panel.dot(scene.T_map_start.position(), kGreen, 7.0);
  panel.dot(scene.T_map_goal.position(), kRed, 7.0);
  for (const Vector2d& contact : scene.contacts) panel.dot(contact, kPink, 6.0);
  if (!scene.contacts.empty()) panel.legendEntry({kPink, 6.0, false, "contact"});
  if (!scene.tree.empty()) {
    panel.legendEntry({kOrange, 2.5, false, "one plan"});
    panel.legendEntry({kSkyBlue, 1.0, false, "its tree"});
  }
  panel.legendEntry({kGreen, 6.0, false, "start"});
  panel.legendEntry({kRed, 6.0, false, "goal"});
  panel.legendEntry({{0.15, 0.15, 0.15}, 6.0, false, "mapped obstacle"});
  panel.finish();
}

/// Number of patterns in a running mean of errors, the newest last.
constexpr size_t kRunning = 5;
constexpr Colour kRuleColours[] = {kGrey, kOrange, kGreen, kPink, kRed, kBlack};

std::vector<Vector2d> runningMeans(const std::vector<PatternError>& errors,
                                   double PatternError::*error) {
  std::vector<Vector2d> means;
  for (size_t i = 0; i < errors.size(); ++i) {
    const size_t count = std::min(kRunning, i + 1);
    double sum = 0.0;
    for (size_t k = i + 1 - count; k <= i; ++k) sum += std::abs(errors[k].*error);
    means.emplace_back(errors[i].time, sum / static_cast<double>(count));
  }
  return means;
}

void drawRules(Panel& panel, const DriveScene& scene, double PatternError::*error) {
  for (size_t rule = 0; rule < scene.by_rule.size(); ++rule)
    panel.line(runningMeans(scene.by_rule[rule].errors, error),
               {kRuleColours[rule % std::size(kRuleColours)], 2.2, false, ""});
}

void drawErrors(Picture& picture, Box box, const std::string& title, const std::string& unit,
                const DriveScene& scene, double PatternError::*error) {
  double largest = 0.02;
  for (const PatternError& at : scene.errors) largest = std::max(largest, std::abs(at.*error));
  for (const RuleSeries& rule : scene.by_rule)
    for (const Vector2d& mean : runningMeans(rule.errors, error))
      largest = std::max(largest, mean.y());
  Panel panel(picture, box,
              {title, "time [s]", unit, 0.0, std::max(1.0, scene.duration), 0.0, 1.15 * largest});
  for (const PatternError& at : scene.errors) {
    const double value = std::abs(at.*error);
    panel.line({{at.time, 0.0}, {at.time, value}}, {kSkyBlue, 1.5, false, ""});
    panel.dot({at.time, value}, kBlue, 3.0);
  }
  drawRules(panel, scene, error);
  double height = 1.07;
  double last = -1e9;
  for (const Crossing& crossing : scene.crossings) {
    panel.verticalLine(crossing.time, {kRed, 1.2, true, ""});
    // Overlapping names move down.
    height = crossing.time - last < 0.16 * scene.duration ? height - 0.07 : 1.07;
    last = crossing.time;
    panel.text({crossing.time, height * largest}, " " + crossing.to, kRed);
  }
  panel.finish();
}

bool hasSurface(const sim::WorldDescription& world, const std::string& surface) {
  return world.base_surface == surface ||
         std::any_of(world.regions.begin(), world.regions.end(),
                     [&](const sim::SurfaceRegion& region) { return region.surface == surface; });
}

void drawSurfaceLegend(Picture& picture, const DriveScene& scene, double x, double y) {
  if (!scene.world) return;
  for (const NamedColour& known : kSurfaces) {
    if (!hasSurface(*scene.world, known.surface)) continue;
    picture.fill({x, y, 16, 16}, known.colour);
    picture.text(x + 22, y + 13, known.surface, 12.0);
    x += 95;
  }
}

void drawRuleLegend(Picture& picture, const DriveScene& scene) {
  if (scene.by_rule.empty()) return;
  picture.fill({906, 690, 6, 6}, kBlue);
  picture.text(922, 697, "as driven; the same executions by rule, mean of the last five:", 12.0);
  double x = 900;
  for (size_t rule = 0; rule < scene.by_rule.size(); ++rule) {
    picture.fill({x, 714, 16, 3}, kRuleColours[rule % std::size(kRuleColours)]);
    picture.text(x + 22, 720, scene.by_rule[rule].rule, 12.0);
    x += 100;
  }
}

constexpr Colour kSideColours[] = {kRed, kBlue, kGreen, kPink, kBlack, kOrange};

Colour sideColour(size_t i) {
  return kSideColours[i % std::size(kSideColours)];
}

/// Only the path: ground, obstacles, track, stops and contacts.
void drawSide(Picture& picture, Box box, const DriveScene& scene, const Bounds& bounds,
              Colour colour) {
  Panel panel(picture, box,
              {scene.title, "x [m]", "y [m]", bounds.low.x(), bounds.high.x(), bounds.low.y(),
               bounds.high.y(), true});
  drawSurfaces(panel, scene, bounds);
  drawObstacles(panel, scene);
  drawTrack(panel, scene, colour);
  for (const Vector2d& stop : scene.stops) panel.dot(stop, kBlack, 4.0);
  for (const Vector2d& contact : scene.contacts) panel.dot(contact, kPink, 6.0);
  panel.dot(scene.T_map_start.position(), kGreen, 7.0);
  panel.dot(scene.T_map_goal.position(), kOrange, 7.0);
  panel.legendEntry({kGreen, 6.0, false, "start"});
  panel.legendEntry({kOrange, 6.0, false, "goal"});
  panel.legendEntry({kBlack, 4.0, false, "stop"});
  if (!scene.contacts.empty()) panel.legendEntry({kPink, 6.0, false, "contact"});
  panel.finish();
}

void drawSideErrors(Picture& picture, Box box, const std::string& title, const std::string& unit,
                    const std::vector<DriveScene>& scenes, double PatternError::*error) {
  double longest = 1.0, largest = 0.02;
  for (const DriveScene& scene : scenes) {
    longest = std::max(longest, scene.duration);
    for (const PatternError& at : scene.errors) largest = std::max(largest, std::abs(at.*error));
  }
  Panel panel(picture, box, {title, "time [s]", unit, 0.0, longest, 0.0, 1.1 * largest});
  for (size_t i = 0; i < scenes.size(); ++i) {
    for (const PatternError& at : scenes[i].errors)
      panel.dot({at.time, std::abs(at.*error)}, sideColour(i), 2.0);
    panel.line(runningMeans(scenes[i].errors, error), {sideColour(i), 2.5, false, scenes[i].name});
    panel.verticalLine(scenes[i].duration, {sideColour(i), 1.2, true, ""});
  }
  panel.finish();
}

}  // namespace

void drawSideBySide(const std::string& path, const std::string& title,
                    const std::vector<DriveScene>& scenes) {
  constexpr double kColumn = 640.0;
  const double width = kColumn * static_cast<double>(scenes.size());
  Picture picture(static_cast<int>(width) + 20, 930, title);
  Bounds bounds;
  for (const DriveScene& scene : scenes) {
    bounds.add(boundsOf(scene).low, 0.0);
    bounds.add(boundsOf(scene).high, 0.0);
  }
  for (size_t i = 0; i < scenes.size(); ++i)
    drawSide(picture, {60.0 + kColumn * static_cast<double>(i), 70, kColumn - 80.0, 500}, scenes[i],
             bounds, sideColour(i));
  drawSurfaceLegend(picture, scenes.front(), 60, 615);
  const double half = width / 2.0;
  drawSideErrors(picture, {60, 680, half - 80.0, 190},
                 "prediction error of each pattern and mean of the last five: position", "[m]",
                 scenes, &PatternError::position);
  drawSideErrors(picture, {60 + half, 680, half - 80.0, 190}, "the same in yaw", "[rad]", scenes,
                 &PatternError::yaw);
  picture.save(path);
}

void drawDrive(const std::string& path, const DriveScene& scene) {
  Picture picture(1300, 760, scene.title);
  drawWay(picture, scene);
  drawErrors(picture, {900, 70, 370, 210}, "prediction error of each pattern: position", "[m]",
             scene, &PatternError::position);
  drawErrors(picture, {900, 365, 370, 210}, "prediction error of each pattern: yaw", "[rad]", scene,
             &PatternError::yaw);
  drawSurfaceLegend(picture, scene, 900, 648);
  drawRuleLegend(picture, scene);
  picture.save(path);
}

std::vector<TreeEdge> edgesOf(const plan_tree_t& message) {
  std::vector<TreeEdge> edges;
  const std::set<int> chosen(message.best.begin(), message.best.end());
  for (int i = 0; i < message.num_nodes; ++i) {
    const auto node = static_cast<size_t>(i);
    const int parent = message.parent[node];
    if (parent < 0 || parent >= message.num_nodes) continue;
    const auto& from = message.node_pose[static_cast<size_t>(parent)];
    const auto& to = message.node_pose[node];
    edges.push_back(
        {{from[0], from[1]}, {to[0], to[1]}, chosen.count(i) > 0 && chosen.count(parent) > 0});
  }
  return edges;
}

}  // namespace tread::report
