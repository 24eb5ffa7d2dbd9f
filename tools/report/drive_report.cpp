// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/report/drive_report.hpp"

#include <algorithm>
#include <cmath>

#include "common/report/text.hpp"

namespace tread::report {
namespace {

double mean(const DriveRecord& drive, double report::PatternError::*error) {
  double sum = 0.0;
  for (const report::PatternError& at : drive.errors) sum += std::abs(at.*error);
  return sum / static_cast<double>(std::max<size_t>(1, drive.errors.size()));
}

std::string latencyLine(const char* name, const Durations& durations) {
  if (durations.count() == 0) return formatted("  %-22s none\n", name);
  return formatted("  %-22s p50 %7.1f ms  p99 %7.1f ms  of %zu\n", name, durations.quantile(0.5),
                   durations.quantile(0.99), durations.count());
}

/// Borders that the robot crossed, from the true surface along the way; short visits left out.
std::vector<report::BorderCrossing> crossingsOf(const DriveRecord& drive,
                                                const SimulationTruth& truth) {
  constexpr double kVisit = 0.5;  // [s]
  std::vector<report::BorderCrossing> crossings;
  std::string present;
  std::string perhaps;
  double since = 0.0;
  for (const sim::TruthRow& row : truth.rows) {
    if (row.utime < drive.begun || row.utime > drive.ended) continue;
    const double time = static_cast<double>(row.utime - drive.begun) * 1e-6;
    if (present.empty()) present = row.surface;
    if (row.surface != perhaps) since = time;
    perhaps = row.surface;
    if (perhaps == present || time - since < kVisit) continue;
    present = perhaps;
    crossings.push_back({since, present});
  }
  return crossings;
}

std::vector<report::RuleSeries> seriesOf(const RuleErrors& by_rule, int64_t begun) {
  std::vector<report::RuleSeries> series;
  for (size_t rule = 0; rule < by_rule.rules.size(); ++rule) {
    report::RuleSeries one;
    one.rule = learner::ruleName(by_rule.rules[rule]);
    for (const shadow::ShadowedExecution& execution : by_rule.executions)
      if (execution.measured)
        one.errors.push_back({static_cast<double>(execution.ended - begun) * 1e-6,
                              execution.by_rule[rule].position, execution.by_rule[rule].yaw});
    series.push_back(std::move(one));
  }
  return series;
}

}  // namespace

std::string resultLine(const DriveRecord& drive, const SimulationTruth& truth) {
  if (!drive.has_goal) return "no goal in this log";
  std::string line =
      drive.arrived
          ? formatted("arrived after %.1f s and %.1f m (straight line %.1f m)", drive.seconds(),
                      drive.distance(), drive.straightLine())
          : formatted("NOT ARRIVED after %.1f s and %.1f m", drive.seconds(), drive.distance());
  if (!drive.arrived && !drive.last_status.empty()) line += ": " + drive.last_status;
  line += formatted("; %d patterns driven, %d aborted, disarmed %d times", drive.completed,
                    drive.aborted, drive.disarmed);
  if (!truth.rows.empty()) line += formatted("; contacts %d", truth.rows.back().contacts);
  return line;
}

std::string wordsOf(const DriveRecord& drive, const SimulationTruth& truth,
                    const RuleErrors& by_rule) {
  std::string words = resultLine(drive, truth) + "\n";
  words += formatted("prediction error at a pattern's end: mean %.3f m, %.2f deg over %zu measured",
                     mean(drive, &report::PatternError::position),
                     mean(drive, &report::PatternError::yaw) * 180.0 / kPi, drive.errors.size());
  words += formatted(" (%d refused)\n", drive.refused);
  std::vector<int64_t> changes;
  for (const report::BorderCrossing& crossing : crossingsOf(drive, truth))
    changes.push_back(drive.begun + std::llround(crossing.time * 1e6));
  if (!by_rule.rules.empty()) words += wordsOf(by_rule, changes);
  words += "latency, as the logger received:\n";
  words += latencyLine("INS to learner's set", drive.latencies.insToSet());
  words += latencyLine("set to plan", drive.latencies.setToPlan());
  words += latencyLine("scan to tile", drive.latencies.scanToTile());
  if (!drive.problem.empty()) words += "the log: " + drive.problem + "\n";
  return words;
}

report::DriveScene sceneOf(const DriveRecord& drive, const SimulationTruth& truth,
                           const RuleErrors& by_rule) {
  report::DriveScene scene;
  scene.title = resultLine(drive, truth);
  if (truth.world) {
    scene.base_surface = truth.world->base_surface;
    for (const sim::SurfaceRegion& region : truth.world->regions)
      scene.patches.push_back({region.surface, region.corners});
    for (const sim::Obstacle& obstacle : truth.world->obstacles)
      scene.obstacles.push_back({obstacle.corners, obstacle.centre, obstacle.radius});
  }
  if (drive.map) scene.map = *drive.map;
  scene.tree = drive.tree;
  scene.track = drive.track;
  if (!drive.track.empty()) scene.T_map_start = drive.track.front().T_map_body;
  scene.T_map_goal = drive.T_map_goal;
  scene.errors = drive.errors;
  scene.by_rule = seriesOf(by_rule, drive.begun);
  scene.crossings = crossingsOf(drive, truth);
  scene.duration = drive.seconds();
  int contacts = 0;
  for (const sim::TruthRow& row : truth.rows) {
    if (row.contacts > contacts) scene.contacts.push_back(row.T_map_body.position());
    contacts = row.contacts;
  }
  return scene;
}

}  // namespace tread::report
