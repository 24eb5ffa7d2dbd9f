// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "modules/planner/core/search/swept_footprint.hpp"
#include "tests/helpers.hpp"
#include "tests/planner/kit/path_bench.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

constexpr int kExpansions = 3000;

/// Calls visit(bench, query, answer) for many grounds and queries.
template <class Visit>
void onQueries(uint64_t seed, int grounds, SweepResolution step, const Visit& visit) {
  for (int i = 0; i < grounds; ++i) {
    PathBench bench(seed + static_cast<uint64_t>(i), i % 3 != 0, step);
    for (int k = 0; k < 4; ++k) {
      const PathQuery query = bench.query();
      const PathAnswer answer = bench.answer(query, kExpansions);
      INFO("seed " << seed + static_cast<uint64_t>(i) << " query " << k << ": " << answer.reason);
      visit(bench, query, answer);
    }
  }
}

std::vector<SweptPose> finePoses(const PathBench& bench, const TablePattern& pattern) {
  return sampleSweep(pattern.pattern->trajectory, bench.table->set().periodSeconds(),
                     SweepResolution{0.01, 0.01, 0.3, kVehicle.widened(0.09)});
}

/// Whether the footprint, reduced by so much [m] on all sides, still touches something; on all
/// paths or on straight ones only.
bool cutsBy(double smaller, const PathBench& bench, const PathQuery& query,
            const PathAnswer& answer, bool straight_only) {
  const FootprintSize size = kVehicle;
  const Footprint footprint(size, -smaller);
  Pose2 from = query.T_map_start;
  for (const PlanStep& step : answer.search.steps) {
    const TablePattern& pattern = *bench.table->find(step.pattern_id);
    const bool straight = std::abs(pattern.end().pose.yaw) < 1e-9;
    for (const SweptPose& at : finePoses(bench, pattern))
      if ((straight || !straight_only) &&
          footprint.blockedCells(bench.grid, from * at.pose, bench.config.unknown_blocks) > 0)
        return true;
    from = step.T_map_end;
  }
  return false;
}

}  // namespace

TEST_CASE("no solved plan meets anything in its straight parts, and in turns by less than 5 mm") {
  int plans = 0;
  onQueries(1, testing::effort(50), usualSweep(),
            [&](const PathBench& bench, const PathQuery& query, const PathAnswer& answer) {
              if (answer.end != PathEnd::kSolved) return;
              ++plans;
              CHECK_FALSE(cutsBy(5e-3, bench, query, answer, false));
              CHECK_FALSE(cutsBy(1e-6, bench, query, answer, true));
            });
  CHECK(plans > testing::effort(120));
}

TEST_CASE("the poses of a solved plan join, and it ends at rest in the goal") {
  int plans = 0;
  onQueries(2000, testing::effort(50), usualSweep(),
            [&](const PathBench& bench, const PathQuery& query, const PathAnswer& answer) {
              CHECK(answer.reason.empty() == (answer.end == PathEnd::kSolved));
              if (answer.end != PathEnd::kSolved) return;
              ++plans;
              const PatternTable& table = *bench.table;
              Pose2 pose = query.T_map_start;
              double time = 0.0;
              int motion_class = table.restClass();
              for (const PlanStep& step : answer.search.steps) {
                const TablePattern& pattern = *table.find(step.pattern_id);
                REQUIRE(pattern.entry == motion_class);
                pose = pose * pattern.end().pose;
                time += pattern.duration;
                motion_class = step.exit_class;
                REQUIRE(motion_class == pattern.exit);
                REQUIRE((pose.position() - step.T_map_end.position()).norm() < 1e-9);
                REQUIRE(std::abs(wrapAngle(pose.yaw - step.T_map_end.yaw)) < 1e-9);
                REQUIRE(step.time == Approx(time));
              }
              CHECK(motion_class == table.restClass());
              CHECK(answer.search.cost == Approx(time).epsilon(1e-4).margin(1e-4));
              const double way = (pose.position() - query.T_map_start.position()).norm();
              CHECK(time >= way / table.bestSpeed() - 1e-6);
              const Pose2& goal = query.T_map_goal;
              CHECK((pose.position() - goal.position()).norm() <= query.position_tolerance + 1e-4);
              const double off = std::abs(wrapAngle(pose.yaw - goal.yaw));
              CHECK(off <= query.yaw_tolerance + 1e-4);
            });
  CHECK(plans > testing::effort(120));
}

TEST_CASE("a start that is in the goal needs no pattern") {
  PathBench bench(5);
  PathQuery query = bench.query();
  query.T_map_goal = query.T_map_start;
  const PathAnswer answer = bench.answer(query, 100);
  CHECK(answer.end == PathEnd::kSolved);
  CHECK(answer.search.steps.empty());
  CHECK(answer.search.cost == 0.0);
}

TEST_CASE("the same query gives the same bytes, also from a planner that answered others before") {
  for (uint64_t seed = 1; seed <= static_cast<uint64_t>(testing::effort(20)); ++seed) {
    PathBench bench(seed);
    const PathQuery first = bench.query();
    const PathQuery second = bench.query();
    const auto bytes = bytesOf(bench.answer(first, 500));
    bench.answer(second, 500);
    REQUIRE(bytesOf(bench.answer(first, 500)) == bytes);
    PathPlanner fresh(bench.grid, *bench.table, bench.config);
    REQUIRE(bytesOf(fresh.answer(first, after(500))) == bytes);
  }
}
