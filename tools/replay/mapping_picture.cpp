// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/mapping_picture.hpp"

#include "common/report/plot.hpp"

namespace tread {

void drawMap(const MappingReplay& replay, const std::string& path) {
  picture::Picture canvas(1200, 1000, replay.name + " through mapping");
  const Grid& window = replay.window;
  const double size = window.cellSize();
  picture::Panel::Axes axes;
  axes.x_label = "x [m]";
  axes.y_label = "y [m]";
  axes.x_min = window.lower().x * size;
  axes.y_min = window.lower().y * size;
  axes.x_max = (window.lower().x + std::max(1, window.width())) * size;
  axes.y_max = (window.lower().y + std::max(1, window.height())) * size;
  axes.equal = true;
  picture::Panel panel(canvas, {80, 60, 1080, 860}, axes);
  panel.grid(window);
  std::vector<Eigen::Vector2d> way;
  for (const TimedPose& pose : replay.track) way.push_back(pose.T_map_body.position());
  picture::Style line;
  line.colour = picture::kOrange;
  line.label = "robot";
  panel.line(way, line);
  panel.legendEntry({picture::kBlack, 6.0, false, "obstacle"});
  panel.legendEntry({picture::kGrey, 6.0, false, "unknown"});
  panel.finish();
  canvas.save(path);
}

}  // namespace tread
