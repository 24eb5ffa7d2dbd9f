// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/report/drive_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "common/config/config_reader.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/report/text.hpp"
#include "common/vehicle/robot_description.hpp"

namespace tread::report {
namespace {

constexpr size_t kMostWaiting = 1000;

}  // namespace

void Latencies::note(Durations& durations, int64_t from, int64_t to) {
  if (from != kLost && to != kLost) durations.add(static_cast<double>(to - from) * 1e-3);
}

double Durations::quantile(double share) const {
  if (values_.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = values_;
  std::sort(sorted.begin(), sorted.end());
  const double rank = std::ceil(share * static_cast<double>(sorted.size())) - 1.0;
  return sorted[static_cast<size_t>(std::max(0.0, rank))];
}

void Latencies::add(const LogEvent& event, bool lost) {
  const int64_t received = lost ? kLost : event.utime;
  ins_t ins;
  scan_t scan;
  map_tile_t tile;
  plan_t plan;
  learning_t learning;
  pattern_set_part_t part;
  if (decode(event, kIns, ins)) {
    ins_.push_back({ins.utime, received});
    if (ins_.size() > kMostWaiting) ins_.pop_front();
  } else if (decode(event, kScan, scan)) {
    scans_.push_back({scan.utime, received});
    if (scans_.size() > kMostWaiting) scans_.pop_front();
  } else if (decode(event, kMap, tile)) {
    for (; !scans_.empty() && scans_.front().utime <= tile.utime; scans_.pop_front())
      note(scan_to_tile_, scans_.front().received, received);
  } else if (decode(event, kPlan, plan)) {
    const auto found = unplanned_.find(plan.set_version);
    if (found == unplanned_.end()) return;
    note(set_to_plan_, found->second, received);
    // Versions overtaken by a newer one were never used for planning.
    unplanned_.erase(unplanned_.begin(), std::next(found));
  } else if (decode(event, kLearning, learning)) {
    hear(learning);
  } else if (decode(event, kPatternSet, part)) {
    hear(part, received);
  }
}

void Latencies::hear(const learning_t& message) {
  if (!message.changed) return;
  const auto passed = std::find_if(ins_.begin(), ins_.end(),
                                   [&](const Received& at) { return at.utime >= message.utime; });
  if (passed == ins_.end()) return;
  const auto published = first_part_.find(message.result_version);
  if (published != first_part_.end())
    note(ins_to_set_, passed->received, published->second);
  else
    awaited_sets_[message.result_version] = passed->received;
}

void Latencies::hear(const pattern_set_part_t& message, int64_t received) {
  const int64_t version = message.set_version;
  if (first_part_.emplace(version, received).second) {
    const auto awaited = awaited_sets_.find(version);
    if (awaited != awaited_sets_.end()) {
      note(ins_to_set_, awaited->second, received);
      awaited_sets_.erase(awaited);
    }
  }
  // A repetition of a known version is not a new set.
  if (++parts_[version] == message.part_count && version > newest_version_) {
    // The first set of a log may have been in use long before.
    if (newest_version_ > 0) unplanned_[version] = received;
    newest_version_ = version;
  }
}

namespace {

/// The last plans before the goal are short, so the richest one farther away [m] is drawn.
constexpr double kNear = 8.0;
constexpr double kTrackStep = 0.05;  // [m]

bool isArrival(const PlanNote& plan) {
  return plan.goal_id != 0 && plan.state == plan_t::PLAN_ARRIVED;
}

bool arrivesNow(const DriveTimeline& log) {
  return !log.goals.empty() && !log.plans.empty() && isArrival(log.plans.back()) &&
         log.plans.back().event > log.goals.front().event;
}

/// The richest search tree on the way to the first goal.
void takeTree(const DriveEvent& event, const DriveTimeline& log, std::vector<TreeEdge>& richest) {
  plan_tree_t tree;
  if (!decode(event, kPlanTree, tree) || log.goals.empty() || log.ins.empty()) return;
  const InsNote& here = log.ins.back();
  const double* const goal = log.goals.back().message.goal_pose;
  const double to_go = (here.T_map_body.position() - Eigen::Vector2d(goal[0], goal[1])).norm();
  std::vector<TreeEdge> edges = edgesOf(tree);
  if (here.placed && to_go > kNear && edges.size() >= richest.size()) richest = std::move(edges);
}

/// From the first goal to the arrival.
void takeFirstDrive(DriveRecord& drive) {
  const DriveTimeline& log = drive.log;
  if (log.goals.empty()) return;
  const size_t begin = log.goals.front().event;
  drive.has_goal = true;
  drive.begun = drive.ended = log.goals.front().message.utime;
  size_t end = log.messages;
  auto [plan, last] = notesBetween(log.plans, begin, end);
  for (; plan != last && !drive.arrived; ++plan) {
    if (plan->goal_id == 0) continue;
    drive.last_status = plan->reason.words;
    drive.arrived = isArrival(*plan);
    if (drive.arrived) end = plan->event;
  }
  for (const auto& goal : log.goals)
    if (goal.event < end)
      drive.T_map_goal = {goal.message.goal_pose[0], goal.message.goal_pose[1],
                          goal.message.goal_pose[2]};
  const auto [ins, ins_end] = notesBetween(log.ins, begin, end);
  for (auto place = ins; place != ins_end; ++place) {
    if (!place->placed) continue;
    drive.ended = place->utime;
    drive.odometer.add(*place);
    if (drive.track.empty() ||
        distanceBetween(drive.track.back().T_map_body, place->T_map_body) > kTrackStep)
      drive.track.push_back({drive.sinceBegin(place->utime), place->T_map_body});
  }
  if (drive.arrived) drive.ended = std::prev(plan)->utime;
  drive.disarmed = static_cast<int>(
      std::count_if(log.losses.begin(), log.losses.end(),
                    [&](const PermissionLoss& loss) { return loss.had_it && loss.event < end; }));
}

void takePatterns(DriveRecord& drive) {
  for (const auto& pattern : drive.log.patterns) {
    const learning_t& message = pattern.message;
    drive.refused += message.accepted ? 0 : 1;
    if (message.accepted && std::isfinite(message.error_position))
      drive.errors.push_back(
          {drive.sinceBegin(message.utime), message.error_position, message.error_yaw});
  }
}

/// The robot's outline is in mapping's messages; older logs do not have it.
std::optional<FootprintSize> outlineIn(const DriveTimeline& log) {
  const auto config = log.configs.find("mapping");
  if (config == log.configs.end()) return std::nullopt;
  ConfigReader reader = ConfigReader::fromText(config->second, "CONFIG of mapping");
  if (!reader.has("robot")) return std::nullopt;
  return readRobot(reader).outline;
}

double mean(const DriveRecord& drive, double PatternError::*error) {
  double sum = 0.0;
  for (const PatternError& at : drive.errors) sum += std::abs(at.*error);
  return sum / static_cast<double>(std::max<size_t>(1, drive.errors.size()));
}

std::string latencyLine(const char* name, const Durations& durations) {
  if (durations.count() == 0) return formatted("  %-22s none\n", name);
  return formatted("  %-22s p50 %7.1f ms  p99 %7.1f ms  of %zu\n", name, durations.quantile(0.5),
                   durations.quantile(0.99), durations.count());
}

/// Borders that the robot crossed, from the true surface along its path; short visits are left out.
std::vector<Crossing> crossingsOf(const DriveRecord& drive, const SimulationTruth& truth) {
  constexpr double kVisit = 0.5;  // [s]
  std::vector<Crossing> crossings;
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
    crossings.push_back({since, present, perhaps});
    present = perhaps;
  }
  return crossings;
}

std::vector<RuleSeries> seriesOf(const RuleErrors& by_rule, int64_t begun) {
  std::vector<RuleSeries> series;
  for (size_t rule = 0; rule < by_rule.rules.size(); ++rule) {
    RuleSeries one;
    one.rule = by_rule.rules[rule];
    for (const report::ShadowedExecution& execution : by_rule.executions)
      if (execution.measured)
        one.errors.push_back({static_cast<double>(execution.ended - begun) * 1e-6,
                              execution.by_rule[rule].position, execution.by_rule[rule].yaw});
    series.push_back(std::move(one));
  }
  return series;
}

}  // namespace

double DriveRecord::straightLine() const {
  if (track.empty()) return 0.0;
  return (track.front().T_map_body.position() - T_map_goal.position()).norm();
}

DriveRecord readDrive(const std::vector<std::string>& logs) {
  DriveRecord drive;
  bool arrived = false;
  drive.log =
      timelineOf(DriveReader(logs), 0.0, [&](const DriveEvent& event, const DriveTimeline& log) {
        drive.latencies.add(event, event.wrong_time);
        arrived = arrived || arrivesNow(log);
        if (!arrived) takeTree(event, log, drive.tree);
      });
  // A file of another format has no messages.
  if (drive.log.messages == 0 && !drive.log.problem.empty())
    throw std::runtime_error(drive.log.problem);
  takeFirstDrive(drive);
  takePatterns(drive);
  drive.outline = outlineIn(drive.log);
  return drive;
}

namespace {

/// The outcome of the first drive.
std::string driveLine(const DriveRecord& drive, const SimulationTruth& truth) {
  if (!drive.has_goal) return "no goal in this log";
  std::string line =
      drive.arrived
          ? formatted("arrived after %.1f s and %.1f m (straight line %.1f m)", drive.seconds(),
                      drive.distance(), drive.straightLine())
          : formatted("NOT ARRIVED after %.1f s and %.1f m", drive.seconds(), drive.distance());
  if (!drive.arrived && !drive.last_status.empty()) line += ": " + drive.last_status;
  line += formatted("; %d patterns driven, %d aborted, disarmed %d times",
                    drive.log.ended(execution_record_t::OUTCOME_COMPLETED),
                    drive.log.ended(execution_record_t::OUTCOME_ABORTED), drive.disarmed);
  if (!truth.rows.empty()) line += formatted("; contacts %d", truth.rows.back().contacts);
  return line;
}

}  // namespace

std::string resultLine(const DriveRecord& drive, const SimulationTruth& truth) {
  const std::string more = drive.has_goal ? Chronicle(drive.log).summary(drive.disarmed) : "";
  return driveLine(drive, truth) + (more.empty() ? "" : "; " + more);
}

bool endedWell(const DriveRecord& drive, const SimulationTruth& truth) {
  const bool touched = !truth.rows.empty() && truth.rows.back().contacts > 0;
  return drive.arrived && Chronicle(drive.log).endsWell() && !touched;
}

std::string reportOf(const DriveRecord& drive, const SimulationTruth& truth,
                     const RuleErrors& by_rule) {
  std::string words = resultLine(drive, truth) + "\n" + Chronicle(drive.log).words() +
                      HandRecord(drive.log).words();
  words += formatted("prediction error at a pattern's end: mean %.3f m, %.2f deg over %zu measured",
                     mean(drive, &PatternError::position),
                     mean(drive, &PatternError::yaw) * 180.0 / kPi, drive.errors.size());
  words += formatted(" (%d refused)\n", drive.refused);
  std::vector<int64_t> changes;
  for (const Crossing& crossing : crossingsOf(drive, truth))
    changes.push_back(drive.begun + std::llround(crossing.time * 1e6));
  if (!by_rule.rules.empty()) words += reportOf(by_rule, changes);
  words += "latency, by the logger's reception times:\n";
  words += latencyLine("INS to learner's set", drive.latencies.insToSet());
  words += latencyLine("set to plan", drive.latencies.setToPlan());
  words += latencyLine("scan to tile", drive.latencies.scanToTile());
  if (!drive.log.problem.empty()) words += "the log: " + drive.log.problem + "\n";
  return words;
}

DriveScene sceneOf(const DriveRecord& drive, const SimulationTruth& truth,
                   const RuleErrors& by_rule) {
  DriveScene scene;
  scene.title = driveLine(drive, truth);
  scene.world = truth.world;
  if (drive.log.map) scene.map = *drive.log.map;
  scene.tree = drive.tree;
  scene.outline = drive.outline;
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
