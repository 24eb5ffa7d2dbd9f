// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Unreachable goals, which the vehicle should approach as closely as possible.
#include <catch2/catch.hpp>

#include "modules/planner/core/search/path_planner.hpp"
#include "tests/planner/kit/policy_rig.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

PlannerConfig closeConfig() {
  PlannerConfig config = usualPlanner();
  config.map.come_close = true;
  return config;
}

/// A closed box of 3 m around the rig's goal at (12, 0).
Playground walledGoal(bool closed) {
  Playground ground;
  ground.addWall({10.5, -1.5}, {13.5, -1.5});
  ground.addWall({10.5, 1.5}, {13.5, 1.5});
  ground.addWall({13.5, -1.5}, {13.5, 1.5});
  if (closed) ground.addWall({10.5, -1.5}, {10.5, 1.5});
  return ground;
}

}  // namespace

TEST_CASE("The nearest place within reach has a way to it, and no nearer one has") {
  int found = 0;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> draw(-4.0, 4.0);
    Playground ground;
    // A wall around the goal, and some random boxes.
    for (const double s : {-1.0, 1.0}) {
      ground.addWall({4.0, s}, {6.0, s}, 0.2);
      ground.addWall({5.0 + s, -1.0}, {5.0 + s, 1.0}, 0.2);
    }
    for (int i = 0; i < 8; ++i) ground.add({{draw(random), draw(random), draw(random)}, 0.4, 0.2});
    ClearanceMap map(0.1, 32, ClearanceMapConfig{});
    for (Tile& tile : tilesOf(ground.paint(0.1, {-9.6, -9.6}, {9.6, 9.6}), 32, 1))
      map.put(std::move(tile));
    map.refresh();
    const Goal goal{1, {5.0, 0.0, 0.0}, 0.3, 4.0};
    DistanceFieldConfig config = usualField();
    const Eigen::Vector2d p_vehicle(-5.0, draw(random));
    const DistanceToGoal way(map, goal, p_vehicle, {}, config);
    REQUIRE(way.unreachable());
    const auto nearest = way.nearestWithinReach(p_vehicle, {5.0, 0.0});
    if (!nearest) continue;  // the vehicle is on a box
    ++found;
    CAPTURE(seed, nearest->transpose());
    const double off = (*nearest - Eigen::Vector2d(5.0, 0.0)).norm();
    // Outside of the wall and its inflation, but not by much.
    CHECK(off > 1.0 + config.inflation);
    CHECK(off < 1.0 + config.inflation + 0.5);
    // It is reachable, and no nearer place is.
    const Goal there{2, {nearest->x(), nearest->y(), 0.0}, 0.05, 4.0};
    CHECK_FALSE(DistanceToGoal(map, there, p_vehicle, {}, config).unreachable());
    for (double angle = 0.0; angle < 6.2; angle += 0.1) {
      const double radius = off - 0.15;
      const Goal nearer{
          3, {5.0 + radius * std::cos(angle), radius * std::sin(angle), 0.0}, 0.05, 4.0};
      CHECK(DistanceToGoal(map, nearer, p_vehicle, {}, config).unreachable());
    }
  }
  CHECK(found >= 8);
}

TEST_CASE("Of two places that are as near the one that was chosen before is kept") {
  ClearanceMap map(0.1, 32, ClearanceMapConfig{});
  for (Tile& tile : tilesOf(walledGoal(true).paint(0.1, {-3.2, -9.6}, {16.0, 9.6}), 32, 1))
    map.put(std::move(tile));
  map.refresh();
  const DistanceToGoal way(map, {1, {12.0, 0.0, 0.0}, 0.3, 4.0}, {0.0, 0.0}, {}, usualField());
  REQUIRE(way.unreachable());
  const Eigen::Vector2d p_goal(12.0, 0.0);
  const auto nearest = way.nearestWithinReach({0.0, 0.0}, p_goal);
  REQUIRE(nearest);
  // The walls are symmetric.
  const Eigen::Vector2d mirrored(nearest->x(), -nearest->y());
  CHECK(*way.nearestWithinReach({0.0, 0.0}, p_goal, mirrored) == mirrored);
  CHECK(*way.nearestWithinReach({0.0, 0.0}, p_goal, Eigen::Vector2d(8.0, 0.0)) == *nearest);
  CHECK(*way.nearestWithinReach({0.0, 0.0}, p_goal, p_goal) == *nearest);
}

TEST_CASE(
    "Told to come close, the vehicle drives to an enclosed goal's wall, and in when it opens") {
  Rig rig(walledGoal(true), closeConfig());
  Decision decision = rig.run(3.0);
  CHECK(decision.report.status == PlanStatus::kDriving);
  CHECK_THAT(decision.report.reason.words, Catch::Contains("as close as possible"));
  decision = rig.run(25.0);
  CHECK(decision.report.status == PlanStatus::kUnreachable);
  CHECK(decision.report.reason.code == StopReason::kNoWayFound);  // obstacles may disappear
  CHECK_THAT(decision.report.reason.words, Catch::Contains("obstacles enclose"));
  CHECK(std::hypot(rig.pose().x - 12.0, rig.pose().y) < 3.2);
  CHECK(std::abs(rig.speed()) < 0.02);
  rig.run(60.0);
  CHECK(rig.supervisor().counters().count("no progress: a way given up") == 0);
  rig.paint(walledGoal(false));
  decision = rig.run(40.0);
  CHECK(decision.report.status == PlanStatus::kArrived);
  CHECK(std::hypot(rig.pose().x - 12.0, rig.pose().y) < 0.6);
}

TEST_CASE("Not told so, the vehicle stands and says that the goal cannot be reached") {
  Rig rig(walledGoal(true));
  const Decision decision = rig.run(3.0);
  CHECK(decision.report.status == PlanStatus::kUnreachable);
  CHECK(std::abs(rig.pose().x) < 0.01);
}

TEST_CASE("A path query that is to come close ends at the nearest place, and says why there") {
  const Grid grid = walledGoal(true).paint(0.1, {-3.0, -6.0}, {16.0, 6.0});
  const PatternTable table(samplePatterns(), usualSweep(), {});
  PathPlanner planner(grid, table, usualPaths());
  PathQuery query{{0.0, 0.0, 0.0}, {12.0, 0.0, 0.0}, 0.25, 4.0};
  const StopPredicate stop = [](int count) { return count > 20'000; };
  const PathAnswer refused = planner.answer(query, stop);
  CHECK(refused.end == PathEnd::kUnreachable);
  query.come_close = true;
  const PathAnswer answer = planner.answer(query, stop);
  REQUIRE(answer.end == PathEnd::kSolved);
  REQUIRE(refused.closest);
  CHECK((answer.search.steps.back().T_map_end.position() - *refused.closest).norm() <= 0.75);
  CHECK_THAT(answer.reason, Catch::Contains("as close as possible: " + refused.reason));
}
