// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "modules/planner/core/search/path_planner.hpp"
#include "tests/planner/kit/random_ground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"
#include "tests/planner/kit/search_bench.hpp"
#include "tests/planner/kit/vehicle.hpp"

namespace tread::planner::testkit {

/// A random ground with queries, the tests' patterns and a planner.
struct PathBench {
  explicit PathBench(uint64_t seed, bool unknown_blocks = true, SweepResolution step = usualSweep())
      : random(seed), ground(shape(random)), grid(ground.draw(random)) {
    table.emplace(samplePatterns(), step, DefaultSigma{});
    config.unknown_blocks = unknown_blocks;
    planner.emplace(grid, *table, config);
  }
  static RandomGround shape(std::mt19937_64& random) {
    RandomGround ground;
    ground.lower = {drawn(random, -150, 50), drawn(random, -150, 50)};
    ground.width = drawn(random, 60, 120);
    ground.height = drawn(random, 60, 120);
    ground.blocks = drawn(random, 0, 20);
    ground.walls = drawn(random, 0, 2);
    ground.gap = drawn(random, 6, 16);
    return ground;
  }
  /// From the middle of a free cell to any pose.
  PathQuery query() {
    PathQuery query;
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d p = grid.centre(ground.somewhere(random));
      query.T_map_start = {p.x(), p.y(), drawn(random, -kPi, kPi)};
      if (planner->isFree(query.T_map_start)) break;
    }
    query.T_map_goal = ground.pose(random);
    for (int i = 0; i < 20 && !planner->isFree(query.T_map_goal); ++i)
      query.T_map_goal = ground.pose(random);
    query.yaw_tolerance = drawn(random, 0, 2) == 0 ? 4.0 : 0.3;
    return query;
  }
  PathAnswer answer(const PathQuery& query, int expansions) {
    return planner->answer(query, after(expansions));
  }

  std::mt19937_64 random;
  RandomGround ground;
  Grid grid;
  PathConfig config = usualPaths();
  std::optional<PatternTable> table;
  std::optional<PathPlanner> planner;
};

/// All fields of an answer as bytes.
inline std::vector<unsigned char> bytesOf(const PathAnswer& answer) {
  std::vector<unsigned char> bytes;
  const auto add = [&bytes](const auto& value) {
    unsigned char raw[sizeof(value)];
    std::memcpy(raw, &value, sizeof(value));
    bytes.insert(bytes.end(), raw, raw + sizeof(value));
  };
  add(answer.end);
  for (const char letter : answer.reason) add(letter);
  add(answer.search.cost);
  add(answer.search.expansions);
  add(answer.search.exhausted);
  for (const PlanStep& step : answer.search.steps) {
    add(step.pattern_id);
    for (const double value : {step.T_map_end.x, step.T_map_end.y, step.T_map_end.yaw, step.time})
      add(value);
    add(step.uncertainty.xx);
    add(step.uncertainty.yawyaw);
  }
  return bytes;
}

}  // namespace tread::planner::testkit
