// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/plan/task_planner.hpp"

#include <sys/resource.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "common/config/config_reader.hpp"
#include "common/config/scalars.hpp"
#include "common/grid/footprint.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/store/output_file.hpp"
#include "common/store/store.hpp"
#include "modules/planner/core/search/swept_footprint.hpp"
#include "tools/lab/plan/lattice_file.hpp"

namespace tread::plan {
namespace {

constexpr double kDeadline = 1000.0;  // [ms]

/// Comma-separated numbers, as many as `form` has names.
std::vector<double> readList(const std::string& option, const std::string& text,
                             const std::string& form, size_t count, Range range) {
  std::vector<double> values;
  for (size_t from = 0; from <= text.size();) {
    const size_t comma = std::min(text.find(',', from), text.size());
    const auto value = parseNumber(text.substr(from, comma - from));
    if (!value || *value < range.min || *value > range.max) break;
    values.push_back(*value);
    from = comma + 1;
    if (comma == text.size() && values.size() == count) return values;
  }
  throw std::runtime_error(option + " is " + formatText(text.substr(0, 60)) + "; " + form +
                           " is needed, each " + formatNumber(range.min) + ".." +
                           formatNumber(range.max));
}

std::optional<Pose2> readPose(const std::string& option, const std::string& text,
                              const std::optional<Pose2>& otherwise) {
  if (text.empty()) return otherwise;
  const auto values = readList(option, text, "x,y,yaw [m, m, rad]", 3, {-1e6, 1e6});
  return Pose2{values[0], values[1], values[2]};
}

RobotShape readShape(const PlanOptions& options, const MapFile& map) {
  if (!options.footprint.empty() && options.radius)
    throw std::runtime_error("--footprint and --radius exclude each other");
  if (!options.footprint.empty()) {
    const auto size =
        readList("--footprint", options.footprint, "LENGTH,WIDTH [m]", 2, {1e-3, 100.0});
    return {size[0], size[1], 0.0};
  }
  if (!options.radius && map.costs.empty())
    throw std::runtime_error(
        "the map does not describe the robot; give --footprint LENGTH,WIDTH or --radius (0 = a "
        "point)");
  return {0.0, 0.0, options.radius.value_or(0.0)};
}

bool evenlySpaced(const PrimitiveFile& file) {
  const double bin = 2.0 * kPi / static_cast<double>(file.headings.size());
  for (size_t i = 0; i < file.headings.size(); ++i)
    if (std::abs(file.headings[i] - static_cast<double>(i) * bin) > 1e-3) return false;
  return true;
}

void checkExact(const PlanTask& task) {
  if (!task.primitives) throw std::runtime_error("--mprim-exact needs --patterns with a .mprim");
  if (!task.shape.isPoint())
    throw std::runtime_error("--mprim-exact plans for a point; leave --footprint and --radius out");
  if (task.map.costs.empty())
    throw std::runtime_error("--mprim-exact needs --map with an SBPL environment (.cfg)");
  if (!evenlySpaced(*task.primitives))
    throw std::runtime_error("--mprim-exact needs headings that are evenly spaced; those of " +
                             task.primitives->name + " are not");
  if (std::abs(task.primitives->resolution - task.grid.cellSize()) > 1e-9)
    throw std::runtime_error("--mprim-exact needs cells of one size; " + task.map.name + " has " +
                             formatNumber(task.grid.cellSize()) + " m, " + task.primitives->name +
                             " " + formatNumber(task.primitives->resolution) + " m");
}

void readPatterns(const PlanOptions& options, PlanTask& task) {
  const std::string extension = std::filesystem::path(options.patterns).extension().string();
  if (extension == ".mprim") {
    task.primitives = readPrimitives(options.patterns);
  } else if (extension == ".json") {
    task.primitives = readLattice(options.patterns);
  } else {
    task.patterns = readPatternFile(options.patterns);
  }
  task.pace.speed = options.speed.value_or(task.map.nominal_speed.value_or(task.pace.speed));
  task.pace.turn_time =
      options.turn_time.value_or(task.map.turn_time.value_or(task.pace.turn_time));
}

std::vector<PlanQuery> drawQueries(const PlanOptions& options, const PlanTask& task) {
  const ClearanceField clearance(task.grid, true);
  const RandomQueries wanted{static_cast<size_t>(options.random), options.seed, options.apart};
  return randomQueries(task.grid, task.map.T_map_grid, wanted, [&](const Pose2& T_grid_body) {
    return standsFree(task, clearance, T_grid_body);
  });
}

std::vector<PlanQuery> theQuery(const PlanOptions& options, const MapFile& map) {
  const auto start = readPose("--start", options.start, map.T_map_start);
  const auto goal = readPose("--goal", options.goal, map.T_map_goal);
  if (!start || !goal)
    throw std::runtime_error("no query; give --start and --goal, --queries or --random");
  return {{*start, *goal}};
}

void readWanted(const PlanOptions& options, PlanTask& task) {
  const bool random = options.random > 0;
  const bool single = !options.start.empty() || !options.goal.empty();
  if ((random ? 1 : 0) + (options.queries.empty() ? 0 : 1) + (single ? 1 : 0) > 1)
    throw std::runtime_error("--start and --goal, --queries and --random exclude each other");
  if (!options.write_queries.empty() && !random)
    throw std::runtime_error("--write-queries needs --random");
  task.many = random || !options.queries.empty();
  if (task.many && !options.picture.empty())
    throw std::runtime_error("--picture shows one plan; leave --queries and --random out");
  if (!task.many) {
    task.queries = theQuery(options, task.map);
  } else {
    task.queries = random ? drawQueries(options, task) : readQueries(options.queries);
  }
}

using Clock = std::chrono::steady_clock;

/// A point still needs an outline: far smaller than a cell.
constexpr double kPoint = 1e-3;  // [m]
constexpr size_t kDrawnNodes = 60'000;

/// Measures the time of one query [ms].
struct Watch {
  /// `spent` of the deadline has already passed.
  explicit Watch(std::optional<double> until = std::nullopt, double spent = 0.0) : deadline(until) {
    if (deadline) deadline = std::max(0.0, *deadline - spent);
  }

  double now() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  }
  /// Slightly before the deadline: the rest is needed to assemble the answer.
  bool isLate() const { return deadline && now() >= *deadline - std::min(2.0, *deadline / 20); }

  Clock::time_point begin = Clock::now();
  std::optional<double> deadline;
  std::optional<double> searching;  ///< when the heuristics were computed
  std::optional<double> first;      ///< when the first plan was found
};

double peakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

FootprintSize footprintOf(const RobotShape& shape) {
  const double length = shape.isRectangle() ? shape.length : kPoint;
  const double width = shape.isRectangle() ? shape.width : kPoint;
  return {length / 2.0, length / 2.0, width / 2.0};
}

/// Resolution of sweep checks: a point must not skip a cell.
planner::SweepResolution sweepResolution(const PlanTask& task) {
  planner::SweepResolution step;
  if (task.shape.isRectangle()) return planner::resolutionFor(footprintOf(task.shape), 0.0, step);
  step.distance = step.covered = std::min(step.distance, task.grid.cellSize() / 2);
  step.outline = footprintOf(task.shape);
  return step;
}

}  // namespace

PlanTask loadTask(const PlanOptions& options) {
  PlanTask task;
  task.map = readMap(options.map);
  for (const std::string& output : {options.json, options.picture, options.write_queries})
    refuseToReplace(output, {task.map.image});
  task.shape = readShape(options, task.map);
  task.grid = task.shape.isPoint() ? gridForPoint(task.map) : gridForFootprint(task.map);
  if (task.shape.radius > 0.0) task.grid = grownBy(task.grid, task.shape.radius);
  readPatterns(options, task);
  task.exact = options.exact;
  if (task.exact) checkExact(task);
  const auto tolerance =
      readList("--tolerance", options.tolerance, "METRES,RADIANS", 2, {1e-3, 1e3});
  task.position_tolerance = tolerance[0];
  task.yaw_tolerance = tolerance[1];
  task.come_close = options.come_close;
  if (task.come_close && task.exact)
    throw std::runtime_error("--come-close is for footprints; leave it out with --mprim-exact");
  task.deadline_ms = options.deadline_ms;
  if (!task.deadline_ms && !task.exact) task.deadline_ms = kDeadline;
  readWanted(options, task);
  if (!options.write_queries.empty()) writeText(options.write_queries, formatQueries(task.queries));
  return task;
}

bool standsFree(const PlanTask& task, const ClearanceField& clearance, const Pose2& T_grid_body) {
  if (task.shape.isRectangle()) {
    const double half_length = task.shape.length / 2.0;
    const Footprint footprint({half_length, half_length, task.shape.width / 2.0}, 0.0);
    return footprint.isFree(clearance, turned(T_grid_body));
  }
  return isFree(task.grid.at(task.grid.indexOf(T_grid_body.position())));
}

TaskPlanner::TaskPlanner(const PlanTask& task) : task_(task) {
  const Watch watch;
  if (task.exact)
    prepareLattice();
  else
    preparePlanner();
  preparation_ms_ = watch.now();
}

void TaskPlanner::prepareLattice() {
  primitives_ = onLattice(*task_.primitives, task_.pace);
  const CostThresholds& thresholds = task_.map.thresholds;
  const CellCosts costs(task_.grid.width(), task_.grid.height(), task_.map.costs,
                        std::min(thresholds.obstacle, thresholds.inscribed));
  lattice_ = std::make_unique<LatticePlanner>(costs, task_.grid.cellSize(),
                                              static_cast<int>(task_.primitives->headings.size()),
                                              primitives_);
}

void TaskPlanner::preparePlanner() {
  if (task_.patterns) {
    patterns_ = std::make_unique<planner::PatternTable>(*task_.patterns, sweepResolution(task_),
                                                        planner::DefaultSigma{});
    if (const std::string defect = patterns_->defect(); !defect.empty())
      throw std::runtime_error("--patterns: " + defect);
  } else {
    primitives_ = headingFree(*task_.primitives, task_.pace);
    patterns_ = std::make_unique<planner::PatternTable>(
        std::vector<planner::Primitive>{primitives_.begin(), primitives_.end()},
        sweepResolution(task_));
  }
  planner::PathConfig config;
  config.footprint = footprintOf(task_.shape);
  if (!task_.shape.isRectangle()) config.grown = task_.shape.radius;
  planner_ = std::make_unique<planner::PathPlanner>(task_.grid, *patterns_, config);
}

PlanAnswer TaskPlanner::answer(const PlanQuery& query, double spent_ms) {
  Watch watch(task_.deadline_ms, spent_ms);
  planner::PathQuery wanted;
  wanted.T_map_start = between(task_.map.T_map_grid, query.T_map_start);
  wanted.T_map_goal = between(task_.map.T_map_grid, query.T_map_goal);
  wanted.position_tolerance = task_.position_tolerance;
  wanted.yaw_tolerance = task_.yaw_tolerance;
  wanted.come_close = task_.come_close;
  const planner::PathEvents events{
      [&watch] { watch.searching = watch.now(); },
      [&watch](double, int) { watch.first = watch.first.value_or(watch.now()); }};
  const auto stop = [&watch](int) { return watch.isLate(); };
  const planner::PathAnswer found =
      task_.exact ? lattice_->answer(wanted, stop, events) : planner_->answer(wanted, stop, events);
  PlanAnswer answer;
  answer.total_ms = watch.now();
  answer.first_solution_ms = watch.first;
  if (!task_.exact) answer.heuristic_ms = watch.searching.value_or(0.0);
  answer.expansions = found.search.expansions;
  answer.end = found.end;
  answer.all_seen = found.search.exhausted;
  answer.reason = found.reason;
  tellPlan(wanted.T_map_start, found.search, answer);
  if (answer.end != planner::PathEnd::kSolved || found.closest)
    answer.closest = closestApproach(found, query, answer);
  answer.memory_mb = peakMegabytes();
  return answer;
}

std::string TaskPlanner::nameOf(int number) const {
  if (!task_.patterns) return std::to_string(primitives_[static_cast<size_t>(number)].file_id);
  const MotionPattern* pattern = task_.patterns->find(number);
  return pattern == nullptr ? std::to_string(number) : pattern->name;
}

void TaskPlanner::tellPlan(const Pose2& T_grid_start, const planner::SearchResult& result,
                           PlanAnswer& answer) const {
  if (result.steps.empty()) return;
  const auto tell = [&](const Pose2& T_grid_body) {
    Pose2 pose = task_.map.T_map_grid * T_grid_body;
    pose.yaw = wrapAngle(pose.yaw);
    answer.poses.push_back(pose);
  };
  Pose2 T_grid_begin = T_grid_start;
  tell(T_grid_begin);
  for (const planner::PlanStep& step : result.steps) {
    const planner::TablePattern& pattern = *patterns().find(step.pattern_id);
    for (const planner::SweptPose& at : pattern.swept_poses) tell(T_grid_begin * at.pose);
    T_grid_begin = step.T_map_end;
    answer.ends.push_back(answer.poses.size() - 1);
    answer.patterns.push_back(nameOf(step.pattern_id));
    answer.length += pattern.length;
  }
  answer.time = result.steps.back().time;
  answer.cost = result.cost;
}

ClosestApproach TaskPlanner::closestApproach(const planner::PathAnswer& found,
                                             const PlanQuery& query,
                                             const PlanAnswer& answer) const {
  Eigen::Vector2d p_map = query.T_map_start.position();
  if (found.closest) {
    p_map = task_.map.T_map_grid * *found.closest;
  } else if (!answer.poses.empty()) {
    p_map = answer.poses.back().position();
  }
  return {p_map, (p_map - query.T_map_goal.position()).norm()};
}

PlanScene TaskPlanner::scene(const PlanQuery& query, const PlanAnswer& answer) const {
  PlanScene scene;
  scene.grid = task_.shape.isPoint() ? task_.grid : gridForFootprint(task_.map);
  scene.T_map_grid = task_.map.T_map_grid;
  const std::vector<planner::TreeNode> tree = search().tree(kDrawnNodes);
  for (const planner::TreeNode& node : tree) {
    if (node.parent < 0) continue;
    const Pose2 T_map_begin =
        task_.map.T_map_grid * tree[static_cast<size_t>(node.parent)].T_map_body;
    scene.tree.push_back({T_map_begin.position()});
    for (const planner::SweptPose& at : patterns().find(node.pattern_id)->swept_poses)
      scene.tree.back().push_back(T_map_begin * at.pose.position());
  }
  for (const Pose2& pose : answer.poses) scene.path.push_back(pose.position());
  if (!answer.poses.empty()) scene.stations.push_back(answer.poses.front());
  for (const size_t end : answer.ends) scene.stations.push_back(answer.poses[end]);
  if (task_.shape.isRectangle()) scene.outline = rectangle(task_.shape.length, task_.shape.width);
  scene.radius = task_.shape.radius;
  scene.T_map_start = query.T_map_start;
  scene.T_map_goal = query.T_map_goal;
  return scene;
}

}  // namespace tread::plan
