// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/report/drive_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "common/config/config_reader.hpp"
#include "common/drive/drive_log.hpp"
#include "common/messages/ins_messages.hpp"
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
    // Versions that another has overtaken were never planned with.
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
  // A repetition of a version that is known already is nothing new to plan with.
  if (++parts_[version] == message.part_count && version > newest_version_) {
    // The first set of a log may have been planned with long before.
    if (newest_version_ > 0) unplanned_[version] = received;
    newest_version_ = version;
  }
}

namespace {

/// The last plans before the goal are short; the richest one made farther away [m] is drawn.
constexpr double kNear = 8.0;
constexpr double kTrackStep = 0.05;  // [m]

/// Takes in a log event by event.
class Reader {
 public:
  explicit Reader(DriveRecord& drive) : drive_(drive) {}

  void take(const DriveEvent& event) {
    event_ = &event;
    ++drive_.events;
    drive_.latencies.add(event, event.wrong_time);
    drive_.chronicle.take(event);
    drive_.hand.take(event);
    dispatch(
        event, [&](const auto& message) { hear(message); }, kIns, kGoal, kPlan, kPlanTree, kMap,
        kLearning, kExecution, kMotor, kConfig);
  }

 private:
  double sinceBegin(int64_t utime) const {
    return static_cast<double>(utime - drive_.begun) * 1e-6;
  }
  double toGo() const {
    if (drive_.track.empty()) return 0.0;
    return (drive_.track.back().T_map_body.position() - drive_.T_map_goal.position()).norm();
  }

  void hear(const ins_t& ins) {
    const auto pose = planarPose(ins);
    if (!pose || !drive_.has_goal || drive_.arrived) return;
    drive_.ended = ins.utime;
    drive_.odometer.add(*event_, ins);
    if (drive_.track.empty() ||
        (drive_.track.back().T_map_body.position() - pose->position()).norm() > kTrackStep)
      drive_.track.push_back({sinceBegin(ins.utime), *pose});
  }
  void hear(const goal_t& goal) {
    if (goal.goal_id == 0 || drive_.arrived) return;
    if (!drive_.has_goal) drive_.begun = drive_.ended = goal.utime;
    drive_.has_goal = true;
    drive_.T_map_goal = {goal.goal_pose[0], goal.goal_pose[1], goal.goal_pose[2]};
  }
  void hear(const plan_t& plan) {
    if (!drive_.has_goal || drive_.arrived || plan.goal_id == 0) return;
    drive_.last_status = plan.reason;
    if (plan.plan_status != plan_t::PLAN_ARRIVED) return;
    drive_.arrived = true;
    drive_.ended = plan.utime;
  }
  void hear(const plan_tree_t& tree) {
    std::vector<TreeEdge> edges = edgesOf(tree);
    if (toGo() > kNear && edges.size() >= drive_.tree.size()) drive_.tree = std::move(edges);
  }
  void hear(const map_tile_t& message) {
    if (!drive_.map) drive_.map = std::make_unique<TileMap>(message.cell_size, message.tile_cells);
    if (message.tile_cells != drive_.map->tileCells()) return;
    Tile tile;
    tile.tile_x = message.tile_x;
    tile.tile_y = message.tile_y;
    tile.utime = message.utime;
    tile.cells = message.cells;
    drive_.map->put(std::move(tile));
  }
  void hear(const learning_t& message) {
    if (!message.accepted) ++drive_.refused;
    if (message.accepted && std::isfinite(message.error_position))
      drive_.errors.push_back(
          {sinceBegin(message.utime), message.error_position, message.error_yaw});
  }
  void hear(const execution_t& message) {
    for (const execution_record_t& record : message.records) {
      if (record.outcome == execution_record_t::OUTCOME_RUNNING) continue;
      if (!ended_.insert(keyOf(record)).second) continue;
      ++(record.outcome == execution_record_t::OUTCOME_COMPLETED ? drive_.completed
                                                                 : drive_.aborted);
    }
  }
  /// Mapping says which robot it was; logs from before robots were described do not.
  void hear(const config_t& config) {
    if (config.config_process != "mapping" || drive_.outline) return;
    ConfigReader reader = ConfigReader::fromText(config.config_text, "CONFIG of mapping");
    if (reader.has("robot")) drive_.outline = readRobot(reader).outline;
  }
  void hear(const motor_t& motor) {
    const bool may = mayDrive(motor.bridge_state);
    if (may_drive_ && !may && !drive_.arrived) ++drive_.disarmed;
    may_drive_ = may;
  }

  DriveRecord& drive_;
  const DriveEvent* event_ = nullptr;  // that is taken
  std::set<ExecutionKey> ended_;
  bool may_drive_ = false;
};

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

/// Borders that the robot crossed, from the true surface along the way; short visits left out.
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
  Reader reader(drive);
  DriveReader log(logs);
  for (DriveEvent event; log.next(event);) reader.take(event);
  drive.problem = log.problem();
  // A file of another kind has nothing to tell.
  if (drive.events == 0 && !drive.problem.empty()) throw std::runtime_error(drive.problem);
  return drive;
}

namespace {

/// What became of the first drive.
std::string driveLine(const DriveRecord& drive, const SimulationTruth& truth) {
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

}  // namespace

std::string resultLine(const DriveRecord& drive, const SimulationTruth& truth) {
  const std::string more = drive.has_goal ? drive.chronicle.summary(drive.disarmed) : "";
  return driveLine(drive, truth) + (more.empty() ? "" : "; " + more);
}

bool endedWell(const DriveRecord& drive, const SimulationTruth& truth) {
  const bool touched = !truth.rows.empty() && truth.rows.back().contacts > 0;
  return drive.arrived && drive.chronicle.endsWell() && !touched;
}

std::string reportOf(const DriveRecord& drive, const SimulationTruth& truth,
                     const RuleErrors& by_rule) {
  std::string words =
      resultLine(drive, truth) + "\n" + drive.chronicle.words() + drive.hand.words();
  words += formatted("prediction error at a pattern's end: mean %.3f m, %.2f deg over %zu measured",
                     mean(drive, &PatternError::position),
                     mean(drive, &PatternError::yaw) * 180.0 / kPi, drive.errors.size());
  words += formatted(" (%d refused)\n", drive.refused);
  std::vector<int64_t> changes;
  for (const Crossing& crossing : crossingsOf(drive, truth))
    changes.push_back(drive.begun + std::llround(crossing.time * 1e6));
  if (!by_rule.rules.empty()) words += reportOf(by_rule, changes);
  words += "latency, as the logger received:\n";
  words += latencyLine("INS to learner's set", drive.latencies.insToSet());
  words += latencyLine("set to plan", drive.latencies.setToPlan());
  words += latencyLine("scan to tile", drive.latencies.scanToTile());
  if (!drive.problem.empty()) words += "the log: " + drive.problem + "\n";
  return words;
}

DriveScene sceneOf(const DriveRecord& drive, const SimulationTruth& truth,
                   const RuleErrors& by_rule) {
  DriveScene scene;
  scene.title = driveLine(drive, truth);
  scene.world = truth.world;
  if (drive.map) scene.map = *drive.map;
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
