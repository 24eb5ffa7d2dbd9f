// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/plan/plan_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/report/plot.hpp"

namespace tread::plan {
namespace {

using Eigen::Vector2d;
using report::Box;
using report::Colour;
using report::Panel;

constexpr double kMargin = 70.0;     // [pixels] around the panel for its axes
constexpr double kLongest = 1000.0;  // [pixels] longer side of the panel
constexpr double kShortest = 300.0;  // [pixels]

/// The part of the map's frame that the grid's window covers.
struct Extent {
  Vector2d low{1e9, 1e9};
  Vector2d high{-1e9, -1e9};

  Vector2d size() const { return high - low; }
};

std::array<Vector2d, 4> corners(const PlanScene& scene, CellIndex from, CellIndex to,
                                double more = 0.0) {
  const double cell = scene.grid.cellSize();
  const Vector2d low(from.x * cell - more, from.y * cell - more);
  const Vector2d high(to.x * cell + more, to.y * cell + more);
  return {scene.T_map_grid * low, scene.T_map_grid * Vector2d(high.x(), low.y()),
          scene.T_map_grid * high, scene.T_map_grid * Vector2d(low.x(), high.y())};
}

Extent extentOf(const PlanScene& scene) {
  const CellIndex low = scene.grid.lower();
  Extent extent;
  for (const Vector2d& corner :
       corners(scene, low, {low.x + scene.grid.width(), low.y + scene.grid.height()})) {
    extent.low = extent.low.cwiseMin(corner);
    extent.high = extent.high.cwiseMax(corner);
  }
  return extent;
}

/// The panel's size follows the map's shape.
Box boxFor(const Extent& extent) {
  const double scale = kLongest / extent.size().maxCoeff();
  return {kMargin, kMargin, std::max(kShortest, extent.size().x() * scale),
          std::max(kShortest, extent.size().y() * scale)};
}

/// Cells that are not free, equal neighbours of a row as one.
void drawCells(Panel& panel, const PlanScene& scene, double metres_per_pixel) {
  const CellIndex low = scene.grid.lower();
  for (int y = low.y; y < low.y + scene.grid.height(); ++y) {
    const int end = low.x + scene.grid.width();
    for (int x = low.x; x < end;) {
      const Cell cell = scene.grid.at({x, y});
      const int first = x;
      while (x < end && scene.grid.at({x, y}) == cell) ++x;
      if (isFree(cell)) continue;
      const double grey = cell == kUnknown ? 0.8 : 0.15;
      // Half a pixel more: without it smoothed edges leave bright seams between rows.
      const auto run = corners(scene, {first, y}, {x, y + 1}, metres_per_pixel / 2.0);
      panel.polygon({run.begin(), run.end()}, {grey, grey, grey});
    }
  }
}

void drawFootprints(Panel& panel, const PlanScene& scene) {
  const Colour fill{0.90, 0.62, 0.00, 0.18};
  for (const Pose2& T_map_body : scene.stations) {
    if (scene.outline.empty()) {
      panel.disc(T_map_body.position(), scene.radius, fill);
      continue;
    }
    std::vector<Vector2d> outline;
    for (const Vector2d& corner : scene.outline) outline.push_back(T_map_body * corner);
    panel.polygon(outline, fill);
    outline.push_back(outline.front());
    panel.line(outline, {{0.70, 0.45, 0.00, 0.6}, 0.8, false, ""});
  }
}

/// A dot and the way it looks.
void drawPose(Panel& panel, const Pose2& T_map_body, double length, Colour colour) {
  panel.dot(T_map_body.position(), colour, 6.0);
  panel.line({T_map_body.position(), T_map_body * Vector2d(length, 0.0)}, {colour, 3.0, false, ""});
}

/// Below the map, where it hides nothing.
void drawLegend(report::Picture& sheet, const PlanScene& scene, const Box& box) {
  double x = box.x;
  const double y = box.y + box.height + 50.0;
  const auto entry = [&](Colour colour, const std::string& tokens, double width) {
    sheet.fill({x, y - 8.0, 14.0, 8.0}, colour);
    sheet.text(x + 19.0, y, tokens, 11.0);
    x += width;
  };
  entry(report::kGreen, "start", 65.0);
  entry(report::kRed, "goal", 62.0);
  if (!scene.path.empty()) entry(report::kOrange, "plan", 60.0);
  if (!scene.tree.empty()) entry(report::kBlue, "search tree", 90.0);
}

}  // namespace

std::vector<Vector2d> rectangle(double length, double width) {
  const double x = length / 2.0;
  const double y = width / 2.0;
  return {{x, y}, {-x, y}, {-x, -y}, {x, -y}};
}

void drawPlan(const std::string& path, const PlanScene& scene) {
  const Extent extent = extentOf(scene);
  const Box box = boxFor(extent);
  const double metres_per_pixel =
      std::max(extent.size().x() / box.width, extent.size().y() / box.height);
  report::Picture sheet(static_cast<int>(box.width + 2.0 * kMargin),
                        static_cast<int>(box.height + 2.0 * kMargin), scene.title);
  sheet.text(20.0, 50.0, scene.result);
  Panel panel(sheet, box,
              {"", "x [m]", "y [m]", extent.low.x(), extent.high.x(), extent.low.y(),
               extent.high.y(), true});
  drawCells(panel, scene, metres_per_pixel);
  for (const auto& branch : scene.tree)
    panel.line(branch, {{0.00, 0.45, 0.70, 0.25}, 0.6, false, ""});
  drawFootprints(panel, scene);
  panel.line(scene.path, {report::kOrange, 2.5, false, ""});
  drawPose(panel, scene.T_map_start, 14.0 * metres_per_pixel, report::kGreen);
  drawPose(panel, scene.T_map_goal, 14.0 * metres_per_pixel, report::kRed);
  panel.finish();
  drawLegend(sheet, scene, box);
  sheet.save(path);
}

}  // namespace tread::plan
