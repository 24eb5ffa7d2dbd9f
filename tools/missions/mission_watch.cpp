// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/mission_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/grid/footprint.hpp"
#include "tools/robot/operator/drive_progress.hpp"

namespace tread::missions {
namespace {

constexpr double kArrivedWithin =
    0.8;                             ///< [m] of the true pose: tolerance of the goal and INS error
constexpr double kIdleAfter = 60.0;  ///< [s] without moving 10 cm
constexpr double kRefusedAfter = 15.0;  ///< [s] of blocked or unreachable without a break
constexpr int64_t kSurfaceConfirmed =
    1'000'000;  ///< [us] on a new surface before it counts as a change

}  // namespace

MissionWatch::MissionWatch(RobotSystem& system, const MissionWorld& world)
    : system_(system),
      world_(world),
      start_(system.bus().now()),
      time_limit_(60.0 + 8.0 * world.straight_line),
      flips_([this](const Pose2& start, const auto& patterns) { return isFree(start, patterns); }),
      moved_at_(start_),
      last_pose_(system.robot().truth().T_map_body),
      moved_from_(last_pose_),
      map_(system.map().voxels.cell_size, system.map().tile_cells) {
  result_.straight_line = world.straight_line;
  result_.line_blocked = world.line_blocked;
  result_.surface_changes = world.surface_changes;
  surface_ = system.robot().truth().surface;
  surfaces_.push_back({start_, surface_});
  for (const MotionPattern& pattern : system.patterns().patterns())
    pattern_names_[pattern.id] = pattern.name;
  listen(system.bus().outside());
}

void MissionWatch::listen(Bus& bus) {
  bus.subscribe<plan_t>(kPlan, [this](const plan_t& message) { hear(message); });
  bus.subscribe<motor_t>(kMotor, [this](const motor_t& message) { motor_ = message; });
  bus.subscribe<execution_t>(kExecution, [this](const execution_t& message) { hear(message); });
  bus.subscribe<learning_t>(kLearning, [this](const learning_t& message) { hear(message); });
  bus.subscribe<plan_tree_t>(kPlanTree, [this](const plan_tree_t& message) { hear(message); });
  bus.subscribe<map_tile_t>(kMap, [this](const map_tile_t& message) { hear(message); });
  bus.subscribe<pattern_set_part_t>(kPatternSet,
                                    [this](const pattern_set_part_t& part) { hear(part); });
}

MissionResult MissionWatch::result() const {
  MissionResult result = result_;
  result.stops = stops_.stops(start_, result.outcome == Outcome::kArrived);
  result.begun = stops_.begun() == 0 ? result.time : seconds(stops_.begun());
  result.driven = stops_.driven();
  return result;
}

void MissionWatch::hear(const pattern_set_part_t& part) {
  versions_.insert(part.set_version);
  result_.set_versions = static_cast<int64_t>(versions_.size()) - 1;
  if (const auto set = sets_.add(part)) flips_.take(*set);
}

void MissionWatch::hear(const plan_t& message) {
  plan_ = message;
  std::optional<Flip> flip = flips_.hear(message);
  if (!flip) return;
  flip->time = seconds(system_.bus().now());
  result_.flips.push_back(*flip);
}

bool MissionWatch::isFree(const Pose2& T_map_start,
                          const std::vector<const MotionPattern*>& patterns) const {
  const planner::WorldConfig& world = system_.planner().world;
  const Footprint footprint(world.footprint.front, world.footprint.rear, world.footprint.half_width,
                            world.margins.check);
  const auto cells = static_cast<int>(std::ceil(world.window / map_.cellSize()));
  const CellIndex here = Grid(map_.cellSize(), {}, 0, 0).indexOf(T_map_start.position());
  const Grid around = map_.window({here.x - cells / 2, here.y - cells / 2}, cells, cells);
  Pose2 start = T_map_start;
  for (const MotionPattern* pattern : patterns) {
    for (const Pose2& pose : pattern->trajectory)
      if (footprint.blockedCells(around, start * pose, false) > 0) return false;
    start = start * pattern->end();
  }
  return true;
}

void MissionWatch::hear(const execution_t& message) {
  abort_reason_.clear();
  for (const execution_record_t& record : message.records) {
    const bool aborted = record.outcome == execution_record_t::OUTCOME_ABORTED;
    abort_reason_ = aborted ? record.outcome_reason : std::string();
    execution_record_t& known = records_[{record.record_run_id, record.record_execution_id}];
    if (known.outcome != record.outcome) {
      if (record.outcome == execution_record_t::OUTCOME_COMPLETED) ++result_.completed;
      if (record.outcome == execution_record_t::OUTCOME_ABORTED) ++result_.aborted;
    }
    known = record;
  }
}

void MissionWatch::hear(const learning_t& message) {
  ScoredExecution execution;
  execution.key = {message.learned_run_id, message.learned_execution_id};
  execution.time = seconds(message.utime);
  execution.pattern = message.learned_pattern_name;
  execution.measured = message.accepted && std::isfinite(message.error_position);
  execution.refusal = message.accepted ? "" : message.gate_reason;
  execution.error_position = message.error_position;
  execution.error_yaw = message.error_yaw;
  execution.path_length = message.path_length;
  execution.slope = message.slope;
  execution.turned = std::abs(message.measured_end[2]);
  execution.measured_end = {message.measured_end[0], message.measured_end[1],
                            message.measured_end[2]};
  const auto record = records_.find(execution.key);
  if (record != records_.end())
    execution.surface = surfaceBetween(record->second.started, record->second.ended);
  result_.executions.push_back(execution);
}

void MissionWatch::hear(const plan_tree_t& message) {
  // The last plans before the goal are short; the one worth drawing was made on the way.
  if (!tree_.empty() && toGo() < 10.0) return;
  tree_ = report::edgesOf(message);
}

void MissionWatch::hear(const map_tile_t& message) {
  Tile tile;
  tile.tile_x = message.tile_x;
  tile.tile_y = message.tile_y;
  tile.utime = message.utime;
  tile.cells = message.cells;
  map_.put(std::move(tile));
}

void MissionWatch::step() {
  const sim::RobotTruth& truth = system_.robot().truth();
  const int64_t now = system_.bus().now();
  const Pose2 step = between(last_pose_, truth.T_map_body);
  result_.distance += std::hypot(step.x, step.y);
  last_pose_ = truth.T_map_body;
  if (result_.track.empty() || seconds(now) - result_.track.back().time > 0.2)
    result_.track.push_back({seconds(now), truth.T_map_body});
  const Pose2 since = between(moved_from_, truth.T_map_body);
  if (std::hypot(since.x, since.y) > 0.1 || std::abs(since.yaw) > 0.1) {
    moved_from_ = truth.T_map_body;
    moved_at_ = now;
  }
  stops_.step(now, truth.v_body, {plan_.reason, abort_reason_});
  noteContacts();
  followSurface();
  judge();
}

void MissionWatch::noteContacts() {
  const sim::RobotTruth& truth = system_.robot().truth();
  for (size_t i = result_.contacts.size(); i < truth.collisions.size(); ++i) {
    Contact contact;
    contact.time = seconds(truth.collisions[i].utime);
    contact.pattern = presentPattern();
    contact.T_map_body = truth.T_map_body;
    result_.contacts.push_back(contact);
  }
  for (size_t i = 0; i < result_.contacts.size(); ++i)
    result_.contacts[i].penetration = truth.collisions[i].penetration;
  result_.collisions = static_cast<int>(truth.collisions.size());
}

std::string MissionWatch::presentPattern() const {
  const auto record = records_.find({motor_.motor_run_id, motor_.execution_id});
  if (motor_.execution_id == 0 || record == records_.end()) return {};
  const auto name = pattern_names_.find(record->second.record_pattern_id);
  return name == pattern_names_.end() ? std::string() : name->second;
}

void MissionWatch::followSurface() {
  const std::string& present = system_.robot().truth().surface;
  const int64_t now = system_.bus().now();
  if (present == surface_) {
    new_surface_.clear();
    return;
  }
  if (present != new_surface_) {
    new_surface_ = present;
    new_surface_since_ = now;
  }
  if (now - new_surface_since_ < kSurfaceConfirmed) return;
  result_.crossings.push_back({seconds(new_surface_since_), surface_, present});
  surfaces_.push_back({new_surface_since_, present});
  surface_ = present;
  new_surface_.clear();
}

std::string MissionWatch::surfaceBetween(int64_t from, int64_t to) const {
  std::string at_start;
  for (const auto& [since, surface] : surfaces_) {
    if (since <= from) at_start = surface;
    if (since > from && since <= to) return {};
  }
  return !new_surface_.empty() && new_surface_since_ <= to ? std::string() : at_start;
}

double MissionWatch::toGo() const {
  return (world_.T_map_goal.position() - last_pose_.position()).norm();
}

void MissionWatch::judge() {
  const int64_t now = system_.bus().now();
  result_.time = seconds(now);
  const bool refused =
      plan_.plan_status == plan_t::PLAN_BLOCKED || plan_.plan_status == plan_t::PLAN_UNREACHABLE;
  if (!refused) refused_since_ = -1;
  if (refused && refused_since_ < 0) refused_since_ = now;
  if (plan_.plan_status == plan_t::PLAN_ARRIVED) {
    if (toGo() <= kArrivedWithin) return end(Outcome::kArrived, "");
    return end(Outcome::kStopped,
               "the planner believes that it has arrived, the true pose says no");
  }
  if (refused_since_ >= 0 && static_cast<double>(now - refused_since_) * 1e-6 > kRefusedAfter)
    return end(Outcome::kRefused, operators::statusWord(plan_.plan_status) + ": " + plan_.reason);
  if (static_cast<double>(now - moved_at_) * 1e-6 > kIdleAfter)
    return end(Outcome::kIdle, "nothing moved for a minute; planner " +
                                   operators::statusWord(plan_.plan_status) + ": " + plan_.reason +
                                   "; bridge: " + motor_.state_reason);
  if (result_.time > time_limit_)
    return end(
        Outcome::kStopped,
        "time ran out; planner " + operators::statusWord(plan_.plan_status) + ": " + plan_.reason);
}

void MissionWatch::end(Outcome outcome, const std::string& reason) {
  result_.outcome = outcome;
  result_.reason = reason;
  ended_ = true;
}

Progress MissionWatch::progress() const {
  Progress progress;
  progress.time = result_.time;
  progress.to_go = toGo();
  progress.surface = surface_;
  progress.plan = operators::statusWord(plan_.plan_status) +
                  (plan_.reason.empty() ? "" : " (" + plan_.reason + ")");
  progress.pattern = presentPattern();
  progress.last_error = std::numeric_limits<double>::quiet_NaN();
  for (auto it = result_.executions.rbegin(); it != result_.executions.rend(); ++it)
    if (it->measured) {
      progress.last_error = it->error_position;
      break;
    }
  return progress;
}

}  // namespace tread::missions
