// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/planner/core/map/clearance_map.hpp"
#include "modules/planner/core/search/pattern_search.hpp"
#include "tests/planner/kit/playground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"
#include "tests/planner/kit/vehicle.hpp"

namespace tread::planner::testkit {

/// A completely known place with all inputs of a search.
struct SearchBench {
  SearchBench(const Grid& grid, const PatternSet& set, const Goal& aim, const Margins& margins = {},
              const DistanceFieldConfig& field = usualField())
      : map(grid.cellSize(), 32, ClearanceMapConfig{}),
        collision_checker(grid, kVehicle, margins),
        table(set, usualSweep(), {}) {
    for (const Tile& tile : tilesOf(grid, 32, 1)) map.put(tile);
    map.refresh();
    goal = aim;
    distance_to_goal = DistanceToGoal(map, goal, {0.0, 0.0}, {}, field);
  }

  SearchProblem problem(const Pose2& start, const std::string& motion_class = "rest") const {
    SearchProblem task;
    task.T_map_start = start;
    task.start_class = table.classIndex(motion_class);
    task.patterns = &table;
    task.collision_checker = &collision_checker;
    task.distance_to_goal = &distance_to_goal;
    task.goal = goal;
    return task;
  }

  ClearanceMap map;
  CollisionChecker collision_checker;
  PatternTable table;
  Goal goal;
  DistanceToGoal distance_to_goal;
};

/// A predicate that ends a search after a number of expansions.
inline StopPredicate after(int expansions) {
  return [expansions](int count) { return count >= expansions; };
}

}  // namespace tread::planner::testkit
