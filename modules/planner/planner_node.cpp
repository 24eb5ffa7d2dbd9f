// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/planner_node.hpp"

#include <algorithm>

#include "common/messages/blank.hpp"
#include "common/messages/ins_messages.hpp"
#include "modules/planner/planner_messages.hpp"

namespace tread::planner {
namespace {

constexpr int64_t kPlanRepeat = 200'000;    // [us]
constexpr int64_t kTreeRepeat = 1'000'000;  // [us]
constexpr int64_t kMaxFuture = 100'000;     // [us] by which a utime may be ahead
constexpr size_t kTreeNodes = 600;          // drawn at most: 15 kB

}  // namespace

PlannerNode::PlannerNode(const PlannerConfig& config, Bus& bus)
    : config_(config),
      bus_(bus),
      health_(bus, "planner", config.effective),
      supervisor_(config, bus.bootId()),
      permission_(bus.now()) {
  subscribe();
}

void PlannerNode::subscribe() {
  bus_.subscribe<ins_t>(kIns, [this](const ins_t& message) { take(message); });
  bus_.subscribe<map_tile_t>(kMap, [this](const map_tile_t& message) { take(message); });
  bus_.subscribe<goal_t>(kGoal, [this](const goal_t& message) { take(message); });
  bus_.subscribe<pattern_set_part_t>(kPatternSet,
                                     [this](const pattern_set_part_t& message) { take(message); });
  bus_.subscribe<motor_t>(kMotor, [this](const motor_t& message) { take(message); });
  bus_.subscribe<execution_t>(kExecution, [this](const execution_t& message) { take(message); });
  bus_.subscribe<arm_t>(kArm,
                        [this](const arm_t& message) { permission_.take(message, bus_.now()); });
  bus_.subscribe<estop_t>(
      kEstop, [this](const estop_t& message) { permission_.take(message, bus_.now()); });
}

/// A time that has not come yet would look fresh for ever, and so would one whose age overflows.
bool PlannerNode::senselessTime(int64_t utime, const char* channel) {
  const bool future = utime > bus_.now() + kMaxFuture;
  if (utime > 0 && !future) return false;
  health_.addToCounter(std::string(channel) +
                       (future ? " refused: from the future" : " refused: no such time"));
  return true;
}

void PlannerNode::take(const ins_t& message) {
  if (senselessTime(message.utime, "INS")) return;
  const std::optional<Pose2> pose = planarPose(message);
  if (!pose) return health_.addToCounter("INS without a pose");
  if (situation_.pose && message.utime <= situation_.pose->utime)
    return health_.addToCounter("INS out of order");
  situation_.pose = PoseReading{message.utime, *pose, planarTwist(message)};
}

void PlannerNode::take(const map_tile_t& message) {
  if (senselessTime(message.utime, "MAP")) return;
  std::optional<Tile> tile = tileFrom(message);
  if (!tile || !supervisor_.world().put(std::move(*tile), message.cell_size, message.tile_cells))
    health_.addToCounter("MAP refused: sizes make no sense");
}

void PlannerNode::take(const goal_t& message) {
  const std::optional<Goal> goal = goalFrom(message);
  if (!goal && message.goal_id != 0)
    return health_.addToCounter("GOAL refused: pose or tolerances make no sense");
  situation_.goal = goal;
}

void PlannerNode::take(const pattern_set_part_t& message) {
  const int64_t refused = sets_.refused();
  const std::optional<PatternSet> set = sets_.add(message);
  if (sets_.refused() > refused) return health_.addToCounter("PATTERN_SET refused");
  situation_.set_received = bus_.now();
  if (!set) return;
  const int64_t started = bus_.now();
  const bool taken = supervisor_.takeSet(*set);
  if (!taken) health_.addToCounter("PATTERN_SET refused: it waits");
  longest_swap_ = std::max(longest_swap_, bus_.now() - started);
  health_.setCounter("longest swap of a set [us]", longest_swap_);
}

void PlannerNode::take(const motor_t& message) {
  if (senselessTime(message.utime, "MOTOR")) return;
  if (situation_.bridge && message.utime < situation_.bridge->utime) return;
  situation_.bridge = readingFrom(message);
  permission_.take(*situation_.bridge);
}

void PlannerNode::take(const execution_t& message) {
  if (senselessTime(message.utime, "EXECUTION")) return;
  if (message.utime < executions_utime_) return;
  executions_utime_ = message.utime;
  situation_.executions = readingsFrom(message);
}

void PlannerNode::followTime(int64_t utime) {
  // A process that only hears the time does not know it at first, and may be frozen later: what it
  // noted before such a jump has no age, and who armed then did not arm this run.
  const bool jumped = stepped_ && std::abs(utime - *stepped_) > kTimeJump;
  stepped_ = utime;
  if (!jumped) return;
  if (situation_.set_received != 0) situation_.set_received = utime;
  permission_.restart(utime);
}

void PlannerNode::step(int64_t utime) {
  followTime(utime);
  situation_.now = utime;
  situation_.armed_by_operator = permission_.armed();
  situation_.estopped = permission_.estopped();
  const int64_t started = bus_.now();
  const Decision decision = supervisor_.step(situation_, [&](int expansions) {
    return stop_ ? stop_(expansions) : bus_.now() - started > config_.deadline;
  });
  publishProgram(utime);
  publishPlan(utime, decision, bus_.now() - started);
  publishHealth(utime, decision.report);
}

void PlannerNode::shutdown(int64_t utime) {
  bus_.publish(kProgram, emptyProgram(utime));
}

program_t PlannerNode::emptyProgram(int64_t utime) {
  auto message = blank<program_t>();
  message.utime = utime;
  message.seq = seq_program_++;
  message.run_id = supervisor_.program().runId();
  message.lease = static_cast<int32_t>(config_.lease);
  const BusStatistics& statistics = bus_.statistics();
  message.inputs_heard = statistics.received;
  message.newest_input = statistics.newest.channel;
  message.newest_input_utime = statistics.newest.utime;
  message.newest_input_seq = statistics.newest.seq;
  return message;
}

void PlannerNode::publishProgram(int64_t utime) {
  program_t message = emptyProgram(utime);
  message.running = toMessage(supervisor_.program().running());
  message.next = toMessage(supervisor_.program().next());
  bus_.publish(kProgram, message);
}

void PlannerNode::publishPlan(int64_t utime, const Decision& decision, int64_t search_time) {
  if (!decision.planned && utime < next_plan_) return;
  next_plan_ = utime + kPlanRepeat;
  plan_t message = toMessage(decision.report);
  message.seq = seq_plan_++;
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
  const std::string problem = waits ? report.reason : supervisor_.setRefusal();
  health_.setState(problem.empty() ? health_t::HEALTH_OK : health_t::HEALTH_DEGRADED, problem);
  health_.setCounter("pattern set version", report.set_version);
  for (const auto& [name, value] : supervisor_.counters()) health_.setCounter(name, value);
  health_.step(utime);
}

}  // namespace tread::planner
