// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Fences to stay inside, and fences to stay outside.
#include <random>

#include <catch2/catch.hpp>

#include "tests/planner/kit/policy_rig.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;
using Catch::Contains;

namespace {

constexpr double kStopping = 0.4;  // [m]

PlannerConfig fenced(std::vector<Fence> fences) {
  PlannerConfig config = usualPlanner();
  config.map.fences = std::move(fences);
  config.map.full_speed = 1.0;
  config.map.stopping_time = kStopping;
  return config;
}

/// Across the rig's straight path to (12, 0), with a way around.
Fence pond() {
  return {"pond", true, {{4, -2.5}, {6, -2.5}, {6, 3.5}, {4, 3.5}}};
}
Fence yard(double east) {
  return {"yard", false, {{-6, -6}, {east, -6}, {east, 6}, {-6, 6}}};
}

/// Runs until arrival; returns the least distance of the footprint to any of the fences.
double leastRoom(Rig& rig, const std::vector<Fence>& fences, double seconds,
                 const std::function<void(PlannerInputs&)>& tamper = nullptr) {
  double least = 1e9;
  for (double t = 0.0; t < seconds; t += 0.05) {
    const Decision decision = rig.run(0.05, tamper);
    least = std::min(least, roomAt(fences, rig.pose(), kVehicle).metres);
    if (decision.report.status == PlanStatus::kArrived) break;
  }
  return least;
}

void knowPosition(PlannerInputs& s, double std) {
  s.pose->position_std = std;
}

}  // namespace

TEST_CASE("It drives around a polygon to keep out of, with room to stop before it") {
  Rig rig(Playground{}, fenced({pond()}));
  const double least =
      leastRoom(rig, {pond()}, 60.0, [](PlannerInputs& s) { knowPosition(s, 0.02); });
  CHECK(least >= kStopping);
  CHECK(least < 1.5);
  CHECK(rig.run(0.05).report.status == PlanStatus::kArrived);
}

TEST_CASE("The worse its position is known, the more room it keeps", "[statistics]") {
  Rig rig(Playground{}, fenced({pond()}));
  const double least =
      leastRoom(rig, {pond()}, 60.0, [](PlannerInputs& s) { knowPosition(s, 0.2); });
  CHECK(least >= kStopping + 0.4);
  Rig unknown(Playground{}, fenced({pond()}));
  CHECK(leastRoom(unknown, {pond()}, 60.0) >= kStopping + 0.2);
}

TEST_CASE("On ground on which it takes longer to stop it keeps more room") {
  Rig rig(Playground{}, fenced({pond()}));
  rig.supervisor().setStoppingTime(0.9);
  CHECK(leastRoom(rig, {pond()}, 60.0, [](PlannerInputs& s) { knowPosition(s, 0.02); }) >= 0.9);
}

TEST_CASE("A goal that fences forbid is refused in words, and it does not move") {
  Rig outside(Playground{}, fenced({yard(9.0)}));
  const Decision refused = outside.run(5.0);
  CHECK(refused.report.status == PlanStatus::kUnreachable);
  CHECK(refused.report.reason.words == "the goal lies outside of what fence yard allows");
  CHECK(outside.pose().x == Approx(0.0).margin(0.01));
  Rig inside(Playground{}, fenced({{"pond", true, {{11, -1}, {13, -1}, {13, 1}, {11, 1}}}}));
  CHECK(inside.run(5.0).report.reason.words == "the goal lies outside of what fence pond allows");
  Rig near(Playground{}, fenced({yard(12.1)}));
  CHECK_THAT(near.run(5.0).report.reason.words,
             Contains("the goal is 0.1 m from fence yard") && Contains("to stop before it"));
}

TEST_CASE("A fence around the goal that leaves no gate makes it unreachable") {
  Rig rig(Playground{}, fenced({yard(20.0), {"wall", true, {{5, -6}, {6, -6}, {6, 6}, {5, 6}}}}));
  const Decision decision = rig.run(10.0);
  CHECK(decision.report.status == PlanStatus::kUnreachable);
  CHECK(rig.pose().x < 4.5);
}

TEST_CASE(
    "A fence that comes up ahead while it drives is not reached, and one that goes opens the way") {
  Rig rig;
  rig.run(2.5);
  REQUIRE(rig.speed() > 0.3);
  const Fence ahead = yard(rig.pose().x + 3.0);
  rig.supervisor().map().setFences({ahead});
  CHECK(leastRoom(rig, {ahead}, 20.0) >= 0.0);
  CHECK(rig.speed() == Approx(0.0).margin(0.01));
  rig.supervisor().map().setFences({});
  rig.run(40.0);
  CHECK(rig.run(0.05).report.status == PlanStatus::kArrived);
}

TEST_CASE("Over a fence it drives back in, and never farther out on its way") {
  // It starts at the origin; the goal is in a yard that begins to its east.
  for (const double west : {-0.2, 0.5, 2.0, 4.0}) {
    const Fence gate{"gate", false, {{west, -8}, {25, -8}, {25, 8}, {west, 8}}};
    Rig rig(Playground{}, fenced({gate}));
    double best = roomAt(gate, rig.pose(), kVehicle);
    for (double t = 0.0; t < 60.0; t += 0.05) {
      rig.run(0.05, [](PlannerInputs& s) { knowPosition(s, 0.0); });
      const double room = roomAt(gate, rig.pose(), kVehicle);
      if (best < 0.0) CHECK(room >= best - 0.03);
      best = std::max(best, room);
      if (best >= kStopping + 0.2) break;
    }
    CAPTURE(west);
    CHECK(best >= kStopping);
  }
}

TEST_CASE("On its way out of a fence no obstacle takes the place of forbidden ground") {
  // It stands in front of a pond that reaches under its nose, with a wall close behind.
  Playground ground;
  Grid grid = ground.paint(0.1, {-6.4, -6.4}, {6.4, 6.4});
  const FencedGround pond({{"pond", true, {{0.3, -2}, {3, -2}, {3, 2}, {0.3, 2}}}}, 0.0);
  const auto checker = [&] { return CollisionChecker(grid, kVehicle, {}, true, pond); };
  const PatternTable table(samplePatterns(), usualSweep(), {});
  const auto leaving = [&](const CollisionChecker& around) {
    int count = 0;
    for (const TablePattern& pattern : table.patterns())
      count +=
          pattern.end().pose.x < -0.1 && around.escape({}, around.overlap({}), pattern) ? 1 : 0;
    return count;
  };
  REQUIRE(checker().overlap({}).all > 0);
  CHECK(leaving(checker()) > 0);
  for (const Cell behind : {kObstacle, kUnknown}) {
    for (int y = -8; y <= 8; ++y)
      grid.set({static_cast<int>(-10.0 * kVehicle.rear) - 2, y}, behind);
    REQUIRE(checker().overlap({}).blocked == 0);
    CHECK(leaving(checker()) == 0);
  }
}

TEST_CASE("Cells near forbidden ground are obstacles, all of them and no others") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-6.0, 6.0);
  for (int round = 0; round < 20; ++round) {
    std::vector<Fence> fences;
    for (const bool keep_out : {false, true}) {
      const double size = keep_out ? 1.5 : 7.0;
      const Eigen::Vector2d c(draw(random) / 3, draw(random) / 3);
      fences.push_back({keep_out ? "out" : "in",
                        keep_out,
                        {c + Eigen::Vector2d(-size, -size), c + Eigen::Vector2d(size, -size),
                         c + Eigen::Vector2d(0.3 * size, 0), c + Eigen::Vector2d(size, size),
                         c + Eigen::Vector2d(-size, size)}});
    }
    const FencedGround ground(fences, 0.5);
    Grid grid(0.1, {-93, -81}, 180, 170);
    std::fill(grid.cells().begin(), grid.cells().end(), kFree);
    ground.stamp(grid);
    ClearanceWindow window{-47, -40, 90, 80, {}, {}, {}};
    window.clearance.assign(90 * 80, 1e6F);
    ground.stamp(window, 0.2);
    for (int y = -81; y < 89; ++y)
      for (int x = -93; x < 87; ++x) {
        const double room = ground.room(grid.centre({x, y})).metres;
        if (room < 0.5) REQUIRE(grid.at({x, y}) == kObstacle);
        if (room > 0.5 + 0.0708) REQUIRE(grid.at({x, y}) == kFree);
      }
    for (int y = -40; y < 40; ++y)
      for (int x = -47; x < 43; ++x) {
        const double room = ground.room({(x + 0.5) * 0.2, (y + 0.5) * 0.2}).metres - 0.5;
        const float cell = window.clearance[window.at(x, y)];
        if (room < 1.4) REQUIRE(cell == Approx(std::max(0.0, room)).margin(1e-4));
      }
  }
}
