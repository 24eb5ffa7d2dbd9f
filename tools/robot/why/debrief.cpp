// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/why/debrief.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tread/plan_t.hpp>

#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::why {
namespace {

constexpr double kDetour = 1.3;      // [1] times the straight line
constexpr double kLostShare = 0.03;  // [1] of a process's messages between two of its HEALTH
constexpr int64_t kLostLeast = 5;
constexpr double kInTheWay = 3.0;     // [m] from the robot
constexpr int kGhostCells = 4;        // that appeared within a second
constexpr double kGhostPause = 12.0;  // [s] within which they are reported once

std::vector<double> errorsOf(const DriveTimeline& drive, double learning_t::*error) {
  std::vector<double> errors;
  for (const auto& pattern : drive.patterns)
    if (pattern.message.accepted && std::isfinite(pattern.message.*error))
      errors.push_back(std::abs(pattern.message.*error));
  return errors;
}

DriveFigures figuresOf(const DriveTimeline& drive) {
  DriveFigures figures;
  figures.duration = drive.duration;
  figures.distance = drive.distance;
  figures.goals = static_cast<int>(drive.goals.size());
  bool arrived = false;
  for (const PlanNote& plan : drive.plans) {
    const bool now = plan.state == plan_t::PLAN_ARRIVED;
    if (now && !arrived) ++figures.reached;
    arrived = now;
  }
  figures.patterns = drive.ended(execution_record_t::OUTCOME_COMPLETED);
  figures.aborted = drive.ended(execution_record_t::OUTCOME_ABORTED);
  figures.measured = static_cast<int>(
      std::count_if(drive.patterns.begin(), drive.patterns.end(),
                    [](const auto& pattern) { return pattern.message.accepted != 0; }));
  figures.error_position = upperMedian(errorsOf(drive, &learning_t::error_position), kNoFigure);
  figures.error_yaw = upperMedian(errorsOf(drive, &learning_t::error_yaw), kNoFigure);
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  figures.battery_begin = drive.battery.empty() ? unknown : drive.battery.front().second;
  figures.battery_end = drive.battery.empty() ? unknown : drive.battery.back().second;
  return figures;
}

bool isNear(const std::vector<Finding>& findings, double time, const std::string& process) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
    return finding.cause.rfind(process, 0) == 0 && time > finding.time - 3.0 &&
           time < finding.until + 10.0;
  });
}

/// Processes that died without stopping the robot.
void addProcesses(const DriveTimeline& drive, std::vector<Finding>& findings) {
  for (const auto& [process, notes] : drive.health) {
    for (size_t i = 1; i < notes.size(); ++i) {
      if (notes[i].message.boot_id == notes[i - 1].message.boot_id ||
          isNear(findings, notes[i].time, process))
        continue;
      findings.push_back({FindingKind::kProcess,
                          notes[i - 1].time,
                          notes[i].time,
                          process + "_died",
                          diedWords(process, true) + "; the robot was not stopped by it",
                          {deathEvidence(notes[i].time, process, true)}});
    }
    const auto death = drive.deathOf(process);
    if (!death || isNear(findings, *death, process)) continue;
    findings.push_back({FindingKind::kProcess,
                        *death,
                        drive.duration,
                        process + "_died",
                        diedWords(process, false),
                        {deathEvidence(*death, process, false)}});
  }
}

/// Complaints of processes, each once, unless a stop already reports it.
void addComplaints(const DriveTimeline& drive, std::vector<Finding>& findings) {
  const auto first = std::find_if(drive.plans.begin(), drive.plans.end(), [](const PlanNote& plan) {
    return plan.state == plan_t::PLAN_DRIVING;
  });
  const double first_drive = first == drive.plans.end() ? drive.duration : first->time;
  for (const auto& [process, notes] : drive.health)
    for (size_t i = 1; i < notes.size(); ++i) {
      const Said<health_t>& note = notes[i];
      if (isOk(note.message) || !isOk(notes[i - 1].message) || note.time < first_drive) continue;
      const bool told = std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
        return finding.kind == FindingKind::kStop && note.time > finding.time - 2.0 &&
               note.time < finding.until + 4.0;
      });
      if (told) continue;
      double until = note.time;
      for (size_t k = i; k < notes.size() && !isOk(notes[k].message); ++k) until = notes[k].time;
      const std::string& reason = note.message.health_reason;
      findings.push_back({FindingKind::kProcess,
                          note.time,
                          until,
                          process + "_complains",
                          process + " complained: " + reason,
                          {{note.time, "HEALTH", process + ": " + reason}}});
    }
}

/// Messages that processes missed.
void addLosses(const DriveTimeline& drive, std::vector<Finding>& findings) {
  for (const auto& [process, notes] : drive.health) {
    Finding finding;
    finding.kind = FindingKind::kMessages;
    int64_t lost = 0, late = 0, broken = 0;
    for (size_t i = 1; i < notes.size(); ++i) {
      const health_t &before = notes[i - 1].message, &now = notes[i].message;
      if (before.boot_id != now.boot_id) continue;
      // A larger loss within a second is a wrong counter.
      const int64_t missing = now.lost - before.lost > kMostLost ? 0 : now.lost - before.lost;
      const int64_t bad = missing + now.late - before.late + now.undecodable - before.undecodable;
      const int64_t all = now.received - before.received + missing;
      if (bad < kLostLeast || static_cast<double>(bad) < kLostShare * static_cast<double>(all))
        continue;
      if (finding.evidence.empty()) finding.time = notes[i - 1].time;
      finding.until = notes[i].time;
      lost += missing;
      late += now.late - before.late;
      broken += now.undecodable - before.undecodable;
      if (finding.evidence.size() < 3)
        finding.evidence.push_back(
            {notes[i].time, "HEALTH",
             process + formatted(": %lld lost, %lld late, %lld broken within a second",
                                 static_cast<long long>(missing),
                                 static_cast<long long>(now.late - before.late),
                                 static_cast<long long>(now.undecodable - before.undecodable))});
    }
    if (finding.evidence.empty()) continue;
    finding.cause = "lost_messages";
    finding.sentence =
        process + formatted(" missed messages: %lld lost, %lld late, %lld broken",
                            static_cast<long long>(lost), static_cast<long long>(late),
                            static_cast<long long>(broken));
    findings.push_back(std::move(finding));
  }
}

/// Obstacles that appeared and disappeared without stopping the robot.
void addGhosts(const DriveTimeline& drive, std::vector<Finding>& findings) {
  double told = -kGhostPause;
  for (const CellNote& first : drive.cells) {
    if (!first.came || first.time < told + kGhostPause) continue;
    const auto pose = drive.poseAt(first.time);
    if (!pose || (first.p_map - pose->position()).norm() > kInTheWay) continue;
    const auto ghost = drive.ghostAt(first.p_map, first.time - 1.0, first.time + 1.0);
    if (!ghost.alone || ghost.came < kGhostCells || ghost.went * 4 < ghost.came * 3) continue;
    told = first.time;
    const bool stopped = std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
      return finding.cause == "ghost" && std::abs(finding.time - first.time) < kGhostPause;
    });
    if (stopped) continue;
    findings.push_back(
        {FindingKind::kDetour,
         first.time,
         ghost.gone,
         "ghost",
         formatted("an obstacle appeared at x %.1f m, y %.1f m on ground that had been free, and "
                   "went again",
                   first.p_map.x(), first.p_map.y()),
         {{first.time, "MAP",
           formatted("%d cells became obstacles, %d went again by %.1f s, none is left", ghost.came,
                     ghost.went, ghost.gone)}}});
  }
}

/// Jumps or losses of the pose without a stop.
void addInsEvents(const DriveTimeline& drive, std::vector<Finding>& findings) {
  for (const InsNote& note : drive.ins) {
    if ((note.status & ins_t::STATUS_JUMP) == 0 || note.time < 1.0) continue;
    const bool told = std::any_of(findings.begin(), findings.end(), [&](const Finding& finding) {
      return std::abs(note.time - finding.time) < 3.0 && finding.cause.rfind("ins", 0) == 0;
    });
    if (told) continue;
    findings.push_back({FindingKind::kProcess,
                        note.time,
                        note.time,
                        "ins_jump",
                        "the INS jumped further than the vehicle can",
                        {{note.time, "INS", "STATUS_JUMP"}}});
  }
}

/// Length of the path between two times [m].
double wayBetween(const DriveTimeline& drive, double from, double to) {
  std::optional<Pose2> last;
  double way = 0.0;
  for (const InsNote& note : drive.ins) {
    if (note.time < from || note.time > to || !note.placed) continue;
    if (last && distanceBetween(*last, note.T_map_body) < 0.02) continue;
    if (last && (note.status & ins_t::STATUS_JUMP) == 0)
      way += distanceBetween(*last, note.T_map_body);
    last = note.T_map_body;
  }
  return way;
}

/// The first known obstacle on a line; nothing if the line is free.
std::optional<Eigen::Vector2d> firstObstacle(const TileMap& map, const Pose2& from,
                                             const Pose2& to) {
  const double length = distanceBetween(from, to);
  const Grid window =
      map.window({static_cast<int>(std::floor(std::min(from.x, to.x) / map.cellSize())) - 1,
                  static_cast<int>(std::floor(std::min(from.y, to.y) / map.cellSize())) - 1},
                 static_cast<int>(std::abs(from.x - to.x) / map.cellSize()) + 3,
                 static_cast<int>(std::abs(from.y - to.y) / map.cellSize()) + 3);
  for (double way = 0.0; way < length; way += map.cellSize() / 2.0) {
    const Eigen::Vector2d at =
        from.position() + (to.position() - from.position()) * (way / std::max(1e-9, length));
    if (window.at(window.indexOf(at)) == kObstacle) return at;
  }
  return std::nullopt;
}

/// Paths that were much longer than the straight line, and goals that were not reached.
void addGoals(const DriveTimeline& drive, std::vector<Finding>& findings) {
  for (size_t i = 0; i < drive.goals.size(); ++i) {
    const Note& goal = drive.goals[i];
    const double* const pose = drive.goals[i].message.goal_pose;
    const Pose2 T_map_goal{pose[0], pose[1], pose[2]};
    const double end = i + 1 < drive.goals.size() ? drive.goals[i + 1].time : drive.duration;
    double arrived = -1.0;
    const PlanNote* last = nullptr;
    for (const PlanNote& plan : drive.plans) {
      if (!plan.news) continue;
      if (plan.time > end) break;
      const bool follows = plan.time > goal.time + 0.3;
      if (follows && plan.state == plan_t::PLAN_ARRIVED && arrived < 0.0) arrived = plan.time;
      if (arrived < 0.0) last = &plan;
    }
    const auto start = drive.poseAt(goal.time);
    if (!start) continue;
    const double straight = distanceBetween(*start, T_map_goal);
    const double way = wayBetween(drive, goal.time, arrived < 0.0 ? end : arrived);
    Finding finding;
    finding.time = goal.time;
    finding.until = arrived < 0.0 ? end : arrived;
    if (arrived < 0.0 && i + 1 == drive.goals.size()) {
      finding.kind = FindingKind::kGoal;
      finding.cause = "goal_not_reached";
      finding.sentence =
          formatted("the goal at x %.1f m, y %.1f m was not reached", T_map_goal.x, T_map_goal.y);
      if (last != nullptr) {
        const bool drives = last->state == plan_t::PLAN_DRIVING || last->reason.words.empty();
        const std::string why =
            drives ? "the robot was still driving when the log ended" : last->reason.words;
        finding.sentence += ": " + why;
        finding.evidence.push_back({last->time, "PLAN", why});
      } else {
        finding.evidence.push_back({goal.time, "GOAL", "no plan followed"});
      }
      findings.push_back(std::move(finding));
    } else if (arrived >= 0.0 && straight > 3.0 && way > kDetour * straight) {
      finding.kind = FindingKind::kDetour;
      finding.cause = "detour";
      finding.sentence =
          formatted("the path was %.1f m long, the straight line %.1f m", way, straight);
      finding.evidence.push_back({arrived, "INS", formatted("%.1f m driven", way)});
      const auto obstacle =
          drive.map ? firstObstacle(*drive.map, *start, T_map_goal) : std::nullopt;
      if (obstacle) {
        const std::string where = formatted("x %.1f m, y %.1f m", obstacle->x(), obstacle->y());
        finding.sentence += ": the line is blocked at " + where;
        finding.evidence.push_back({arrived, "MAP", "an obstacle at " + where});
      } else {
        finding.sentence += ", which is free in the map at the end";
      }
      findings.push_back(std::move(finding));
    }
  }
}

/// Importance of a finding: unexpected stops most; obstacles and goals hardly any.
int weightOf(const Finding& finding) {
  const std::string& cause = finding.cause;
  if (cause == "obstacle" || cause == "no_way" || cause == "goal") return 1;
  if (cause == "ghost") return 3;
  switch (finding.kind) {
    case FindingKind::kStop:
      return 5;
    case FindingKind::kProcess:
      return 4;
    case FindingKind::kMessages:
    case FindingKind::kPrediction:
      return 2;
    default:
      return 0;
  }
}

}  // namespace

std::string diedWords(const std::string& process, bool started_again) {
  return process +
         (started_again ? " died and was started again" : " died, and nobody started it again");
}

Evidence deathEvidence(double time, const std::string& process, bool started_again) {
  return {time, "HEALTH", process + (started_again ? ": another boot_id" : ": its last message")};
}

const char* nameOf(FindingKind kind) {
  constexpr const char* kNames[] = {"stop", "process", "messages",  "detour",
                                    "goal", "refusal", "prediction"};
  return kNames[static_cast<size_t>(kind)];
}

const Finding* Debrief::worst() const {
  const Finding* worst = nullptr;
  for (const Finding& finding : findings)
    if (worst == nullptr || weightOf(finding) > weightOf(*worst)) worst = &finding;
  return worst;
}

Debrief debrief(const DriveTimeline& drive) {
  Debrief debrief;
  debrief.name = drive.name;
  debrief.problem = drive.problem;
  debrief.configs = drive.configs;
  debrief.findings = stopsOf(drive);
  debrief.figures = figuresOf(drive);
  debrief.figures.stops = static_cast<int>(debrief.findings.size());
  addProcesses(drive, debrief.findings);
  addInsEvents(drive, debrief.findings);
  addGhosts(drive, debrief.findings);
  addComplaints(drive, debrief.findings);
  addLosses(drive, debrief.findings);
  addGoals(drive, debrief.findings);
  for (Finding& finding : patternFindingsOf(drive)) debrief.findings.push_back(std::move(finding));
  std::stable_sort(debrief.findings.begin(), debrief.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.time < b.time; });
  return debrief;
}

}  // namespace tread::why
