// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <array>
#include <cmath>

#include "common/grid/footprint.hpp"
#include "tests/tools/lab/plan/lattice_oracle.hpp"
#include "tests/tools/lab/plan/plan_samples.hpp"
#include "tools/lab/plan/task_planner.hpp"

using namespace tread;
using namespace tread::plan;
using namespace tread::plan::samples;
using Catch::Contains;

namespace {

const std::string kMaps = std::string(TREAD_SOURCE_DIR) + "/tests/data/planning/";
const std::string kSet = std::string(TREAD_SOURCE_DIR) + "/config/patterns/teodor.yaml";

/// Eight headings on cells of 0.1 m: a cell ahead, a cell back at three times the cost, an eighth
/// of a turn to each side, and from each heading a cell ahead combined with such a turn.
std::string eightHeadings() {
  constexpr std::array<std::array<int, 2>, 8> kAhead{
      {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
  std::string text = "resolution_m: 0.1\nnumberofangles: 8\ntotalnumberofprimitives: 48\n";
  for (int bin = 0; bin < 8; ++bin) {
    int id = 0;
    const auto add = [&](int cells, int turn, int multiplier) {
      const int dx = cells * kAhead[static_cast<size_t>(bin)][0];
      const int dy = cells * kAhead[static_cast<size_t>(bin)][1];
      const double yaw = bin * kPi / 4.0;
      text += "primID: " + std::to_string(id++) + "\nstartangle_c: " + std::to_string(bin) +
              "\nendpose_c: " + std::to_string(dx) + " " + std::to_string(dy) + " " +
              std::to_string((bin + turn + 8) % 8) +
              "\nadditionalactioncostmult: " + std::to_string(multiplier) +
              "\nintermediateposes: 2\n0 0 " + std::to_string(yaw) + "\n" +
              std::to_string(0.1 * dx) + " " + std::to_string(0.1 * dy) + " " +
              std::to_string(yaw + turn * kPi / 4.0) + "\n";
    };
    add(1, 0, 1);
    add(-1, 0, 3);
    add(0, 1, 1);
    add(0, -1, 1);
    add(1, 1, 2);
    add(1, -1, 2);
  }
  return text;
}

/// Cells of random cost, half of them inscribed or lethal.
std::string randomEnvironment(std::mt19937_64& random) {
  std::string text =
      "discretization(cells): 14 11\nobsthresh: 254\ncost_inscribed_thresh: 253\n"
      "cost_possibly_circumscribed_thresh: 128\ncellsize(meters): 0.1\nnominalvel(mpersecs): 0.7\n"
      "timetoturn45degsinplace(secs): 0.3\nstart(meters,rads): 0.05 0.05 0\n"
      "end(meters,rads): 1.35 1.05 1.57\nenvironment:\n";
  for (int i = 0; i < 14 * 11; ++i) {
    const bool end = i == 0 || i == 14 * 11 - 1;
    const uint64_t draw = random() % 12;
    const uint64_t cost = end || draw < 3 ? 0 : draw < 6 ? random() % 200 : 253 + random() % 2;
    text += std::to_string(cost) + ((i + 1) % 14 == 0 ? "\n" : " ");
  }
  return text;
}

PlanTask officeTask() {
  PlanOptions options;
  options.map = kMaps + "office.yaml";
  options.patterns = kSet;
  options.footprint = "1.3,0.68";
  options.start = "-13.5,0.1,0";
  options.goal = "13.5,0.1,0";
  PlanTask task = loadTask(options);
  task.deadline_ms = 20'000.0;
  return task;
}

}  // namespace

TEST_CASE("exact plans cost what Dijkstra finds, and unreachable is what it does not find") {
  std::mt19937_64 random(7);
  const Folder folder;
  PlanOptions options;
  options.patterns = folder.write("eight.mprim", eightHeadings());
  options.exact = true;
  size_t solved = 0;
  for (int i = 0; i < 60; ++i) {
    options.map = folder.write("random.cfg", randomEnvironment(random));
    const PlanTask task = loadTask(options);
    TaskPlanner planner(task);
    const PlanAnswer answer = planner.answer(task.queries.front());
    const int64_t least = LatticeOracle(task.map, *task.primitives).cost();
    CAPTURE(i, least);
    if (least < 0) {
      CHECK(answer.end == planner::PathEnd::kUnreachable);
      CHECK_FALSE(answer.reason.empty());
      continue;
    }
    ++solved;
    REQUIRE(answer.end == planner::PathEnd::kSolved);
    CHECK(answer.cost == static_cast<double>(least));
    CHECK(answer.poses.back().x == Approx(1.35));
    CHECK(answer.poses.back().y == Approx(1.05));
    CHECK(answer.poses.back().yaw == Approx(kPi / 2.0));
  }
  CHECK(solved > 15);
  CHECK(solved < 60);
}

TEST_CASE("a plan's poses are free, lead from the start to the goal and leave no gap") {
  const PlanTask task = officeTask();
  TaskPlanner planner(task);
  const PlanQuery& query = task.queries.front();
  const PlanAnswer answer = planner.answer(query);
  REQUIRE(answer.end == planner::PathEnd::kSolved);
  const ClearanceField clearance(task.grid, true);
  for (const Pose2& T_map_body : answer.poses)
    CHECK(standsFree(task, clearance, between(task.map.T_map_grid, T_map_body)));
  CHECK(answer.poses.front().x == query.T_map_start.x);
  const Pose2& end = answer.poses.back();
  CHECK((end.position() - query.T_map_goal.position()).norm() <= 0.25 + 1e-6);
  CHECK(std::abs(wrapAngle(end.yaw - query.T_map_goal.yaw)) <= 0.26 + 1e-6);
  double length = 0.0;
  for (size_t i = 1; i < answer.poses.size(); ++i) {
    const double step = (answer.poses[i].position() - answer.poses[i - 1].position()).norm();
    CHECK(step < 0.2);
    length += step;
  }
  CHECK(answer.length == Approx(length).epsilon(0.02));
  CHECK(answer.length >= 26.5);
  REQUIRE(answer.ends.size() == answer.patterns.size());
  CHECK(answer.ends.back() + 1 == answer.poses.size());
  CHECK(task.patterns->findByName(answer.patterns.front()) != nullptr);
  CHECK(answer.first_solution_ms);
  CHECK(*answer.first_solution_ms <= answer.total_ms);
  CHECK(answer.time > answer.length / 1.3);
  const PlanScene scene = planner.scene(query, answer);
  CHECK(scene.stations.size() == answer.patterns.size() + 1);
  CHECK(scene.tree.size() >= answer.patterns.size());
  CHECK(scene.outline.size() == 4);
}

TEST_CASE("a map's origin shifts and turns a plan and changes nothing else") {
  PlanTask task = officeTask();
  TaskPlanner here(task);
  const PlanAnswer plain = here.answer(task.queries.front());
  const Pose2 T_other_map{3.21, -7.77, 2.0};
  PlanTask moved = task;
  moved.map.T_map_grid = T_other_map * task.map.T_map_grid;
  PlanQuery& query = moved.queries.front();
  query = {T_other_map * query.T_map_start, T_other_map * query.T_map_goal};
  TaskPlanner there(moved);
  const PlanAnswer other = there.answer(query);
  REQUIRE(plain.end == planner::PathEnd::kSolved);
  REQUIRE(other.end == planner::PathEnd::kSolved);
  // Rounding may select another of two equally good plans.
  CHECK(other.cost == Approx(plain.cost).epsilon(0.02));
  CHECK((other.poses.back().position() - query.T_map_goal.position()).norm() <= 0.25 + 1e-6);
}

TEST_CASE("a goal in a closed room is unreachable, and it is told how near one could come") {
  PlanTask task = officeTask();
  const Pose2& T_map_goal = task.queries.front().T_map_goal;
  const Eigen::Vector2d p_goal = between(task.map.T_map_grid, T_map_goal).position();
  const CellIndex centre = task.grid.indexOf(p_goal);
  for (int i = -24; i <= 24; ++i)
    for (const int side : {-24, 24}) {
      task.grid.set({centre.x + i, centre.y + side}, kObstacle);
      task.grid.set({centre.x + side, centre.y + i}, kObstacle);
    }
  TaskPlanner planner(task);
  const PlanAnswer answer = planner.answer(task.queries.front());
  CHECK(answer.end == planner::PathEnd::kUnreachable);
  CHECK_FALSE(answer.reason.empty());
  CHECK(answer.patterns.empty());
  REQUIRE(answer.closest);
  CHECK(answer.closest->distance > 1.2);
  CHECK(answer.closest->distance < 2.5);
}

TEST_CASE("at the deadline the best so far is the answer") {
  PlanTask task = officeTask();
  task.deadline_ms = 1e-3;
  TaskPlanner planner(task);
  const PlanAnswer answer = planner.answer(task.queries.front());
  CHECK(answer.end == planner::PathEnd::kNoneInTime);
  CHECK_FALSE(answer.reason.empty());
  CHECK(answer.closest);
  CHECK(answer.expansions < 1000);
}

TEST_CASE("strange maps and queries are answered, never worse") {
  std::mt19937_64 random(11);
  const PlanTask office = officeTask();
  const std::array<double, 7> kNumbers{0.3, 3.0, 4.5, 8.0, -4.0, 1e6, 0.025};
  const auto number = [&] { return kNumbers[random() % kNumbers.size()]; };
  std::array<int, 3> ends{};
  for (int i = 0; i < 120; ++i) {
    PlanTask task = office;
    const int side = 1 + static_cast<int>(random() % 100);
    task.grid = Grid(0.05 * static_cast<double>(1 + random() % 8), {0, 0}, side,
                     1 + static_cast<int>(random() % 100));
    const uint64_t kind = random() % 4;  // all unknown, all free, all blocked, mixed
    for (Cell& cell : task.grid.cells())
      cell = kind == 0                                      ? kUnknown
             : kind == 1 || (kind == 3 && random() % 9 > 0) ? kFree
                                                            : kObstacle;
    task.map.T_map_grid = {};
    task.shape = {random() % 3 == 0 ? 30.0 : 0.2, 0.1, 0.0};
    if (random() % 4 == 0) task.shape = {};
    task.queries = {{{number(), number(), number()}, {number(), number(), number()}}};
    task.deadline_ms = 20.0;
    TaskPlanner planner(task);
    const PlanAnswer answer = planner.answer(task.queries.front());
    CAPTURE(i, answer.reason);
    ++ends[static_cast<size_t>(answer.end)];
    CHECK(answer.reason.empty() == (answer.end == planner::PathEnd::kSolved));
    CHECK(answer.closest.has_value() == (answer.end != planner::PathEnd::kSolved));
    CHECK(answer.poses.empty() == answer.patterns.empty());
    planner.scene(task.queries.front(), answer);
  }
  CHECK(ends[0] > 0);
  CHECK(ends[1] > 50);
}

TEST_CASE("a round robot never comes nearer to anything than its radius") {
  const Folder folder;
  PlanOptions options;
  options.map = kMaps + "forest.yaml";
  options.patterns = folder.write("eight.mprim", eightHeadings());
  options.radius = 0.3;
  options.start = "1.5,1.5,0.6";
  options.goal = "12,9,0.6";
  const PlanTask task = loadTask(options);
  TaskPlanner planner(task);
  const PlanAnswer answer = planner.answer(task.queries.front());
  REQUIRE(answer.end == planner::PathEnd::kSolved);
  const ClearanceField clearance(task.map.grid, true);
  for (const Pose2& T_map_body : answer.poses)
    CHECK(clearance.bounds(T_map_body.position()).upper >= 0.3);
  CHECK(answer.patterns.front().size() == 1);  // "0".."5"
}

TEST_CASE("a round robot's grid lets a point stand only where the disc can") {
  std::mt19937_64 random(3);
  Grid grid(0.1, {0, 0}, 60, 50);
  for (Cell& cell : grid.cells()) cell = random() % 60 == 0 ? kObstacle : kFree;
  grid.set({30, 30}, kUnknown);
  const double radius = 0.33;
  const Grid grown = grownBy(grid, radius);
  const ClearanceField clearance(grid, true);
  size_t free = 0;
  size_t lost = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Vector2d p(6.0 * static_cast<double>(random() % 10'000) * 1e-4,
                            5.0 * static_cast<double>(random() % 10'000) * 1e-4);
    const bool point_free = isFree(grown.at(grown.indexOf(p)));
    free += point_free ? 1 : 0;
    if (point_free) CHECK(clearance.bounds(p).upper >= radius);
    lost += !point_free && clearance.at(p) >= radius + 0.15 ? 1 : 0;
  }
  CHECK(free > 1000);
  CHECK(lost == 0);
}
