// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/why/drive_timeline.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "common/drive/odometer.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/messages/pattern_messages.hpp"

namespace tread::why {
namespace {

constexpr double kInsStep = 0.1;      // [s] between notes
constexpr double kBatteryStep = 1.0;  // [s] the same
constexpr double kCellReach = 8.0;    // [m] from the robot
constexpr double kDead = 2.5;         // [s] without HEALTH, which comes every second
constexpr double kGhostSize = 0.7;    // [m]
constexpr double kGhostLife = 12.0;   // [s]
constexpr double kAlone = 0.4;        // [m] flickering beside a wall is no ghost

class TimelineReader {
 public:
  explicit TimelineReader(DriveTimeline& drive) : drive_(drive) {}

  void take(const DriveEvent& event) {
    event_ = &event;
    if (drive_.begun < 0) drive_.begun = event.utime;
    now_ = static_cast<double>(event.utime - drive_.begun) * 1e-6;
    drive_.duration = std::max(drive_.duration, now_);
    if (event.channel != kHealth.name) drive_.heard[event.channel].push_back(now_);
    dispatch(
        event, [this](const auto& message) { hear(message); }, kIns, kMotor, kPlan, kHealth,
        kLearning, kExecution, kGoal, kMap, kArm, kEstop, kFence, kMark, kConfig);
  }

 private:
  void hear(const ins_t& ins) {
    auto pose = planarPose(ins);
    if (pose && pose->position().norm() > kFarthestPlace) pose.reset();
    if (pose) last_ = pose;
    odometer_.add(*event_, ins);
    drive_.distance = odometer_.distance();
    const bool same = !drive_.ins.empty() && drive_.ins.back().status == ins.ins_status;
    if (same && now_ - drive_.ins.back().time < kInsStep) return;
    drive_.ins.push_back(
        {now_, ins.ins_status, pose.value_or(Pose2{}), pose.has_value(), tilt(ins).inclination});
  }

  void hear(const motor_t& motor) {
    std::vector<StateNote>& notes = drive_.motors;
    const Reason reason(stopReasonFrom(motor.state_code), motor.state_reason);
    if (notes.empty() || notes.back().state != motor.bridge_state || notes.back().reason != reason)
      notes.push_back({now_, motor.bridge_state, reason});

    if (std::isfinite(motor.battery_voltage) &&
        (drive_.battery.empty() || now_ - drive_.battery.back().first >= kBatteryStep))
      drive_.battery.emplace_back(now_, static_cast<double>(motor.battery_voltage));
  }

  void hear(const plan_t& plan) {
    std::vector<StateNote>& notes = drive_.plans;
    // While it drives the reason tells of a stop that is planned.
    Reason reason;
    if (plan.plan_status != plan_t::PLAN_DRIVING)
      reason = {stopReasonFrom(plan.reason_code), plan.reason};
    if (notes.empty() || notes.back().state != plan.plan_status || notes.back().reason != reason)
      notes.push_back({now_, plan.plan_status, reason});
  }

  void hear(const health_t& health) {
    HealthNote note{now_,
                    health.boot_id,
                    health.health_state == health_t::HEALTH_OK,
                    health.health_reason,
                    health.received,
                    health.undecodable,
                    health.lost,
                    health.late,
                    {}};
    for (const counter_t& counter : health.counters)
      note.counters[counter.counter_name] = counter.counted;
    drive_.health[health.process].push_back(std::move(note));
  }

  void hear(const learning_t& learning) {
    PatternNote note;
    note.time = now_;
    note.pattern = learning.learned_pattern_name;
    note.accepted = learning.accepted != 0;
    note.words = learning.accepted ? learning.change_reason : learning.gate_reason;
    note.position = learning.error_position;
    note.yaw = learning.error_yaw;
    note.path = learning.path_length;
    note.ground_changed = learning.ground_changed;
    note.surface = learning.surface;
    drive_.patterns.push_back(std::move(note));
  }

  void hear(const execution_t& executions) {
    for (const execution_record_t& record : executions.records) {
      if (record.outcome == execution_record_t::OUTCOME_RUNNING) continue;
      if (!ended_.insert(keyOf(record)).second) continue;
      if (record.outcome == execution_record_t::OUTCOME_ABORTED)
        drive_.aborts.push_back({now_,
                                 record.record_pattern_id,
                                 {stopReasonFrom(record.outcome_code), record.outcome_reason}});
      else
        ++drive_.completed;
    }
  }

  void hear(const goal_t& goal) {
    if (goal.goal_id == 0 || (!drive_.goals.empty() && drive_.goals.back().id == goal.goal_id))
      return;
    drive_.goals.push_back(
        {now_, goal.goal_id, {goal.goal_pose[0], goal.goal_pose[1], goal.goal_pose[2]}});
  }

  void hear(const map_tile_t& message) {
    if (!isPossibleTile(message)) return;
    if (!drive_.map) drive_.map = std::make_unique<TileMap>(message.cell_size, message.tile_cells);
    if (message.tile_cells != drive_.map->tileCells() ||
        message.cell_size != drive_.map->cellSize())
      return;
    compare(message);
    drive_.map->put({message.tile_x, message.tile_y, message.utime, message.cells});
  }

  /// What came and went since the tile before; unknown ground that turns out blocked is no news.
  void compare(const map_tile_t& message) {
    const auto known = drive_.map->tiles().find({message.tile_x, message.tile_y});
    if (known == drive_.map->tiles().end() || !last_) return;
    const std::vector<uint8_t>& before = known->second.cells;
    if (before.size() != message.cells.size()) return;
    for (size_t i = 0; i < before.size(); ++i) {
      const bool came = isFree(before[i]) && message.cells[i] == kObstacle;
      const bool went = before[i] == kObstacle && isFree(message.cells[i]);
      if (!came && !went) continue;
      const int side = message.tile_cells;
      const Eigen::Vector2d p_map(
          (message.tile_x * side + static_cast<int>(i) % side + 0.5) * message.cell_size,
          (message.tile_y * side + static_cast<int>(i) / side + 0.5) * message.cell_size);
      if ((p_map - last_->position()).norm() < kCellReach)
        drive_.cells.push_back({now_, p_map, came});
    }
  }

  void person(const std::string& who, const std::string& what) {
    if (!drive_.people.empty() && drive_.people.back().who == who &&
        drive_.people.back().what == what && now_ - drive_.people.back().time < 2.0)
      return;
    drive_.people.push_back({now_, who, what});
  }
  void hear(const arm_t& arm) {
    person(arm.armed_by, (arm.armed ? "arms" : "disarms") +
                             (arm.arm_reason.empty() ? "" : ": " + arm.arm_reason));
  }
  void hear(const estop_t& estop) {
    person(estop.estop_by, (estop.engaged ? "E-stop" : "clears the E-stop") +
                               (estop.estop_reason.empty() ? "" : ": " + estop.estop_reason));
  }
  void hear(const fence_t& fence) { person(fence.fence_by, "fence " + fence.fence_name); }
  void hear(const mark_t& mark) {
    if (mark.mark_kind == "gap" || mark.mark_kind == "no gap")
      drive_.gaps.push_back({now_, mark.mark_value, mark.mark_kind == "gap"});
    else
      person("operator", mark.mark_kind + ": " + mark.mark_value);
  }
  void hear(const config_t& config) { drive_.configs[config.config_process] = config.config_text; }

  DriveTimeline& drive_;
  double now_ = 0.0;
  const DriveEvent* event_ = nullptr;  // that is taken
  Odometer odometer_;
  std::optional<Pose2> last_;
  std::set<ExecutionKey> ended_;
};

}  // namespace

namespace {

/// The first note at this time or later: a day's log is looked at by its moments.
template <class Note>
auto firstFrom(const std::vector<Note>& notes, double time) {
  return std::lower_bound(notes.begin(), notes.end(), time,
                          [](const Note& note, double at) { return note.time < at; });
}

}  // namespace

std::optional<DriveTimeline::Silence> DriveTimeline::silenceOf(const std::string& channel,
                                                               double time, double longest) const {
  const auto found = heard.find(channel);
  if (found == heard.end()) return std::nullopt;
  const std::vector<double>& times = found->second;
  std::optional<Silence> worst;
  const auto at = std::lower_bound(times.begin(), times.end(), time - longest);
  for (size_t i = at == times.begin() ? 0 : static_cast<size_t>(at - times.begin()) - 1;
       i < times.size(); ++i) {
    const Silence silence{times[i], i + 1 < times.size() ? times[i + 1] : duration};
    if (silence.from > time + 0.05) break;
    if (silence.length() > longest && (!worst || silence.length() > worst->length()))
      worst = silence;
  }
  return worst;
}

std::optional<double> DriveTimeline::restartOf(const std::string& process, double from,
                                               double to) const {
  const auto found = health.find(process);
  if (found == health.end()) return std::nullopt;
  for (size_t i = 1; i < found->second.size(); ++i) {
    const HealthNote& note = found->second[i];
    if (note.boot == found->second[i - 1].boot) continue;
    if (note.time >= from && note.time <= to) return note.time;
  }
  return std::nullopt;
}

std::optional<double> DriveTimeline::deathOf(const std::string& process) const {
  const auto found = health.find(process);
  if (found == health.end() || duration - found->second.back().time < kDead) return std::nullopt;
  return found->second.back().time;
}

const HealthNote* DriveTimeline::healthAt(const std::string& process, double time) const {
  const auto found = health.find(process);
  if (found == health.end()) return nullptr;
  const auto after = firstFrom(found->second, time + 1e-9);
  return after == found->second.begin() ? nullptr : &*std::prev(after);
}

const HealthNote* DriveTimeline::complaintOf(const std::string& process, double from,
                                             double to) const {
  const auto found = health.find(process);
  if (found == health.end()) return nullptr;
  for (auto note = firstFrom(found->second, from); note != found->second.end() && note->time <= to;
       ++note)
    if (!note->ok) return &*note;
  return nullptr;
}

DriveTimeline::Ghost DriveTimeline::ghostAt(const Eigen::Vector2d& p_map, double from,
                                            double to) const {
  Ghost ghost;
  ghost.gone = to;
  for (auto note = firstFrom(cells, from); note != cells.end() && note->time <= to + kGhostLife;
       ++note) {
    const CellNote& cell = *note;
    if ((cell.p_map - p_map).squaredNorm() > kGhostSize * kGhostSize) continue;
    if (cell.came && cell.time >= from && cell.time <= to) ++ghost.came;
    if (cell.came || cell.time <= from || cell.time > to + kGhostLife) continue;
    ++ghost.went;
    ghost.gone = std::max(ghost.gone, cell.time);
  }
  if (!map) return ghost;
  const int reach = static_cast<int>(kAlone / map->cellSize());
  const CellIndex lower{static_cast<int>(std::floor(p_map.x() / map->cellSize())) - reach,
                        static_cast<int>(std::floor(p_map.y() / map->cellSize())) - reach};
  const Grid around = map->window(lower, 2 * reach + 1, 2 * reach + 1);
  ghost.alone = std::count(around.cells().begin(), around.cells().end(), kObstacle) == 0;
  return ghost;
}

std::optional<Pose2> DriveTimeline::poseAt(double time) const {
  for (auto note = firstFrom(ins, time + 1e-9); note != ins.begin();)
    if ((--note)->placed) return note->T_map_body;
  return std::nullopt;
}

DriveTimeline readTimeline(const std::vector<std::string>& logs) {
  DriveTimeline drive;
  TimelineReader timeline(drive);
  DriveReader reader(logs);
  for (DriveEvent event; reader.next(event);) timeline.take(event);
  drive.problem = reader.problem();
  if (logs.empty() || drive.heard.empty())
    throw std::runtime_error((logs.empty() ? std::string("no log") : logs.front()) +
                             ": holds no message of Tread; is it a robot's log?");
  drive.name = logs.front().substr(logs.front().find_last_of('/') + 1);
  return drive;
}

}  // namespace tread::why
