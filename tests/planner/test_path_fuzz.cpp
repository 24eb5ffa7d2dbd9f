// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "modules/planner/core/search/swept_footprint.hpp"
#include "tests/helpers.hpp"
#include "tests/planner/kit/path_bench.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

constexpr int kBatch = 16;  // expansions between two checks of the predicate

/// Unusual patterns: one sample or many, standing, sliding, spinning, tiny.
std::vector<Primitive> strangePatterns(std::mt19937_64& random, int count) {
  std::vector<Primitive> patterns;
  for (int i = 0; i < count; ++i) {
    Primitive pattern;
    pattern.id = i;
    const double scale = std::pow(10.0, drawn(random, -4.0, 0.5));
    const Twist2 twist{scale * drawn(random, -1.0, 1.0), scale * drawn(random, -0.3, 0.3),
                       drawn(random, 0, 2) * drawn(random, -2.0, 2.0)};
    const int samples = i % 3 == 0 ? 1 : drawn(random, 1, 30);
    for (int k = 1; k <= samples; ++k)
      pattern.poses.push_back(i % 17 == 5 ? Pose2{} : integrate(twist, double(k) / samples));
    pattern.duration = pattern.cost = drawn(random, 0.05, 3.0);
    patterns.push_back(pattern);
  }
  return patterns;
}

/// Unusual maps.
Grid strangeGrid(std::mt19937_64& random) {
  constexpr std::array<int, 8> kSides{0, 1, 2, 7, 60, 90, 90, 120};
  const double cell = std::array<double, 3>{0.05, 0.1, 0.5}[random() % 3];
  const int width = kSides[random() % 8];
  const int height = kSides[random() % 8];
  Grid grid(cell, {drawn(random, -10, 5) - width / 2, drawn(random, -10, 5) - height / 2}, width,
            height);
  const uint64_t kind = random() % 8;
  for (Cell& c : grid.cells())
    c = kind == 0   ? kUnknown
        : kind == 1 ? kObstacle
        : kind == 2 ? static_cast<Cell>(random())
        : kind == 3 ? (random() % 40 == 0 ? kObstacle : kFree)
                    : kFree;
  return grid;
}

double strangeNumber(std::mt19937_64& random) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr std::array<double, 8> kNumbers{kNan, kInfinity, -kInfinity, 1e300, -1e9, 1e-300, 0, 7};
  return random() % 40 == 0 ? kNumbers[random() % kNumbers.size()] : drawn(random, -2.5, 2.5);
}

Pose2 strangePose(std::mt19937_64& random) {
  const double x = strangeNumber(random);
  const double y = strangeNumber(random);
  return {x, y, strangeNumber(random)};
}

bool isFinite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
}

}  // namespace

TEST_CASE("whatever map, set, footprint and query, an answer is whole and comes when it is asked") {
  std::mt19937_64 random(1);
  std::array<int, 3> ends{};
  for (int i = 0; i < testing::effort(300); ++i) {
    const FootprintSize size = i % 5 == 0   ? FootprintSize{30.0, 30.0, 20.0}
                               : i % 5 == 1 ? FootprintSize{0.05, 0.05, 0.05}
                                            : FootprintSize{0.3, 0.2, 0.2};
    const int count = i % 10 == 3 ? 200 : drawn(random, 1, 12);
    const PatternTable table(strangePatterns(random, count), resolutionFor(size, 0.0, {}));
    PathConfig config = usualPaths();
    config.footprint = size;
    config.unknown_blocks = i % 2 == 0;
    PathPlanner planner(strangeGrid(random), table, config);
    for (int k = 0; k < 4; ++k) {
      PathQuery query{strangePose(random), strangePose(random), 0.3, k % 2 == 0 ? 4.0 : 0.3};
      query.come_close = random() % 2 == 0;
      if (random() % 10 == 0) query.position_tolerance = strangeNumber(random);
      if (random() % 10 == 0) query.yaw_tolerance = strangeNumber(random);
      const int limit = drawn(random, 1, 1500);
      const PathAnswer answer = planner.answer(query, after(limit));
      CAPTURE(i, k, answer.reason);
      ++ends[static_cast<size_t>(answer.end)];
      REQUIRE(answer.search.expansions < limit + kBatch);
      if (answer.end != PathEnd::kSolved) REQUIRE_FALSE(answer.reason.empty());
      for (const PlanStep& step : answer.search.steps) REQUIRE(isFinite(step.T_map_end));
      REQUIRE(std::isfinite(answer.search.cost));
      if (answer.closest) REQUIRE(answer.closest->allFinite());
    }
  }
  for (const int times : ends) CHECK(times > testing::effort(20));
}

TEST_CASE("a query that is no query is refused in words") {
  PathBench bench(3);
  const PathQuery good = bench.query();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto reasonWith = [&](auto change) {
    PathQuery query = good;
    change(query);
    const PathAnswer answer = bench.answer(query, 100);
    CHECK(answer.end == PathEnd::kUnreachable);
    return answer.reason;
  };
  CHECK(reasonWith([&](PathQuery& q) { q.T_map_start.yaw = nan; }) ==
        "the start's heading is no number");
  CHECK(reasonWith([&](PathQuery& q) {
          q.T_map_goal.yaw = -std::numeric_limits<double>::infinity();
        }) == "the goal's heading is no number");
  for (const double bad : {nan, 0.0, -1.0}) {
    const char* const why = "the goal's tolerances are not above 0";
    CHECK(reasonWith([&](PathQuery& q) { q.position_tolerance = bad; }) == why);
    CHECK(reasonWith([&](PathQuery& q) { q.yaw_tolerance = bad; }) == why);
  }
}

TEST_CASE("a search that looks again with smaller cells stops when it is told to as well") {
  int stopped = 0;
  for (uint64_t seed = 1; seed <= static_cast<uint64_t>(testing::effort(40)); ++seed) {
    PathBench bench(seed);
    bench.config.search.cell = 1.5;  // so coarse that it is soon completely seen
    bench.config.search.heading_bins = 4;
    PathPlanner planner(bench.grid, *bench.table, bench.config);
    const PathQuery query = bench.query();
    for (const int limit : {20, 60, 200}) {
      const PathAnswer answer = planner.answer(query, after(limit));
      REQUIRE(answer.search.expansions < limit + kBatch);
      if (answer.end == PathEnd::kNoneInTime && !answer.search.exhausted) ++stopped;
    }
  }
  CHECK(stopped > testing::effort(10) / 2);
}
