// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/planner/core/map/passage_map.hpp"
#include "modules/planner/core/search/search.hpp"
#include "tests/planner/kit/playground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"

namespace tread::planner::testkit {

/// A place, wholly known, with everything that a search wants of it.
struct SearchBench {
  SearchBench(const Grid& grid, const PatternSet& set, const Goal& aim, const Margins& margins = {},
              const FieldConfig& field = {})
      : map(grid.cellSize(), 32, PassageConfig{}),
        surroundings(grid, FootprintSize{}, margins),
        table(set, SweepStep{}, {}) {
    for (const Tile& tile : tilesOf(grid, 32, 1)) map.put(tile);
    map.refresh();
    goal = aim;
    cost_to_go = CostToGo(map, goal, {0.0, 0.0}, {}, field);
  }

  SearchProblem problem(const Pose2& start, const std::string& motion_class = "rest") const {
    SearchProblem task;
    task.T_map_start = start;
    task.start_class = table.classIndex(motion_class);
    task.patterns = &table;
    task.surroundings = &surroundings;
    task.cost_to_go = &cost_to_go;
    task.goal = goal;
    return task;
  }

  PassageMap map;
  Surroundings surroundings;
  PatternTable table;
  Goal goal;
  CostToGo cost_to_go;
};

/// A predicate that ends a search after so many expansions.
inline StopPredicate after(int expansions) {
  return [expansions](int count) { return count >= expansions; };
}

}  // namespace tread::planner::testkit
