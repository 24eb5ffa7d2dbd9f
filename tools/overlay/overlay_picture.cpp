// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/overlay/drive_pieces.hpp"

#include <algorithm>

#include "common/report/plot.hpp"
#include "common/report/text.hpp"

namespace tread::overlay {
namespace {

using report::Box;
using report::Panel;
using report::Picture;
using report::Style;

constexpr double kDegrees = 180.0 / kPi;
constexpr size_t kColumns = 3;
constexpr size_t kRows = 2;
constexpr double kSide = 280.0;  // [pixels] of a piece's panel

using Points = std::vector<Eigen::Vector2d>;

Points pointsOf(const std::vector<Pose2>& poses) {
  Points points;
  for (const Pose2& pose : poses) points.push_back(pose.position());
  return points;
}

Style styleOf(const std::vector<std::string>& names, size_t model) {
  // The last model is the one to judge; the others are red and dashed.
  const bool last = model + 1 == names.size();
  return {last ? report::kBlue : report::kRed, last ? 2.0 : 1.8, !last, names[model]};
}

const Style kMeasured{report::kBlack, 4.0, false, "measured"};

void drawPiece(Picture& page, Box box, const Piece& piece, const std::vector<std::string>& names) {
  Points all = pointsOf(piece.measured);
  for (const auto& poses : piece.predicted)
    for (const Pose2& pose : poses) all.push_back(pose.position());
  Panel::Axes axes;
  axes.title = formatted("%.0f s after the beginning", piece.begin);
  axes.x_label = "ahead [m]";
  axes.equal = true;
  axes.x_min = axes.x_max = axes.y_min = axes.y_max = 0.0;
  for (const Eigen::Vector2d& point : all) {
    axes.x_min = std::min(axes.x_min, point.x() - 0.2);
    axes.x_max = std::max(axes.x_max, point.x() + 0.2);
    axes.y_min = std::min(axes.y_min, point.y() - 0.2);
    axes.y_max = std::max(axes.y_max, point.y() + 0.2);
  }
  Panel panel(page, box, axes);
  Style measured = kMeasured;
  measured.label.clear();
  panel.line(pointsOf(piece.measured), measured);
  for (size_t m = 0; m < names.size(); ++m) {
    Style style = styleOf(names, m);
    style.label.clear();
    panel.line(pointsOf(piece.predicted[m]), style);
    panel.dot(piece.predicted[m].back().position(), style.colour, 4.0);
  }
  panel.dot(piece.measured.back().position(), report::kBlack, 5.0);
  panel.finish();
}

/// Median error over the horizon; `yaw` chooses which.
void drawErrors(Picture& page, Box box, const std::vector<Piece>& pieces,
                const std::vector<std::string>& names, bool yaw) {
  const size_t samples = pieces.front().measured.size();
  std::vector<Points> curves(names.size());
  double highest = 0.0;
  for (size_t m = 0; m < names.size(); ++m)
    for (size_t i = 0; i < samples; ++i) {
      const Errors errors = medianErrors(pieces, m, i);
      const double value = yaw ? errors.yaw * kDegrees : errors.position;
      curves[m].emplace_back(kSample * static_cast<double>(i), value);
      highest = std::max(highest, value);
    }
  Panel::Axes axes;
  axes.title = yaw ? "median heading error" : "median position error";
  axes.x_label = "s after the last measured pose";
  axes.y_label = yaw ? "deg" : "m";
  axes.x_max = kSample * static_cast<double>(samples - 1);
  axes.y_max = highest > 0.0 ? 1.35 * highest : 1.0;
  Panel panel(page, box, axes);
  if (!yaw) panel.legendEntry(kMeasured);
  for (size_t m = 0; m < names.size(); ++m) panel.line(curves[m], styleOf(names, m));
  panel.finish();
}

}  // namespace

void drawOverlay(const std::string& path, const std::string& title,
                 const std::vector<Piece>& pieces, const std::vector<std::string>& model_names) {
  constexpr size_t kShown = kColumns * kRows;
  const double left = kColumns * (kSide + 50.0);
  Picture page(static_cast<int>(left + 400.0), static_cast<int>(kRows * (kSide + 70.0) + 60.0),
               title);
  for (size_t k = 0; k < std::min(kShown, pieces.size()); ++k) {
    const size_t chosen = pieces.size() <= kShown ? k : (2 * k + 1) * pieces.size() / (2 * kShown);
    const size_t row = k / kColumns, column = k % kColumns;
    const Box box{50.0 + static_cast<double>(column) * (kSide + 50.0),
                  70.0 + static_cast<double>(row) * (kSide + 70.0), kSide, kSide};
    drawPiece(page, box, pieces[chosen], model_names);
  }
  drawErrors(page, {left + 60.0, 70.0, 310.0, kSide}, pieces, model_names, false);
  drawErrors(page, {left + 60.0, 140.0 + kSide, 310.0, kSide}, pieces, model_names, true);
  page.save(path);
}

}  // namespace tread::overlay
