// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/grid/footprint.hpp"
#include "tests/tools/lab/plan/plan_samples.hpp"
#include "tools/lab/plan/plan_files.hpp"
#include "tools/lab/plan/query_file.hpp"

using namespace tread;
using namespace tread::plan;
using namespace tread::plan::samples;
using Catch::Contains;

namespace {

/// 8 x 6 m with a wall across and a gap of 1 m.
Grid walledRoom() {
  Grid grid(0.1, {0, 0}, 80, 60);
  for (Cell& cell : grid.cells()) cell = kFree;
  for (int y = 0; y < 50; ++y) grid.set({40, y}, kObstacle);
  return grid;
}

}  // namespace

TEST_CASE("queries are read with comments and blank lines and written bit for bit") {
  const auto queries =
      parseQueries("# two\n1 2 0.5 -3 4.25 -1\n\n 0.1 0 0 1e-3 0 3.141592653589793 # last\n", "q");
  REQUIRE(queries.size() == 2);
  CHECK(queries[0].T_map_start.yaw == 0.5);
  CHECK(queries[0].T_map_goal.x == -3.0);
  CHECK(queries[1].T_map_goal.yaw == kPi);
  const auto again = parseQueries(formatQueries(queries), "q");
  REQUIRE(again.size() == 2);
  CHECK(again[1].T_map_start.x == 0.1);
  CHECK(again[1].T_map_goal.yaw == kPi);
}

TEST_CASE("a broken query is one clear line with its number") {
  const auto parse = [](const std::string& text) { parseQueries(text, "q.txt"); };
  CHECK_THROWS_WITH(parse("1 2 3 4 5 6\n1 2 3 4 5\n1 2 3 4 5 6\n"),
                    "q.txt:3: line 2 has 5 numbers; a query is six: x y yaw x y yaw");
  CHECK_THROWS_WITH(parse("1 2 3 4 5 6 7 8 9 10 11 12\n"),
                    Contains("q.txt:1: more than six numbers"));
  CHECK_THROWS_WITH(parse("1 2 3 4 5\n"), "q.txt:1: the file ends where the goal's yaw should be");
  CHECK_THROWS_WITH(parse("\n1,2 3 4 5 6 7\n"), Contains("q.txt:2: the start's x is \"1,2\""));
  CHECK_THROWS_WITH(parse("1 2 3 nan 5 6\n"), Contains("the goal's x is \"nan\""));
  CHECK_THROWS_WITH(parse("# none\n"), Contains("no query; one is x y yaw x y yaw"));
}

TEST_CASE("random queries are free, apart and the same for the same seed") {
  const Grid grid = walledRoom();
  const ClearanceField clearance(grid, true);
  const Footprint footprint({0.4, 0.4, 0.3}, 0.0);
  const auto is_free = [&](const Pose2& T_grid_body) {
    return footprint.isFree(clearance, turned(T_grid_body));
  };
  const Pose2 T_map_grid{-2.0, 7.0, 0.3};
  RandomQueries wanted;
  wanted.count = 200;
  wanted.apart = 4.0;
  const auto queries = randomQueries(grid, T_map_grid, wanted, is_free);
  REQUIRE(queries.size() == 200);
  size_t across = 0;
  for (const PlanQuery& query : queries) {
    const Pose2 start = between(T_map_grid, query.T_map_start);
    const Pose2 goal = between(T_map_grid, query.T_map_goal);
    CHECK(is_free(start));
    CHECK(is_free(goal));
    CHECK((start.position() - goal.position()).norm() > 4.0);
    across += (start.x < 4.0) != (goal.x < 4.0) ? 1 : 0;
  }
  CHECK(across > 100);
  CHECK(formatQueries(randomQueries(grid, T_map_grid, wanted, is_free)) == formatQueries(queries));
  wanted.seed = 2;
  CHECK(formatQueries(randomQueries(grid, T_map_grid, wanted, is_free)) != formatQueries(queries));
}

TEST_CASE("random queries that a map has no room for are one clear line") {
  RandomQueries wanted;
  wanted.count = 5;
  CHECK_THROWS_WITH(randomQueries(walledRoom(), {}, wanted, [](const Pose2&) { return false; }),
                    Contains("only 0 of 5 random queries found"));
  wanted.apart = 50.0;
  CHECK_THROWS_WITH(randomQueries(walledRoom(), {}, wanted, [](const Pose2&) { return true; }),
                    Contains("only 0 of 5 random queries found"));
}
