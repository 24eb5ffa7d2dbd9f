// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/drive/drive_timeline.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "common/messages/ins_messages.hpp"
#include "common/messages/pattern_messages.hpp"

namespace tread {
namespace {

constexpr double kBatteryStep = 1.0;  // [s] between notes
constexpr double kCellReach = 8.0;    // [m] from the robot
constexpr double kDead = 2.5;         // [s] without HEALTH, which comes every second
constexpr double kGhostSize = 0.7;    // [m]
constexpr double kGhostLife = 12.0;   // [s]
constexpr double kFlickers = 0.4;     // [m] flickering next to a wall is no ghost

/// Fills a timeline from the events of a log, in order.
class TimelineReader {
 public:
  TimelineReader(DriveTimeline& drive, double ins_step) : drive_(drive), ins_step_(ins_step) {}

  void take(const DriveEvent& event) {
    event_ = &event;
    if (drive_.begun < 0) drive_.begun = event.utime;
    now_ = {static_cast<double>(event.utime - drive_.begun) * 1e-6, drive_.messages++};
    drive_.duration = std::max(drive_.duration, now_.time);
    if (event.channel != kHealth.name) drive_.heard[event.channel].push_back(now_.time);
    dispatch(
        event, [this](const auto& message) { hear(message); }, kIns, kMotor, kPlan, kHealth,
        kLearning, kExecution, kGoal, kMap, kMark, kConfig, kPatternSet);
    for (Event& told : teller_.take(event)) drive_.events.push_back({now_, std::move(told)});
  }

 private:
  void hear(const ins_t& ins) {
    auto pose = planarPose(ins);
    if (pose && pose->position().norm() > kFarthestPlace) pose.reset();
    if (pose) last_ = pose;
    const InsNote note{now_,
                       ins.utime,
                       ins.ins_status,
                       pose.value_or(Pose2{}),
                       pose.has_value(),
                       event_->wrong_time,
                       event_->restarts};
    odometer_.add(note);
    drive_.distance = odometer_.distance();
    const bool same = !drive_.ins.empty() && drive_.ins.back().status == ins.ins_status;
    if (!same || now_.time - drive_.ins.back().time >= ins_step_) drive_.ins.push_back(note);
  }

  void hear(const motor_t& motor) {
    MotorNote note{now_,
                   motor.utime,
                   motor.utime,
                   motor.bridge_state,
                   {stopReasonFrom(motor.state_code), motor.state_reason},
                   commandFrom(motor)};
    std::vector<MotorNote>& notes = drive_.motors;
    notePermission(note);
    if (!notes.empty() && notes.back().state == note.state && notes.back().reason == note.reason &&
        notes.back().command == note.command)
      notes.back().until = note.utime;
    else
      notes.push_back(std::move(note));
    if (std::isfinite(motor.battery_voltage) &&
        (drive_.battery.empty() || now_.time - drive_.battery.back().first >= kBatteryStep))
      drive_.battery.emplace_back(now_.time, static_cast<double>(motor.battery_voltage));
  }

  void notePermission(const MotorNote& note) {
    const int16_t before = drive_.motors.empty() ? int16_t{0} : drive_.motors.back().state;
    const bool lost = mayDrive(before) && !mayDrive(note.state);
    const bool stopped = note.state == motor_t::STATE_ESTOP && before != motor_t::STATE_ESTOP;
    if (lost || stopped) drive_.losses.push_back({now_, note.state, note.reason, lost});
  }

  void hear(const plan_t& plan) {
    PlanNote note{now_,
                  plan.utime,
                  plan.plan_status,
                  {stopReasonFrom(plan.reason_code), plan.reason},
                  plan.goal_id,
                  true,
                  {},
                  0};
    if (!drive_.plans.empty()) {
      const PlanNote& before = drive_.plans.back();
      // While driving, the reason describes a planned stop.
      note.news = before.state != note.state ||
                  (note.state != plan_t::PLAN_DRIVING && before.reason != note.reason);
    }
    if (plan.num_patterns > 0) {
      const auto& pose = plan.pose.front();
      note.T_map_next = Pose2{pose[0], pose[1], pose[2]};
      const auto known = durations_.find(plan.pattern_id.front());
      if (known != durations_.end()) note.duration = known->second;
    }
    drive_.plans.push_back(std::move(note));
  }

  void hear(const pattern_set_part_t& part) {
    durations_[part.set_pattern_id] = int64_t{part.set_period} * part.num_samples;
  }

  void hear(const health_t& health) { drive_.health[health.process].push_back({now_, health}); }

  void hear(const learning_t& learning) { drive_.patterns.push_back({now_, learning}); }

  void hear(const execution_t& executions) {
    for (const execution_record_t& record : executions.records)
      if (record.outcome != execution_record_t::OUTCOME_RUNNING &&
          ended_.insert(keyOf(record)).second)
        drive_.executions.push_back({now_, record});
  }

  void hear(const goal_t& goal) {
    if (goal.goal_id == 0 ||
        (!drive_.goals.empty() && drive_.goals.back().message.goal_id == goal.goal_id))
      return;
    drive_.goals.push_back({now_, goal});
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

  /// Changes since the previous tile; unknown ground that turns out to be blocked is not noted.
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

  void hear(const mark_t& mark) {
    if (mark.mark_kind == "gap" || mark.mark_kind == "no gap")
      drive_.gaps.push_back({now_, mark.mark_value, mark.mark_kind == "gap"});
  }

  void hear(const config_t& config) { drive_.configs[config.config_process] = config.config_text; }

  DriveTimeline& drive_;
  double ins_step_;
  Note now_;
  const DriveEvent* event_ = nullptr;  // being processed
  EventTeller teller_;
  Odometer odometer_;
  std::optional<Pose2> last_;
  std::set<ExecutionKey> ended_;
  std::map<int32_t, int64_t> durations_;  // [us] by pattern
};

}  // namespace

namespace {

/// The first note at this time or later: a day's log is accessed by time.
template <class Note>
auto firstFrom(const std::vector<Note>& notes, double time) {
  return std::lower_bound(notes.begin(), notes.end(), time,
                          [](const Note& note, double at) { return note.time < at; });
}

}  // namespace

int DriveTimeline::ended(int16_t outcome) const {
  return static_cast<int>(
      std::count_if(executions.begin(), executions.end(),
                    [&](const auto& execution) { return execution.message.outcome == outcome; }));
}

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
    const Said<health_t>& now = found->second[i];
    if (now.message.boot_id == found->second[i - 1].message.boot_id) continue;
    if (now.time >= from && now.time <= to) return now.time;
  }
  return std::nullopt;
}

std::optional<double> DriveTimeline::deathOf(const std::string& process) const {
  const auto found = health.find(process);
  if (found == health.end() || duration - found->second.back().time < kDead) return std::nullopt;
  return found->second.back().time;
}

const Said<health_t>* DriveTimeline::healthAt(const std::string& process, double time) const {
  const auto found = health.find(process);
  if (found == health.end()) return nullptr;
  const auto after = firstFrom(found->second, time + 1e-9);
  return after == found->second.begin() ? nullptr : &*std::prev(after);
}

const Said<health_t>* DriveTimeline::complaintOf(const std::string& process, double from,
                                                 double to) const {
  const auto found = health.find(process);
  if (found == health.end()) return nullptr;
  for (auto note = firstFrom(found->second, from); note != found->second.end() && note->time <= to;
       ++note)
    if (!isOk(note->message)) return &*note;
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
  const int reach = static_cast<int>(kFlickers / map->cellSize());
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

DriveTimeline timelineOf(DriveReader reader, double ins_step, const EachEvent& each) {
  DriveTimeline drive;
  TimelineReader timeline(drive, ins_step);
  for (DriveEvent event; reader.next(event);) {
    timeline.take(event);
    if (each) each(event, drive);
  }
  drive.problem = reader.problem();
  return drive;
}

DriveTimeline readTimeline(const std::vector<std::string>& logs, double ins_step) {
  DriveTimeline drive = timelineOf(DriveReader(logs), ins_step);
  if (logs.empty() || drive.heard.empty())
    throw std::runtime_error((logs.empty() ? std::string("no log") : logs.front()) +
                             ": holds no message of Tread; is it a robot's log?");
  drive.name = logs.front().substr(logs.front().find_last_of('/') + 1);
  return drive;
}

}  // namespace tread
