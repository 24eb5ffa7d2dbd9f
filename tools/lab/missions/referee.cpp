// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/missions/referee.hpp"

#include <cmath>

#include "common/grid/footprint.hpp"
#include "tools/robot/operator/calls.hpp"

namespace tread::missions {

std::optional<FlipDetector::Patterns> FlipDetector::patternsOf(
    const std::vector<int32_t>& ids) const {
  Patterns patterns;
  for (const int32_t id : ids) patterns.push_back(set_->find(id));
  for (const MotionPattern* pattern : patterns)
    if (pattern == nullptr) return std::nullopt;
  return patterns;
}

const MotionPattern* FlipDetector::turnOf(const Patterns& patterns) const {
  double time = 0.0;
  for (const MotionPattern* pattern : patterns) {
    if (time >= kAhead) break;
    if (std::abs(pattern->end().yaw) > kTurn) return pattern;
    time += set_->periodSeconds() * static_cast<double>(pattern->commands.size());
  }
  return nullptr;
}

std::optional<Flip> FlipDetector::hear(const plan_t& plan) {
  if (!set_ || plan.pattern_id.empty()) return std::nullopt;
  const bool begun = plan.execution_id.front() != running_;
  const bool as_intended = begun && !intended_.empty() && intended_.front() == plan.pattern_id[0];
  if (as_intended) intended_.erase(intended_.begin());
  running_ = plan.execution_id.front();
  const bool other_begun = begun && !as_intended;
  const std::vector<int32_t> after(plan.pattern_id.begin() + 1, plan.pattern_id.end());
  const auto present = patternsOf(other_begun ? plan.pattern_id : after);
  const auto before = patternsOf(intended_);
  const MotionPattern* running = set_->find(plan.pattern_id.front());
  if (!present || !before || running == nullptr) return std::nullopt;
  const MotionPattern* to = turnOf(*present);
  const MotionPattern* from = turnOf(*before);
  Pose2 T_map_start{plan.pose[0][0], plan.pose[0][1], plan.pose[0][2]};
  if (other_begun) T_map_start = T_map_start * inverse(running->end());
  if (other_begun || to != nullptr || from == nullptr) intended_ = after;
  const bool turned = to != nullptr && from != nullptr &&
                      std::signbit(to->end().yaw) != std::signbit(from->end().yaw);
  if (!turned || !is_free_(T_map_start, *before)) return std::nullopt;
  return Flip{0.0, from->name, to->name};
}

void StopDetector::step(int64_t utime, const Twist2& v_body, const StopReasons& reasons) {
  const bool slow = std::hypot(v_body.v_x, v_body.v_y) < kSlow && std::abs(v_body.omega) < kSlow;
  if (!slow && begun_ == 0) begun_ = utime;
  if (!slow && last_step_ != 0) driven_ += utime - last_step_;
  last_step_ = utime;
  if (slow && !slow_)
    slowed_ = {utime, utime, reasons.planner.empty() ? reasons.bridge : reasons.planner};
  slow_ = slow;
  if (!slow) resting_ = false;
  if (!slow || begun_ == 0) return;
  if (resting_) {
    rests_.back().to = utime;
  } else if (utime - slowed_.from >= kAtRestAfter) {
    rests_.push_back({slowed_.from, utime, slowed_.reason});
    resting_ = true;
  }
}

std::vector<Stop> StopDetector::stops(int64_t start, bool arrived) const {
  std::vector<Stop> stops;
  for (const Rest& rest : rests_)
    stops.push_back({static_cast<double>(rest.from - start) * 1e-6,
                     static_cast<double>(rest.to - rest.from) * 1e-6, rest.reason});
  if (arrived && resting_) stops.pop_back();
  return stops;
}

namespace {

constexpr double kArrivedWithin = 0.8;  ///< [m] true pose: tolerance of the goal plus INS error
constexpr double kClockStarts = 0.1;    ///< [m] from the start: the clock of a timed run starts
constexpr double kIdleAfter = 60.0;     ///< [s] within 10 cm
constexpr double kRefusedAfter = 15.0;  ///< [s] blocked or unreachable without interruption
constexpr int64_t kSurfaceConfirmed =
    1'000'000;  ///< [us] on a new surface until it counts as a change

}  // namespace

Referee::Referee(RobotSystem& system, const MissionWorld& world)
    : system_(system),
      world_(world),
      start_(system.bus().now()),
      flips_([this](const Pose2& start, const auto& patterns) { return isFree(start, patterns); }),
      surfaces_(start_, system.robot().truth().surface),
      last_pose_(system.robot().truth().T_map_body),
      moved_at_(start_),
      moved_from_(last_pose_),
      map_(system.map().voxels.cell_size, system.map().tile_cells) {
  result_.straight_line = world.straight_line;
  result_.line_blocked = world.line_blocked;
  result_.surface_changes = world.surface_changes;
  result_.timed = world.timed;
  if (world.timed) result_.world = world.description.name;
  listen(system.bus().outside());
}

void Referee::listen(Bus& bus) {
  bus.subscribe<plan_t>(kPlan, [this](const plan_t& message) { hear(message); });
  bus.subscribe<motor_t>(kMotor, [this](const motor_t& message) { hear(message); });
  bus.subscribe<execution_t>(kExecution, [this](const execution_t& message) { hear(message); });
  bus.subscribe<learning_t>(kLearning, [this](const learning_t& message) { hear(message); });
  bus.subscribe<plan_tree_t>(kPlanTree, [this](const plan_tree_t& message) { hear(message); });
  bus.subscribe<map_tile_t>(kMap, [this](const map_tile_t& message) { hear(message); });
  bus.subscribe<pattern_set_part_t>(kPatternSet,
                                    [this](const pattern_set_part_t& part) { hear(part); });
}

MissionResult Referee::result() const {
  MissionResult result = result_;
  result.stops = stops_.stops(start_, result.outcome == MissionOutcome::kArrived);
  result.begun = stops_.begun() == 0 ? result.time : seconds(stops_.begun());
  result.driven = stops_.driven();
  result.smooth = system_.robot().truth().smooth;
  result.rough = system_.robot().truth().rough;
  return result;
}

void Referee::hear(const motor_t& message) {
  const bool armed = motor_.utime > 0 && motor_.bridge_state != motor_t::STATE_DISARMED;
  motor_ = message;
  if (armed && message.bridge_state == motor_t::STATE_DISARMED)
    result_.disarmings.push_back({seconds(message.utime), message.state_reason});
}

void Referee::hear(const pattern_set_part_t& part) {
  versions_.insert(part.set_version);
  result_.set_versions = static_cast<int64_t>(versions_.size()) - 1;
  if (const auto set = sets_.add(part)) flips_.take(*set);
}

void Referee::hear(const plan_t& message) {
  plan_ = message;
  notePlan(message);
  std::optional<Flip> flip = flips_.hear(message);
  if (!flip) return;
  flip->time = seconds(system_.bus().now());
  result_.flips.push_back(*flip);
}

/// The first pattern of a plan is being executed.
void Referee::notePlan(const plan_t& message) {
  if (message.expansions == 0) return;
  result_.plans.expansions.push_back(message.expansions);
  if (message.num_patterns < 2) return;
  const auto sigma = [](const std::vector<double>& c) {
    const double half = 0.5 * (c[0] - c[3]);
    return std::sqrt(std::max(0.0, 0.5 * (c[0] + c[3]) + std::hypot(half, c[1])));
  };
  const auto& covariances = message.covariance;
  ++result_.plans.count;
  result_.plans.next += sigma(covariances[1]);
  result_.plans.end += sigma(covariances.back());
}

bool Referee::isFree(const Pose2& T_map_start,
                     const std::vector<const MotionPattern*>& patterns) const {
  const planner::PlanningMapConfig& map = system_.planner().map;
  const Footprint footprint(map.footprint, map.margins.check);
  const auto cells = static_cast<int>(std::ceil(map.window / map_.cellSize()));
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

void Referee::hear(const execution_t& message) {
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

void Referee::hear(const learning_t& message) {
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
    execution.surface = surfaces_.between(record->second.started, record->second.ended);
  result_.executions.push_back(execution);
}

void Referee::hear(const plan_tree_t& message) {
  // The last plans before the goal are short; draw one from further away.
  if (!tree_.empty() && toGo() < 10.0) return;
  tree_ = report::edgesOf(message);
}

void Referee::hear(const map_tile_t& message) {
  Tile tile;
  tile.tile_x = message.tile_x;
  tile.tile_y = message.tile_y;
  tile.utime = message.utime;
  tile.cells = message.cells;
  map_.put(std::move(tile));
}

void Referee::step() {
  const int64_t now = system_.bus().now();
  result_.time = seconds(now);
  noteMotion();
  stops_.step(now, system_.robot().truth().v_body, {plan_.reason, abort_reason_});
  noteContacts();
  noteClearance();
  noteSurface();
  if (world_.timed)
    judgeTimed(*world_.timed);
  else
    judge();
}

void Referee::noteMotion() {
  const Pose2& T_map_body = system_.robot().truth().T_map_body;
  const Pose2 step = between(last_pose_, T_map_body);
  const double way = std::hypot(step.x, step.y);
  result_.distance += way;
  if (std::isfinite(plan_.risk_per_metre)) result_.plans.touches += way * plan_.risk_per_metre;
  last_pose_ = T_map_body;
  if (result_.track.empty() || result_.time - result_.track.back().time > 0.2)
    result_.track.push_back({result_.time, T_map_body});
  const Pose2 since = between(moved_from_, T_map_body);
  if (std::hypot(since.x, since.y) > 0.1 || std::abs(since.yaw) > 0.1) {
    moved_at_ = system_.bus().now();
    moved_from_ = T_map_body;
  }
}

void Referee::noteContacts() {
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
}

/// At a contact the simulator keeps the body at its last free pose.
void Referee::noteClearance() {
  const FootprintSize& outline = system_.robot().settings().vehicle.outline;
  const Pose2 T_map_middle = last_pose_ * Pose2{(outline.front - outline.rear) / 2.0, 0.0, 0.0};
  const sim::Rectangle rectangle{outline.length(), 2.0 * outline.half_width};
  for (const sim::Obstacle& obstacle : world_.description.obstacles)
    result_.least_clearance =
        std::min(result_.least_clearance,
                 std::max(0.0, -sim::penetrationOf(obstacle, rectangle, T_map_middle)));
  if (!result_.contacts.empty()) result_.least_clearance = 0.0;
}

std::string Referee::presentPattern() const {
  const auto record = records_.find({motor_.motor_run_id, motor_.execution_id});
  if (motor_.execution_id == 0 || record == records_.end()) return {};
  const MotionPattern* pattern = system_.patterns().find(record->second.record_pattern_id);
  return pattern == nullptr ? std::string() : pattern->name;
}

std::optional<int64_t> SurfaceTracker::step(int64_t utime, const std::string& present) {
  if (present == surface()) {
    next_.clear();
    return std::nullopt;
  }
  if (present != next_) {
    next_ = present;
    next_since_ = utime;
  }
  if (utime - next_since_ < kSurfaceConfirmed) return std::nullopt;
  changes_.emplace_back(next_since_, present);
  next_.clear();
  return next_since_;
}

std::string SurfaceTracker::between(int64_t from, int64_t to) const {
  std::string at_start;
  for (const auto& [since, surface] : changes_) {
    if (since <= from) at_start = surface;
    if (since > from && since <= to) return {};
  }
  return !next_.empty() && next_since_ <= to ? std::string() : at_start;
}

void Referee::noteSurface() {
  const std::string before = surfaces_.surface();
  if (const auto since = surfaces_.step(system_.bus().now(), system_.robot().truth().surface))
    result_.crossings.push_back({seconds(*since), before, surfaces_.surface()});
}

double Referee::toGo() const {
  return (world_.T_map_goal.position() - last_pose_.position()).norm();
}

void Referee::judge() {
  const bool refused =
      plan_.plan_status == plan_t::PLAN_BLOCKED || plan_.plan_status == plan_t::PLAN_UNREACHABLE;
  const int64_t now = system_.bus().now();
  if (!refused) refused_since_.reset();
  if (refused && !refused_since_) refused_since_ = now;
  if (plan_.plan_status == plan_t::PLAN_ARRIVED) {
    if (toGo() <= kArrivedWithin) return end(MissionOutcome::kArrived, "");
    return end(MissionOutcome::kStopped,
               "the planner reports arrival, but the true pose is outside the goal's tolerance");
  }
  const std::string plan = operators::statusWord(plan_.plan_status) + ": " + plan_.reason;
  if (refused_since_ && static_cast<double>(now - *refused_since_) * 1e-6 > kRefusedAfter)
    return end(MissionOutcome::kRefused, plan);
  if (static_cast<double>(now - moved_at_) * 1e-6 > kIdleAfter)
    return end(MissionOutcome::kIdle,
               "nothing moved for a minute; planner " + plan + "; bridge: " + motor_.state_reason);
  if (result_.time > 60.0 + 8.0 * world_.straight_line)
    return end(MissionOutcome::kStopped, "time ran out; planner " + plan);
}

void Referee::judgeTimed(const TimedRun& run) {
  const int64_t now = system_.bus().now();
  if (!clock_start_ && distanceBetween(world_.T_map_start, last_pose_) >= kClockStarts)
    clock_start_ = now;
  result_.clock = clock_start_ ? static_cast<double>(now - *clock_start_) * 1e-6 : 0.0;
  if (!result_.contacts.empty()) return end(MissionOutcome::kContact, "touched an obstacle");
  if (toGo() <= run.tolerance) return end(MissionOutcome::kArrived, "");
  const double waited = clock_start_ ? result_.clock : result_.time;
  if (waited > run.limit)
    end(MissionOutcome::kStopped,
        "time ran out; planner " + operators::statusWord(plan_.plan_status) + ": " + plan_.reason);
}

void Referee::end(MissionOutcome outcome, const std::string& reason) {
  result_.outcome = outcome;
  result_.reason = reason;
  ended_ = true;
}

}  // namespace tread::missions
