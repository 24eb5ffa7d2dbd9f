// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/adaptation/ratio_picture.hpp"

#include <algorithm>
#include <cmath>

#include "common/report/plot.hpp"

namespace tread::adaptation {
namespace {

constexpr size_t kShown = 5;                                                     // [s] ahead
constexpr double kWidth = 400.0, kHeight = 230.0, kGap = 70.0, kLegend = 170.0;  // [pixels]

/// The judged rule black and thick, no learning grey, the others in colours.
report::Style styleOf(const std::vector<std::string>& rules, const std::string& rule) {
  constexpr size_t kColours = 6;
  if (rule == kJudged) return {report::kBlack, 3.0, false, rule};
  if (rule == kOff || rule == kHindsight) return {report::kGrey, 1.5, rule == kHindsight, rule};
  const auto place = std::find(rules.begin(), rules.end(), rule);
  const auto before = static_cast<size_t>(std::count_if(rules.begin(), place, [](const auto& one) {
    return one != kJudged && one != kOff && one != kHindsight;
  }));
  return {report::seriesColour(before), 1.5, before >= kColours, rule};
}

void drawPanel(report::Picture& picture, const report::Box& box, const Group& group,
               const std::vector<std::string>& rules, bool yaw) {
  report::Panel::Axes axes;
  axes.title = std::string(yaw ? "yaw" : "position") + ": " + nameOf(group.kind) + " left out, " +
               group.vehicle.substr(0, group.vehicle.find(" ("));
  axes.x_label = "executions before";
  axes.x_min = -0.3;
  axes.x_max = static_cast<double>(kExecutions.size()) - 0.7;
  axes.y_min = axes.y_max = 1.0;
  std::vector<std::vector<Eigen::Vector2d>> curves;
  for (const std::string& rule : group.rules) {
    curves.emplace_back();
    for (size_t k = 0; k < kExecutions.size(); ++k) {
      const SummaryLine& line = group.of(rule, kExecutions[k]);
      const double ratio = (yaw ? line.yaw : line.position).ratio.value;
      if (!std::isfinite(ratio)) continue;
      curves.back().emplace_back(static_cast<double>(k), ratio);
      axes.y_min = std::min(axes.y_min, ratio);
      axes.y_max = std::max(axes.y_max, ratio);
    }
  }
  const double air = 0.1 * std::max(0.1, axes.y_max - axes.y_min);
  axes.y_min -= air;
  axes.y_max += air;
  report::Panel panel(picture, box, axes);
  std::vector<std::string> names;
  for (const size_t k : kExecutions) names.push_back(std::to_string(k));
  panel.xNames(names);
  for (size_t i = 0; i < curves.size(); ++i) {
    report::Style style = styleOf(rules, group.rules[i]);
    style.label.clear();
    panel.line(curves[i], style);
  }
  panel.finish();
}

void drawLegend(report::Picture& picture, double x, const std::vector<std::string>& rules) {
  double y = 80.0;
  for (const std::string& rule : rules) {
    const report::Style style = styleOf(rules, rule);
    const double dash = style.dashed ? 10.0 : 26.0;
    for (const double begin : {0.0, 16.0})
      if (begin == 0.0 || style.dashed)
        picture.fill({x + begin, y - 5.0, dash, style.width}, style.colour);
    picture.text(x + 34.0, y, rule, 12.0);
    y += 20.0;
  }
}

}  // namespace

void drawRatios(const std::string& path, const std::vector<Group>& groups) {
  std::vector<const Group*> shown;
  std::vector<std::string> rules;
  for (const Group& group : groups) {
    if (group.horizon != kShown) continue;
    shown.push_back(&group);
    if (group.rules.size() > rules.size()) rules = group.rules;
  }
  const double right = 60.0 + 2.0 * (kWidth + kGap);
  report::Picture picture(
      static_cast<int>(right + kLegend),
      static_cast<int>(static_cast<double>(shown.size()) * (kHeight + kGap) + 60.0),
      "Error relative to no learning, " + std::to_string(kShown) + " s ahead, open loop");
  for (size_t row = 0; row < shown.size(); ++row)
    for (const bool yaw : {false, true})
      drawPanel(picture,
                {60.0 + (yaw ? kWidth + kGap : 0.0),
                 60.0 + static_cast<double>(row) * (kHeight + kGap), kWidth, kHeight},
                *shown[row], rules, yaw);
  drawLegend(picture, right - 0.5 * kGap, rules);
  picture.save(path);
}

}  // namespace tread::adaptation
