// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

#include "modules/planner/core/map/heading_aware_heuristic.hpp"
#include "tests/helpers.hpp"
#include "tests/planner/kit/guide_reference.hpp"
#include "tests/planner/kit/playground.hpp"
#include "tests/planner/kit/random_ground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

const FootprintSize kHeuristicSize = kVehicle;
constexpr double kHeadingBin = 2.0 * kPi / HeadingAwareHeuristic::kHeadings;
constexpr double kEverything = 1e6;

Primitive move(const Pose2& end, double cost) {
  Primitive primitive;
  primitive.poses = {end};
  primitive.duration = primitive.cost = cost;
  return primitive;
}

/// Ahead 2 s/m, left and right arcs, on the spot 3 s/rad; back 5 s/m if requested.
std::vector<Primitive> plainMoves(bool reverse) {
  std::vector<Primitive> moves{move({0.5, 0.0, 0.0}, 1.0), move({0.0, 0.0, 0.4}, 1.2),
                               move({0.0, 0.0, -0.4}, 1.2)};
  if (reverse) moves.push_back(move({-0.5, 0.0, 0.0}, 2.5));
  return moves;
}

/// A ground and the heuristic on it.
struct HeuristicBench {
  HeuristicBench(const Grid& grid, bool unknown_blocks, const PatternTable& patterns)
      : around(grid, kHeuristicSize, Margins{}, unknown_blocks),
        configurations(around, kHeuristicSize.half_width),
        rates(motionRates(patterns)) {}
  HeadingAwareHeuristic guide(const Pose2& start, const Goal& goal, double beyond = kEverything) {
    return HeadingAwareHeuristic(configurations, goal, start, rates, beyond);
  }
  /// Cost at the centre of a square and of a bin.
  double at(const HeadingAwareHeuristic& guide, int column, int row, int heading) const {
    const Eigen::Vector2d p = configurations.centre(column, row);
    return static_cast<double>(
        guide.at(p.x(), p.y(), static_cast<float>(wrapAngle(heading * kHeadingBin))));
  }

  CollisionChecker around;
  FreeConfigurations configurations;
  MotionRates rates;
};

Grid openGround(double half) {
  const auto cells = static_cast<int>(std::lround(half / 0.1));
  Grid grid(0.1, {-cells, -cells}, 2 * cells, 2 * cells);
  for (Cell& cell : grid.cells()) cell = kFree;
  return grid;
}

struct Compared {
  int finite = 0;
  int endless = 0;
};

template <class Visit>
void visitStates(const HeuristicBench& bench, const Visit& visit) {
  for (int row = 0; row < bench.configurations.height(); ++row)
    for (int column = 0; column < bench.configurations.width(); ++column)
      for (int heading = 0; heading < HeadingAwareHeuristic::kHeadings; ++heading)
        visit(column, row, heading);
}

double leastPerMetre(const MotionRates& rates) {
  double least = std::numeric_limits<double>::infinity();
  for (const MotionRates::Rate& rate : rates.along)
    if (rate.any) least = std::min(least, rate.by_way.per_metre);
  return least;
}

Compared motionRatio(const HeuristicBench& bench, const HeadingAwareHeuristic& guide,
                     const GuideReference& truth) {
  Compared result;
  visitStates(bench, [&](int column, int row, int heading) {
    const double expected = truth.at(column, row, heading);
    const double value = bench.at(guide, column, row, heading);
    if (!std::isfinite(expected)) {
      REQUIRE(std::isinf(value));
      ++result.endless;
      return;
    }
    ++result.finite;
    REQUIRE(value == Approx(expected).epsilon(1e-4));
  });
  return result;
}

template <class Visit>
void onRandomGrounds(uint64_t seed, int count, const Visit& visit) {
  std::mt19937_64 random(seed);
  const PatternTable sample(samplePatterns(), usualSweep(), {});
  const PatternTable forward(plainMoves(false), usualSweep());
  for (int i = 0; i < count; ++i) {
    RandomGround ground;
    ground.lower = {drawn(random, -70, 0), drawn(random, -70, 0)};
    ground.blocks = drawn(random, 0, 14);
    ground.walls = drawn(random, 0, 2);
    ground.gap = 14;
    HeuristicBench bench(ground.draw(random), i % 2 == 0, i % 3 == 0 ? forward : sample);
    const Goal goal{1, ground.pose(random), drawn(random, 0.1, 0.6), i % 4 == 0 ? 4.0 : 0.3};
    visit(bench, ground.pose(random), goal);
  }
}

}  // namespace

TEST_CASE("wholly filled in, the guide is what brute force over the same moves finds") {
  int finite = 0;
  int endless = 0;
  onRandomGrounds(1, testing::effort(40),
                  [&](HeuristicBench& bench, const Pose2& start, const Goal& goal) {
                    const HeadingAwareHeuristic guide = bench.guide(start, goal);
                    const GuideReference truth(bench.configurations, goal, start, bench.rates);
                    const Compared compared = motionRatio(bench, guide, truth);
                    finite += compared.finite;
                    endless += compared.endless;
                  });
  CHECK(finite > testing::effort(100'000));
  CHECK(endless > testing::effort(10'000));
}

TEST_CASE("filled in as far as the start, the guide is right wherever it may be worth to go") {
  constexpr double kBeyond = 0.15;
  int right = 0;
  onRandomGrounds(
      2, testing::effort(60), [&](HeuristicBench& bench, const Pose2& start, const Goal& goal) {
        const HeadingAwareHeuristic guide = bench.guide(start, goal, kBeyond);
        const GuideReference truth(bench.configurations, goal, start, bench.rates);
        const int own_column = bench.configurations.column(start.x);
        const int own_row = bench.configurations.row(start.y);
        const int own = static_cast<int>(std::lround(start.yaw / kHeadingBin)) +
                        HeadingAwareHeuristic::kHeadings;
        const double whole = truth.at(own_column, own_row, own % HeadingAwareHeuristic::kHeadings);
        REQUIRE(guide.reached() == std::isfinite(whole));
        if (!guide.reached()) return;
        ++right;
        CHECK(static_cast<double>(guide.at(start.x, start.y, static_cast<float>(start.yaw))) ==
              Approx(whole).epsilon(1e-4));
        visitStates(bench, [&](int column, int row, int heading) {
          const double from_start = leastPerMetre(bench.rates) * bench.configurations.size() *
                                    std::hypot(column - own_column, row - own_row);
          const double expected = truth.at(column, row, heading);
          const double value = bench.at(guide, column, row, heading);
          if (from_start + expected < (1.0 + kBeyond) * whole)
            REQUIRE(value == Approx(expected).epsilon(1e-4).margin(1e-4));
          else  // cells left out do not look better
            REQUIRE(from_start + value >= (1.0 + kBeyond) * whole * (1.0 - 1e-4));
        });
      });
  CHECK(right > testing::effort(20));
}

TEST_CASE("filled in as far as the start, the guide is nowhere more than what brute force finds") {
  int less = 0;
  onRandomGrounds(3, testing::effort(60),
                  [&](HeuristicBench& bench, const Pose2& start, const Goal& goal) {
                    const HeadingAwareHeuristic guide = bench.guide(start, goal, 0.05);
                    const GuideReference truth(bench.configurations, goal, start, bench.rates);
                    visitStates(bench, [&](int column, int row, int heading) {
                      const double expected = truth.at(column, row, heading);
                      const double value = bench.at(guide, column, row, heading);
                      REQUIRE(value <= expected * (1.0 + 1e-4) + 1e-4);
                      less += value < 0.99 * expected ? 1 : 0;
                    });
                  });
  CHECK(less > testing::effort(10'000));  // enough cells were left out
}

TEST_CASE("on empty ground a way ahead and a turn cost what the patterns charge for them") {
  const PatternTable table(plainMoves(true), usualSweep());
  HeuristicBench bench(openGround(6.0), false, table);
  const Eigen::Vector2d middle = bench.configurations.centre(20, 20);
  const Goal goal{1, {middle.x(), middle.y(), 0.0}, 0.01, 0.01};
  const HeadingAwareHeuristic guide = bench.guide({}, goal);
  const double size = bench.configurations.size();
  for (int squares = 1; squares <= 15; ++squares) {
    CHECK(bench.at(guide, 20 - squares, 20, 0) == Approx(2.0 * squares * size).epsilon(1e-4));
    CHECK(bench.at(guide, 20 + squares, 20, 0) == Approx(5.0 * squares * size).epsilon(1e-4));
  }
  for (int turn = 1; turn <= 8; ++turn) {
    CHECK(bench.at(guide, 20, 20, turn) == Approx(3.0 * turn * kHeadingBin).epsilon(1e-4));
    CHECK(bench.at(guide, 20, 20, 16 - turn) == Approx(3.0 * turn * kHeadingBin).epsilon(1e-4));
  }
  // A quarter turn, and the path across to the goal, as it cannot drive sideways.
  CHECK(bench.at(guide, 20, 10, 0) == Approx(20.0 * size + 3.0 * kPi).epsilon(0.1));
}

TEST_CASE("with the patterns of the tests a way ahead costs its time at the best speed") {
  const PatternTable table(samplePatterns(), usualSweep(), {});
  HeuristicBench bench(openGround(6.0), false, table);
  const Eigen::Vector2d middle = bench.configurations.centre(20, 20);
  const HeadingAwareHeuristic guide =
      bench.guide({}, {1, {middle.x(), middle.y(), 0.0}, 0.01, 0.01});
  const double way = 15 * bench.configurations.size();
  CHECK(bench.at(guide, 5, 20, 0) == Approx(way / table.bestSpeed()).epsilon(1e-3));
  CHECK(bench.at(guide, 35, 20, 0) > 1.5 * way / table.bestSpeed());  // reversing is slower
}

TEST_CASE("a set that cannot reverse is never guided backwards") {
  const PatternTable table(plainMoves(false), usualSweep());
  HeuristicBench bench(openGround(6.0), false, table);
  const Eigen::Vector2d middle = bench.configurations.centre(20, 20);
  const HeadingAwareHeuristic guide =
      bench.guide({}, {1, {middle.x(), middle.y(), 0.0}, 0.01, 0.01});
  for (int squares = 1; squares <= 12; ++squares)  // there and back, with two half turns
    CHECK(bench.at(guide, 20 + squares, 20, 0) >=
          2.0 * squares * bench.configurations.size() + 3.0 * kPi * 2.0 - 1e-3);
  // From any position, a single step against its heading does not approach the goal.
  for (int squares = -10; squares < 12; ++squares)
    if (squares < 0 || squares > 2)
      CHECK(bench.at(guide, 20 + squares, 20, 8) > bench.at(guide, 20, 20, 8) - 1e-3);
}

TEST_CASE("a wall is gone around, and what is shut in has no way") {
  const PatternTable table(plainMoves(true), usualSweep());
  Grid grid = openGround(6.0);
  for (int y = -40; y < 40; ++y) grid.set({0, y}, kObstacle);
  HeuristicBench bench(grid, false, table);
  const Goal goal{1, {2.0, 0.0, 0.0}, 0.2, 4.0};
  const HeadingAwareHeuristic guide = bench.guide({-2.0, 0.0, 0.0}, goal);
  REQUIRE(guide.reached());
  const double around = 2.0 * std::hypot(2.0, 4.0);
  CHECK(static_cast<double>(guide.at(-2.0, 0.0, 0.0F)) > 2.0 * (around - 0.6));
  for (int y = -60; y < 60; ++y) grid.set({0, y}, kObstacle);
  HeuristicBench shut(grid, true, table);
  const HeadingAwareHeuristic none = shut.guide({-2.0, 0.0, 0.0}, goal);
  CHECK_FALSE(none.reached());
  CHECK(std::isinf(none.at(-2.0, 0.0, 0.0F)));
  CHECK(std::isfinite(none.at(1.0, 0.0, 0.0F)));
}

TEST_CASE("a start on blocked ground is reached, a goal outside the map is not") {
  const PatternTable table(plainMoves(true), usualSweep());
  Grid grid = openGround(3.9);
  for (int y = -5; y < 5; ++y) grid.set({4, y}, kObstacle);
  HeuristicBench bench(grid, false, table);
  const Pose2 before_wall{0.05, 0.05, 0.0};
  REQUIRE_FALSE(bench.configurations.isFree(
      bench.configurations.number(bench.configurations.column(before_wall.x),
                                  bench.configurations.row(before_wall.y)),
      0));
  CHECK(bench.guide(before_wall, {1, {-2.5, 0.0, 0.0}, 0.2, 4.0}).reached());
  for (const double far : {7.0, -30.0, 1e6}) {
    const HeadingAwareHeuristic none =
        bench.guide({-2.5, 0.0, 0.0}, {1, {far, 0.0, 0.0}, 0.3, 4.0});
    CHECK_FALSE(none.reached());
    CHECK(std::isinf(none.at(-2.5, 0.0, 0.0F)));
  }
}

TEST_CASE("outside the map, and on a map smaller than a square, the guide still answers") {
  const PatternTable table(plainMoves(true), usualSweep());
  HeuristicBench bench(openGround(4.0), true, table);
  const Goal goal{1, {2.0, 0.0, 0.0}, 0.2, 4.0};
  const HeadingAwareHeuristic guide = bench.guide({-2.0, 0.0, 0.0}, goal, 0.15);
  REQUIRE(guide.reached());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double far : {4.2, -4.01, 1e12, nan}) {
    // Not below the computed values: nothing leads out of the map.
    CHECK(guide.at(far, 0.0, 0.0F) >= guide.at(-2.0, 0.0, 0.0F));
    CHECK(guide.at(0.0, far, 0.0F) >= guide.at(-2.0, 0.0, 0.0F));
  }
  Grid one(0.1, {0, 0}, 1, 1);
  one.set({0, 0}, kFree);
  HeuristicBench tiny(one, false, table);
  const HeadingAwareHeuristic here =
      tiny.guide({0.05, 0.05, 1.0}, {1, {0.05, 0.05, 0.0}, 0.1, 0.1});
  CHECK(here.reached());
  CHECK(static_cast<double>(here.at(0.05, 0.05, static_cast<float>(2.0 * kHeadingBin))) ==
        Approx(3.0 * 2.0 * kHeadingBin).epsilon(1e-4));
  HeuristicBench none(Grid{}, true, table);
  CHECK(none.guide({}, goal).reached() == false);
}

TEST_CASE("a set that goes nowhere makes no guide") {
  const PatternTable table({move({0.0, 0.0, 0.0}, 1.0)}, usualSweep());
  HeuristicBench bench(openGround(3.0), true, table);
  CHECK(bench.guide({}, {1, {1.0, 0.0, 0.0}, 0.2, 4.0}).empty());
}
