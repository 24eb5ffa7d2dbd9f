// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/planner_node.hpp"

#include <algorithm>
#include <cmath>

#include "common/messages/blank.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/planner/core/search/swept_footprint.hpp"

namespace tread::planner {
namespace {

constexpr int64_t kKeepEvery = 1'000'000;  // [us]

/// Plans keep the robot's footprint free; logs older than robot descriptions have it in this
/// section.
void readRobotInto(ConfigReader& reader, bool logged, PlannerConfig& config) {
  config.operators.lease_us = 0;
  if (reader.has("footprint")) {
    config.map.footprint = readFootprint(reader.section("footprint"));
    return;
  }
  const bool leases = !logged || describesOperators(reader);
  const RobotDescription robot = readRobot(reader);
  config.map.footprint = robot.footprint;
  if (leases) config.operators = robot.operators;
  config.map.fences = robot.fences;
  config.max_slope = robot.max_slope;
  config.map.full_speed = robot.drive.topSpeed();
  config.map.stopping_time = robot.stopping_time;
}

void readMargins(ConfigReader reader, Margins& margins) {
  reader.number("check", margins.check, {0.0, 1.0}, "m");
  reader.number("plan", margins.plan, {0.0, 1.0}, "m");
  reader.number("narrow", margins.narrow, {0.0, 1.0}, "m, 0 = off");
  reader.number("growth", margins.growth, {0.0, 3.0}, "1");
  reader.number("largest", margins.largest, {0.0, 2.0}, "m");
  reader.number("regain", margins.regain, {0.0, 1.0}, "1");
  if (margins.check > margins.plan) throw reader.error("check", "must not be more than plan");
  if (margins.narrow > 0.0 && (margins.narrow < margins.check || margins.narrow > margins.plan))
    throw reader.error("narrow", "must not be less than check or more than plan");
  if (margins.largest < margins.plan) throw reader.error("largest", "must not be less than plan");
}

void readMap(ConfigReader reader, PlanningMapConfig& map) {
  reader.number("keep_radius", map.clearance.keep_radius, {10.0, 500.0}, "m");
  reader.flag("unknown_blocks", map.unknown_blocks);
}

void readField(ConfigReader reader, DistanceFieldConfig& field) {
  reader.number("tight_weight", field.tight_weight, {0.0, 20.0}, "1");
  reader.number("max_distance", field.max_distance, {10.0, 1000.0}, "m");
}

void readSearch(ConfigReader reader, SearchConfig& search) {
  reader.number("horizon", search.horizon, {0.0, 60.0}, "s, 0 = six patterns");
  reader.number("reverse_penalty", search.reverse_penalty, {0.0, 20.0}, "1");
  reader.number("near_penalty", search.near_penalty, {0.0, 20.0}, "1");
  reader.number("shock_weight", search.shock.weight, {0.0, 100.0}, "s, 0 = off");
  reader.number("shock_harmless", search.shock.harmless, {0.01, 20.0}, "m/s2");
  reader.number("top_speed", search.top_speed, {0.05, kNoLimit}, "m/s");
}

/// The limits can be made stricter, or slightly wider; none can be disabled.
void readAges(ConfigReader reader, bool logged, AgeLimits& ages) {
  reader.seconds("pose", ages.pose, {0.02, 0.3});
  reader.seconds("bridge", ages.bridge, {0.1, 1.0});
  // A log may be from a time with wider limits.
  const double widest = logged ? 10.0 : 1.0;
  reader.seconds("map_slow", ages.map_slow, {0.2, widest});
  reader.seconds("map_stop", ages.map_stop, {0.3, widest});
  reader.seconds("pattern_set", ages.pattern_set, {2.5, 30.0});
}

/// Distances in sizes of the robot, measured on one of 1.5 x .8 m.
constexpr double kFrontier = 1.7;  // [1] lengths before the unknown where a plan may end
constexpr double kWide = 1.7;      // [1] half widths of clearance from which ground is open

constexpr double kFarthest = 1e6;  // [m] largest distance of a goal from the origin of map
constexpr int kMaxTileCells = 512;

constexpr int64_t kMapForgotten =
    3'000'000;  // [us] without a tile, after which another map may come
constexpr int64_t kOtherForgotten = 5'000'000;  // [us] without a set other than the one in use
constexpr int64_t kOtherLate = 1'000'000;       // [us] by which a message may be late
/// Largest advance of a learner's version while it lives, or after a restart with its state
/// [versions].
constexpr int64_t kMostJump = 100'000;
constexpr int64_t kPlanRepeat = 200'000;    // [us]
constexpr int64_t kTreeRepeat = 1'000'000;  // [us]
constexpr size_t kTreeNodes = 600;          // largest number drawn: 15 kB

/// nullopt for an invalid message; the same below.
std::optional<Goal> goalFrom(const goal_t& message) {
  const double* pose = message.goal_pose;
  const bool finite =
      std::abs(pose[0]) < kFarthest && std::abs(pose[1]) < kFarthest && std::isfinite(pose[2]);
  const bool tolerant = message.position_tolerance > 0.0 && message.yaw_tolerance > 0.0 &&
                        message.position_tolerance < kFarthest;
  if (!finite || !tolerant || message.goal_id == 0) return std::nullopt;
  return Goal{message.goal_id,
              {pose[0], pose[1], pose[2]},
              message.position_tolerance,
              message.yaw_tolerance};
}

std::optional<ShockKnowledge> shockFrom(const shock_t& message) {
  ShockKnowledge shock;
  const double* c = message.shock_covariance;
  shock.model.mean = Eigen::Map<const Eigen::Vector3d>(message.shock_weights);
  shock.model.covariance << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  shock.model.variance = message.shock_variance;
  const Eigen::Vector3d& w = shock.model.mean;
  // A model in which rougher ground or a higher speed shakes less is forged.
  const bool possible = w.allFinite() && shock.model.covariance.allFinite() &&
                        std::abs(w[0]) < 10.0 && w[1] >= 0.0 && w[1] < 5.0 && w[2] >= 0.0 &&
                        w[2] < 10.0 && message.shock_variance >= 0.0 && c[0] >= 0.0 &&
                        c[3] >= 0.0 && c[5] >= 0.0;
  if (!possible) return std::nullopt;
  if (message.here_shock > 0.0 && message.here_shock < 100.0) shock.here = message.here_shock;
  return shock;
}

std::optional<Tile> tileFrom(const map_tile_t& message) {
  const int side = message.tile_cells;
  if (side < 1 || side > kMaxTileCells || message.num_cells != side * side) return std::nullopt;
  if (!(message.cell_size >= kFinestCell && message.cell_size <= kCoarsestCell)) return {};
  if (std::abs(static_cast<int64_t>(message.tile_x)) * side > 1'000'000 ||
      std::abs(static_cast<int64_t>(message.tile_y)) * side > 1'000'000)
    return std::nullopt;
  return Tile{message.tile_x, message.tile_y, message.utime, message.cells};
}

/// Without seq and search_time.
plan_t toMessage(const PlanReport& report) {
  auto message = blank<plan_t>();
  message.utime = report.utime;
  message.goal_id = report.goal_id;
  message.set_version = report.set_version;
  message.plan_status = static_cast<int16_t>(report.status);
  message.reason_code = static_cast<int16_t>(report.reason.code);
  message.reason = report.reason.words;
  message.time_to_go = report.time_to_go;
  message.risk = report.risk.touch;
  message.risk_per_metre = report.risk.per_metre;
  message.expansions = report.expansions;
  message.num_patterns = static_cast<int32_t>(report.steps.size());
  message.execution_id = report.execution_ids;
  for (const PlanStep& step : report.steps) {
    message.pattern_id.push_back(step.pattern_id);
    message.pose.push_back({step.T_map_end.x, step.T_map_end.y, step.T_map_end.yaw});
    const Uncertainty& u = step.uncertainty;
    message.covariance.push_back({u.xx, u.xy, u.xyaw, u.yy, u.yyaw, u.yawyaw});
  }
  return message;
}

/// Without utime and seq.
plan_tree_t toMessage(const std::vector<TreeNode>& tree, const std::vector<int>& branch) {
  auto message = blank<plan_tree_t>();
  message.num_nodes = static_cast<int32_t>(tree.size());
  for (const TreeNode& node : tree) {
    message.parent.push_back(node.parent);
    message.by_pattern.push_back(node.pattern_id);
    message.node_pose.push_back({static_cast<float>(node.T_map_body.x),
                                 static_cast<float>(node.T_map_body.y),
                                 static_cast<float>(node.T_map_body.yaw)});
    message.time_at.push_back(static_cast<float>(node.time));
  }
  message.num_best = static_cast<int32_t>(branch.size());
  message.best.assign(branch.begin(), branch.end());
  return message;
}

PlannerConfig readConfig(ConfigReader& reader, bool logged) {
  PlannerConfig config;
  PlanningMapConfig& map = config.map;
  readRobotInto(reader, logged, config);
  map.field.inflation = map.footprint.half_width;
  map.field.wide = kWide * map.footprint.half_width;
  config.search.frontier = kFrontier * map.footprint.length();
  // Open ground must be represented as wide, for any robot size.
  map.clearance.clearance_cap =
      std::max({map.clearance.clearance_cap, 1.5 * map.footprint.half_width, map.field.wide});
  readMargins(reader.section("margins"), map.margins);
  readMap(reader.section("map"), map);
  readField(reader.section("field"), map.field);
  readSearch(reader.section("search"), config.search);
  ConfigReader policy = reader.section("policy");
  policy.seconds("patience", config.policy.patience, {2.0, 600.0});
  reader.flag("come_close", map.come_close);
  ConfigReader side = reader.section("side_hysteresis");
  side.number("gain", config.side_hysteresis.gain, {0.0, 60.0}, "s");
  readAges(reader.section("ages"), logged, config.ages);
  reader.seconds("deadline", config.deadline, {0.005, 0.045});
  reader.text("store", config.store);
  const Margins& margins = map.margins;
  config.sweep = resolutionFor(map.footprint, std::max(margins.plan, margins.largest), {});
  config.effective = reader.effective();
  return config;
}

}  // namespace

PlannerConfig readLoggedPlannerConfig(ConfigReader& reader) {
  return readConfig(reader, true);
}

PlannerConfig readPlannerConfig(ConfigReader& reader) {
  PlannerConfig config = readConfig(reader, false);
  reader.finish();
  return config;
}

PlannerNode::PlannerNode(const PlannerConfig& config, Bus& bus, Store* store)
    : config_(config),
      bus_(bus),
      store_(store),
      health_(bus, "planner", config.effective),
      robot_(bus, health_, config.operators.lease_us),
      fences_(config.map.fences),
      fence_exchange_(bus, "planner", "motor_bridge",
                      [this](const FenceRequest& request) { take(request); }),
      supervisor_(config, bus.bootId()) {
  subscribe();
  recallFences();
  robot_.on_ins = [this](const ins_t& message) { position_std_ = horizontalStd(message); };
}

void PlannerNode::subscribe() {
  health_.watchNamesakes();
  bus_.subscribe<map_tile_t>(kMap, [this](const map_tile_t& message) { take(message); });
  bus_.subscribe<fence_t>(kFence, [this](const fence_t& message) { take(requestFrom(message)); });
  bus_.subscribe<stopping_t>(kStoppingTime, [this](const stopping_t& message) {
    const bool possible = message.stopping_time >= 0.05 && message.stopping_time <= 5.0;
    if (!possible) return health_.addToCounter("STOPPING refused: no such time");
    if (message.stops > 0) supervisor_.setStoppingTime(message.stopping_time);
  });
  bus_.subscribe<shock_t>(kShock, [this](const shock_t& message) {
    const std::optional<ShockKnowledge> shock = shockFrom(message);
    if (!shock) return health_.addToCounter("SHOCK refused: no such ground");
    supervisor_.setShock(*shock);
  });
  bus_.subscribe<grip_t>(kGrip, [this](const grip_t& message) {
    // A restarted learner with little evidence lifts no limit of the earlier one.
    constexpr int kFew = 3;
    const GripKnowledge& known = supervisor_.grip();
    const bool begins = message.grip_signs < kFew && message.gave_way == 0;
    if (begins && (known.gave_way || (message.grip_signs <= 0 && known.deceleration < kNoLimit)))
      return;
    const bool possible = message.deceleration >= 0.05 && message.deceleration <= 20.0;
    if (!possible) return health_.addToCounter("GRIP refused: no such deceleration");
    supervisor_.setGrip({message.deceleration, message.gave_way != 0, message.grip_signs});
  });
  bus_.overhear<health_t>(kHealth, [this](const health_t& message) { take(message); });
  bus_.subscribe<goal_t>(kGoal, [this](const goal_t& message) { take(message); });
  bus_.subscribe<pattern_set_part_t>(kPatternSet,
                                     [this](const pattern_set_part_t& message) { take(message); });
}

void PlannerNode::recallFences() {
  if (store_ == nullptr) return;
  KeptFences kept = readFences(*store_);
  const auto take = [&](const Fence& fence, bool holders) {
    const FenceReceipt receipt = fences_.take({"", false, fence}, holders);
    kept.lost |= receipt != FenceReceipt::kAdded && receipt != FenceReceipt::kKnown;
  };
  for (const Fence& fence : kept.holders) take(fence, true);
  for (const Fence& fence : kept.others) take(fence, false);
  if (kept.lost) fences_.take({"", false, lostFences()}, true);
  supervisor_.map().setFences(fences_.fences());
  fences_kept_ = fences_.revision();
}

/// After sending PROGRAM, and not often: a slow disk must not delay it and stop the robot.
void PlannerNode::keepFences(int64_t utime) {
  if (store_ == nullptr || fences_kept_ == fences_.revision() || utime < next_keep_) return;
  next_keep_ = utime + kKeepEvery;
  const std::vector<Fence>& all = fences_.fences();
  const auto holders = all.begin() + static_cast<std::ptrdiff_t>(fences_.own());
  const auto others = all.begin() + static_cast<std::ptrdiff_t>(fences_.lasting());
  const auto problem = writeFences(*store_, {{holders, others}, {others, all.end()}});
  unkept_ = problem ? "fences not kept for the next start: " + *problem : "";
  if (!problem) fences_kept_ = fences_.revision();
}

void PlannerNode::take(const map_tile_t& message) {
  if (robot_.invalidTime(message.utime, "MAP")) return;
  std::optional<Tile> tile = tileFrom(message);
  // A second mapping, or a forged tile, must not empty the first one's map.
  const bool in_use = cell_size_ > 0.0 && bus_.now() - map_taken_ < kMapForgotten;
  if (tile && in_use && message.cell_size != cell_size_)
    return health_.addToCounter("MAP refused: another cell size than that of the map in use");
  if (!tile || !supervisor_.map().put(std::move(*tile), message.cell_size, message.tile_cells))
    return health_.addToCounter("MAP refused: invalid sizes");
  cell_size_ = message.cell_size;
  map_taken_ = bus_.now();
}

void PlannerNode::take(const FenceRequest& request) {
  const OperatorLease& lease = robot_.operatorLease();
  const bool holds = lease.valid(bus_.now()) && lease.isHolder(request.by);
  const FenceReceipt receipt = fences_.take(request, holds);
  if (receipt == FenceReceipt::kAdded || receipt == FenceReceipt::kRemoved) {
    return supervisor_.map().setFences(fences_.fences());
  }
  if (receipt != FenceReceipt::kKnown)
    health_.addToCounter(std::string("FENCE refused: ") + describe(receipt));
}

void PlannerNode::take(const goal_t& message) {
  if (message.goal_id == 0) return goal_.cancel();
  const std::optional<Goal> goal = goalFrom(message);
  if (!goal) return health_.addToCounter("GOAL refused: invalid pose or tolerances");
  const bool leased = config_.operators.lease_us > 0;
  if (leased && robot_.untimely(message.utime, "GOAL")) return;
  if (!goal_.take(*goal, bus_.now())) health_.addToCounter("GOAL refused: it has ended before");
}

void PlannerNode::take(const health_t& message) {
  if (message.process != "mapping") return;
  const bool failed = message.health_state == health_t::HEALTH_FAILED;
  inputs_.map_fault =
      failed ? Reason(StopReason::kRangeFinder, "mapping: " + message.health_reason) : Reason();
}

/// A person who arms again has checked the robot.
void PlannerNode::disarm(const std::string& why) {
  auto message = blank<arm_t>();
  message.utime = bus_.now();
  message.seq = seq_arm_++;
  message.armed = 0;
  message.armed_by = "planner";
  message.arm_reason = why;
  bus_.publish(kArm, message);
}

void PlannerNode::watchGoal(int64_t utime) {
  const bool leased = config_.operators.lease_us > 0;
  std::optional<int64_t> armed_since;
  if (leased && inputs_.armed_by_operator) armed_since = inputs_.armed_since;
  goal_.update(utime, armed_since, [&](int64_t goal_id) {
    return !leased || robot_.operatorLease().standsFor(goal_id, utime);
  });
  inputs_.goal = goal_.goal();
  inputs_.goal_lost = goal_.lost();
  if (config_.operators.lost == OperatorLost::kGoBack) watchLink(utime);
}

/// Without an operator there is no goal, but the return may set one.
void PlannerNode::watchLink(int64_t utime) {
  const OperatorLease& lease = robot_.operatorLease();
  LinkReading link;
  link.now = utime;
  if (inputs_.pose) link.T_map_body = inputs_.pose->T_map_body;
  link.position_std = position_std_;
  link.good = lease.valid(utime) && utime - *lease.newestSeen() < lease.leaseUs() / 2;
  link.lost = lease.state(utime) == OperatorLease::State::kLost;
  link.armed = inputs_.armed_by_operator && inputs_.bridge && inputs_.bridge->armed();
  const std::optional<Goal> goal = way_back_.update(link);
  if (goal) inputs_.goal = goal;
  if (!way_back_.state().empty()) inputs_.goal_lost = way_back_.state();
}

void PlannerNode::take(const pattern_set_part_t& message) {
  const int64_t refused = sets_.refused();
  const int64_t older = sets_.older();
  if (outOfReach(message.set_version))
    return noteOtherSet(message.set_version, "PATTERN_SET refused: far above the learner's");
  const std::optional<PatternSet> set = sets_.add(message);
  if (sets_.refused() > refused) return health_.addToCounter("PATTERN_SET refused");
  inputs_.set_received = bus_.now();
  if (sets_.older() > older)
    return noteOtherSet(message.set_version, "PATTERN_SET ignored: older than the set in use");
  // The first part of a much higher version does not prove that the learner of the present set is
  // alive.
  if (set || message.set_version <= set_version_ + kMostJump) set_heard_ = bus_.now();
  if (!set) return;
  set_version_ = set->version();
  const int64_t started = bus_.now();
  const bool taken = supervisor_.takeSet(*set);
  if (!taken) health_.addToCounter("PATTERN_SET refused: it waits");
  longest_swap_ = std::max(longest_swap_, bus_.now() - started);
  health_.setCounter("longest swap of a set [us]", longest_swap_);
}

/// Whether no learner can have reached a version: once in use it would stay forever, because a
/// learner goes above versions that others name, but not above implausible ones.
bool PlannerNode::outOfReach(int64_t version) const {
  if (set_version_ == 0) return version > PatternSet::kHighestVersion;
  // A learner that has lost its state may start far above, and then the earlier one no longer
  // publishes.
  const bool goes_on = bus_.now() - set_heard_ < kOtherForgotten;
  const int64_t from = goes_on ? set_version_ : std::max(set_version_, PatternSet::kHighestVersion);
  return version > from + kMostJump;
}

/// A single one may be late; a learner that continues with other versions is a second one.
void PlannerNode::noteOtherSet(int64_t version, const char* counter) {
  const int64_t now = bus_.now();
  if (now - other_heard_ > kOtherForgotten) other_since_ = now;
  other_heard_ = now;
  other_version_ = version;
  health_.addToCounter(counter);
}

std::string PlannerNode::secondLearner(int64_t utime) const {
  const bool goes_on = other_heard_ > 0 && utime - other_heard_ < kOtherForgotten &&
                       other_heard_ - other_since_ > kOtherLate;
  if (!goes_on) return "";
  return "PATTERN_SET of version " + std::to_string(other_version_) + " is published beside " +
         std::to_string(set_version_) + ", which is in use: does a second learner run? end it";
}

void PlannerNode::step(int64_t utime) {
  if (robot_.timeJumped(utime) && inputs_.set_received != 0) inputs_.set_received = utime;
  static_cast<RobotReadings&>(inputs_) = robot_.readings(utime);
  watchGoal(utime);
  inputs_.bar = Reason::of(StopReason::kFencesLost, fences_.bar());
  const int64_t started = bus_.now();
  const Decision decision = supervisor_.step(inputs_, [&](int expansions) {
    return stop_ ? stop_(expansions) : bus_.now() - started > config_.deadline;
  });
  if (!decision.halted.empty() && config_.operators.lease_us > 0)
    goal_.lose({decision.halted.code,
                "stopped: " + decision.halted.words + "; look, then give the goal again"});
  if (!decision.halted.empty() && !inputs_.map_fault.empty()) disarm(inputs_.map_fault.words);
  // The loss itself stops the robot, too.
  if (!decision.halted.empty() && inputs_.goal) way_back_.giveUp(decision.halted.words);
  publishProgram(utime, supervisor_.program());
  keepFences(utime);
  publishPlan(utime, decision, bus_.now() - started);
  publishHealth(utime, decision.report);
}

void PlannerNode::shutdown(int64_t utime) {
  publishProgram(utime, ExecutionTracker(supervisor_.program().runId()));
  next_keep_ = 0;
  keepFences(utime);
}

void PlannerNode::publishProgram(int64_t utime, const ExecutionTracker& program) {
  bus_.publish(kProgram, programOf(program, bus_, utime, seq_program_++, config_.lease));
}

void PlannerNode::publishPlan(int64_t utime, const Decision& decision, int64_t search_time) {
  if (!decision.planned && utime < next_plan_) return;
  next_plan_ = utime + kPlanRepeat;
  plan_t message = toMessage(decision.report);
  message.seq = seq_plan_++;
  if (decision.report.goal_id < 0) {
    const Reason& back = way_back_.state();
    if (message.reason.empty()) message.reason_code = static_cast<int16_t>(back.code);
    message.reason = back.words + (message.reason.empty() ? "" : "; " + message.reason);
  }
  message.search_time = static_cast<int32_t>(search_time);
  bus_.publish(kPlan, message);
  if (!decision.planned || utime < next_tree_) return;
  next_tree_ = utime + kTreeRepeat;
  publishTree(decision.report);
}

void PlannerNode::publishTree(const PlanReport& report) {
  const std::vector<TreeNode> tree = supervisor_.search().tree(kTreeNodes);
  if (tree.empty()) return;
  plan_tree_t message = toMessage(tree, supervisor_.search().branch());
  message.utime = report.utime;
  message.seq = seq_tree_++;
  bus_.publish(kPlanTree, message);
}

void PlannerNode::publishHealth(int64_t utime, const PlanReport& report) {
  const bool waits = report.status == PlanStatus::kWaiting;
  std::string problem = fences_.bar();
  if (problem.empty()) problem = waits ? report.reason.words : supervisor_.setRefusal();
  if (problem.empty()) problem = unkept_;
  if (problem.empty()) problem = secondLearner(utime);
  if (problem.empty()) problem = way_back_.state().words;
  health_.setState(problem.empty() ? health_t::HEALTH_OK : health_t::HEALTH_DEGRADED, problem);
  fence_exchange_.step(fences_);
  health_.setCounter("pattern set version", report.set_version);
  for (const auto& [name, value] : supervisor_.counters()) health_.setCounter(name, value);
  health_.step(utime);
}

}  // namespace tread::planner
