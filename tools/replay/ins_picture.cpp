// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/ins_picture.hpp"

#include <algorithm>
#include <cmath>

#include "common/messages/ins_messages.hpp"
#include "common/report/plot.hpp"

namespace tread {
namespace {

/// Headings drawn along a track, whatever its length.
constexpr size_t kHeadings = 40;

std::vector<Pose2> posesOf(const InsReplay& replay) {
  std::vector<Pose2> poses;
  for (const ins_t& message : replay.track)
    if (const auto pose = planarPose(message)) poses.push_back(*pose);
  return poses;
}

picture::Panel::Axes axesAround(const std::vector<Pose2>& poses) {
  Eigen::Array2d low = poses.front().position().array();
  Eigen::Array2d high = low;
  for (const Pose2& pose : poses) {
    low = low.min(pose.position().array());
    high = high.max(pose.position().array());
  }
  const double margin = std::max(1.0, 0.05 * (high - low).maxCoeff());
  picture::Panel::Axes axes;
  axes.x_label = "x [m]";
  axes.y_label = "y [m]";
  axes.x_min = low.x() - margin;
  axes.x_max = high.x() + margin;
  axes.y_min = low.y() - margin;
  axes.y_max = high.y() + margin;
  axes.equal = true;
  return axes;
}

}  // namespace

void drawTrack(const InsReplay& replay, const std::string& title, const std::string& path) {
  picture::Picture canvas(900, 900, title);
  const std::vector<Pose2> poses = posesOf(replay);
  if (poses.empty()) {
    canvas.text(60, 100, "no pose in this log");
    return canvas.save(path);
  }
  const picture::Panel::Axes axes = axesAround(poses);
  picture::Panel panel(canvas, {80, 60, 780, 760}, axes);
  std::vector<Eigen::Vector2d> track;
  track.reserve(poses.size());
  for (const Pose2& pose : poses) track.push_back(pose.position());
  picture::Style line;
  line.colour = picture::kBlue;
  line.label = "position";
  panel.line(track, line);
  const double length = 0.03 * std::max(axes.x_max - axes.x_min, axes.y_max - axes.y_min);
  picture::Style heading;
  heading.colour = picture::kOrange;
  heading.label = "heading";
  for (size_t i = 0; i < poses.size(); i += std::max<size_t>(1, poses.size() / kHeadings)) {
    panel.line({poses[i].position(), poses[i] * Eigen::Vector2d(length, 0.0)}, heading);
    heading.label.clear();
  }
  panel.dot(track.front(), picture::kGreen, 6.0);
  panel.dot(track.back(), picture::kRed, 6.0);
  panel.finish();
  canvas.save(path);
}

}  // namespace tread
