// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <set>

#include "common/report/plot.hpp"
#include "tools/replay/learner_report.hpp"

namespace tread::replay {
namespace {

using report::Panel;
using report::Picture;
using Error = double (*)(const learning_t&);

constexpr double kDegrees = 180.0 / kPi;
/// Executions in the running mean of the curves.
constexpr size_t kRunning = 15;

double positionError(const learning_t& learned) {
  return learned.error_position;
}
double yawError(const learning_t& learned) {
  return std::abs(learned.error_yaw) * kDegrees;
}

std::vector<Eigen::Vector2d> runningMean(const std::vector<learning_t>& learned, Error error) {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> values;
  for (const learning_t& one : learned) {
    if (!one.accepted || !std::isfinite(one.error_position)) continue;
    values.push_back(error(one));
    const size_t from = values.size() > kRunning ? values.size() - kRunning : 0;
    double sum = 0.0;
    for (size_t i = from; i < values.size(); ++i) sum += values[i];
    points.emplace_back(static_cast<double>(values.size()),
                        sum / static_cast<double>(values.size() - from));
  }
  return points;
}

void drawCurves(Picture& canvas, const report::Box& box, const std::vector<LearnerRun>& runs,
                Error error, const std::string& label) {
  double highest = 0.0;
  double longest = 2.0;
  for (const LearnerRun& run : runs)
    for (const auto& point : runningMean(run.learned, error)) {
      highest = std::max(highest, point.y());
      longest = std::max(longest, point.x());
    }
  Panel::Axes axes;
  axes.title = "running mean of " + std::to_string(kRunning) + " executions";
  axes.x_label = "execution";
  axes.y_label = label;
  axes.x_min = 1.0;
  axes.x_max = longest;
  axes.y_max = highest > 0.0 ? 1.1 * highest : 1.0;
  Panel panel(canvas, box, axes);
  for (size_t r = 0; r < runs.size(); ++r) {
    report::Style style;
    style.colour = r == 0 ? report::kGrey : report::seriesColour(r - 1);
    style.width = 2.0;
    style.label = runs[r].title;
    panel.line(runningMean(runs[r].learned, error), style);
  }
  panel.finish();
}

/// Mean error of the executions of one class of command.
double meanOf(const LearnerRun& run, const PatternSet& set, const std::string& name, Error error) {
  double sum = 0.0;
  int count = 0;
  for (const learning_t& one : run.learned) {
    const MotionPattern* pattern = set.find(one.learned_pattern_id);
    if (pattern == nullptr || !one.accepted || !std::isfinite(one.error_position)) continue;
    if (commandClass(*pattern) != name) continue;
    sum += error(one);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

void drawBars(Picture& canvas, const report::Box& box, const PatternSet& set,
              const std::vector<LearnerRun>& runs, Error error, const std::string& label) {
  std::set<std::string> known;
  for (const learning_t& one : runs.front().learned)
    if (const MotionPattern* pattern = set.find(one.learned_pattern_id))
      if (one.accepted) known.insert(commandClass(*pattern));
  const std::vector<std::string> names(known.begin(), known.end());
  double highest = 0.0;
  for (const std::string& name : names)
    for (const LearnerRun& run : runs) highest = std::max(highest, meanOf(run, set, name, error));
  Panel::Axes axes;
  axes.title = "mean by command";
  axes.y_label = label;
  axes.x_min = -0.6;
  axes.x_max = std::max(1.0, static_cast<double>(names.size())) - 0.4;
  axes.y_max = highest > 0.0 ? 1.1 * highest : 1.0;
  Panel panel(canvas, box, axes);
  panel.xNames(names);
  const double width = 0.8 / static_cast<double>(runs.size());
  for (size_t n = 0; n < names.size(); ++n)
    for (size_t r = 0; r < runs.size(); ++r) {
      const double at = static_cast<double>(n) - 0.4 + (static_cast<double>(r) + 0.5) * width;
      panel.bar(at, meanOf(runs[r], set, names[n], error), 0.9 * width,
                r == 0 ? report::kGrey : report::seriesColour(r - 1));
    }
  panel.finish();
}

}  // namespace

void drawReport(const DriveLog& log, const PatternSet& set, const std::vector<LearnerRun>& runs,
                const std::string& path) {
  Picture canvas(1200, 800, log.name + ": error of predicted ends of executions");
  drawCurves(canvas, {70, 60, 500, 310}, runs, positionError, "position error [m]");
  drawCurves(canvas, {660, 60, 500, 310}, runs, yawError, "yaw error [deg]");
  drawBars(canvas, {70, 440, 500, 300}, set, runs, positionError, "position error [m]");
  drawBars(canvas, {660, 440, 500, 300}, set, runs, yawError, "yaw error [deg]");
  canvas.save(path);
}

}  // namespace tread::replay
