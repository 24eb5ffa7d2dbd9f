// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/setup_report.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/degrees.hpp"
#include "common/report/chart.hpp"
#include "common/report/page.hpp"
#include "common/report/text.hpp"

namespace tread::setup {
namespace {

using report::Chart;
using report::ChartPoint;
using report::ChartRange;

std::string pathChart(const std::string& title, const std::vector<Pose2>& track,
                      const std::vector<ChartPoint>& marks) {
  ChartRange range = ChartRange::empty();
  std::vector<ChartPoint> points;
  for (const Pose2& pose : track) {
    points.push_back({pose.x, pose.y});
    range.include(points.back());
  }
  for (const ChartPoint& mark : marks) range.include(mark);
  if (points.empty()) return "";
  Chart chart(title, "east [m]", "north [m]", range.widened(1.0).withEqualScales());
  chart.line(points, report::kAfterColour);
  chart.dot(points.front(), report::kInk);
  for (const ChartPoint& mark : marks) chart.dot(mark, report::kBeforeColour, false);
  return chart.svg();
}

/// Chart of the INS's speed over time, with the mean command scaled to full speed.
std::string speedChart(const GroundReport& ground, bool is_car) {
  std::vector<ChartPoint> measured, commanded;
  ChartRange range = ChartRange::empty();
  if (ground.fixes.size() < 10 || ground.commands.empty()) return "";
  const int64_t start = ground.commands.front().utime;
  const auto seconds = [start](int64_t utime) { return 1e-6 * static_cast<double>(utime - start); };
  for (size_t i = 5; i < ground.fixes.size(); i += 5) {
    const TimedPose &a = ground.fixes[i - 5], &b = ground.fixes[i];
    const double time = seconds(b.utime) - seconds(a.utime);
    if (time <= 0.0) continue;
    const double yaw = b.T_map_body.yaw - ground.wiring.mounting_yaw.value;
    const Eigen::Vector2d moved = b.T_map_body.position() - a.T_map_body.position();
    measured.push_back(
        {seconds(b.utime), (std::cos(yaw) * moved.x() + std::sin(yaw) * moved.y()) / time});
    range.include(measured.back());
  }
  for (const TimedCommand& given : ground.commands) {
    // For a car the second channel is the steering.
    const double share = is_car ? given.command[0] : 0.5 * (given.command[0] + given.command[1]);
    commanded.push_back({seconds(given.utime), share * ground.wiring.fullSpeed()});
    range.include(commanded.back());
  }
  Chart chart("What was commanded, and what it did", "time [s]", "ahead [m/s]", range.widened(0.5));
  chart.line(commanded, report::kBeforeColour, 1.0);
  chart.line(measured, report::kAfterColour, 1.0);
  chart.legend("commanded, as configured", report::kBeforeColour);
  chart.legend("measured", report::kAfterColour);
  return chart.svg();
}

std::string patternChart(const PatternSet& set) {
  ChartRange range = ChartRange::empty();
  for (const MotionPattern& pattern : set.patterns())
    for (const Pose2& pose : pattern.trajectory) range.include({pose.x, pose.y});
  Chart chart("Its patterns, as driven", "ahead [m]", "left [m]",
              range.widened(0.5).withEqualScales());
  for (const MotionPattern& pattern : set.patterns()) {
    std::vector<ChartPoint> points{{0.0, 0.0}};
    for (const Pose2& pose : pattern.trajectory) points.push_back({pose.x, pose.y});
    chart.line(points, report::kAfterColour, 1.2);
  }
  return chart.svg();
}

std::vector<std::string> row(const std::string& what, const ConfidenceInterval& value,
                             const std::string& unit, int decimals, double scale = 1.0) {
  return {what, fixed(scale * value.value, decimals) + " " + unit,
          fixed(scale * value.low, decimals) + " to " + fixed(scale * value.high, decimals)};
}

report::Table measuredTable(const commissioning::WiringReport& wiring, bool is_car) {
  const double degrees = toDegrees(1.0);
  using Rows = std::vector<std::vector<std::string>>;
  Rows rows =
      is_car ? Rows{row("speed at full throttle", wiring.full_left, "m/s", 2),
                    row("wheels at full steering to the left", wiring.steering_left, "deg", 1,
                        degrees),
                    row("the same to the right", wiring.steering_right, "deg", 1, degrees),
                    row("wheels without steering", wiring.steering_straight, "deg", 1, degrees),
                    row("lag of the steering", wiring.steering_lag, "s", 2)}
             : Rows{row("left track at full command", wiring.full_left, "m/s", 2),
                    row("right track at full command", wiring.full_right, "m/s", 2),
                    row("effective track width", wiring.gauge, "m", 2)};
  const Rows both{
      row("delay of a command", wiring.delay, "s", 2),
      row("lag of the motors", wiring.lag, "s", 2),
      row("commands that move nothing", wiring.dead_power, "%", 0, 100.0),
      row("INS yaw relative to its given mounting", wiring.mounting_yaw, "deg", 1, degrees),
      row("INS ahead of its given position", wiring.antenna_x, "m", 2),
      row("INS left of its given position", wiring.antenna_y, "m", 2)};
  rows.insert(rows.end(), both.begin(), both.end());
  return {{"measured", "value", "95 %"}, rows, 1};
}

report::Table deviceTable(const RobotFindings& found) {
  return {{"device", "kind", "port"},
          {{"INS", found.ins.kind, found.ins.address},
           {"motor controller", found.controller.kind, found.controller.address},
           {"range finder", found.range_finder.kind, found.range_finder.address}},
          3};
}

}  // namespace

std::string reportOf(const SetupResult& result) {
  const RobotFindings& found = result.findings;
  report::Page page;
  page.title = "Setup of " + found.robot.name;
  page.mood = result.problem.empty() ? "good" : "doubt";
  page.verdict = result.problem.empty()
                     ? found.robot.name + " is set up: first goal reached after " +
                           fixed(result.minutes, 0) + " minutes"
                     : found.robot.name + " is not set up: " + result.problem;
  page.first.emplace_back(deviceTable(found));
  std::vector<Pose2> circle;
  for (const TimedPose& fix : result.ground.fixes) circle.push_back(fix.T_map_body);
  report::Pictures pictures;
  if (!circle.empty()) pictures.svg.push_back(pathChart("The minute in the circle", circle, {}));
  const std::string speeds = speedChart(result.ground, found.robot.drive.isCar());
  if (!speeds.empty()) pictures.svg.push_back(speeds);
  if (result.recorded) pictures.svg.push_back(patternChart(result.recorded->patterns));
  if (!result.goal.track.empty())
    pictures.svg.push_back(pathChart("To the first goal", result.goal.track, {}));
  if (!pictures.svg.empty()) page.first.emplace_back(pictures);
  if (!result.ground.fixes.empty()) {
    report::Section section{"What was measured", {}};
    section.blocks.emplace_back(measuredTable(result.ground.wiring, found.robot.drive.isCar()));
    report::Points faults;
    for (const commissioning::WiringFault& fault : result.ground.wiring.faults)
      faults.items.push_back(fault.words);
    if (!faults.items.empty()) section.blocks.emplace_back(faults);
    page.sections.push_back(section);
  }
  if (!result.checks.empty()) {
    report::Points points;
    for (const FitCheck& check : result.checks)
      points.items.push_back((check.good ? "fits: " : "DOES NOT FIT: ") + check.words);
    page.sections.push_back({"What must fit together", {points}});
  }
  return report::htmlOf(page);
}

}  // namespace tread::setup
