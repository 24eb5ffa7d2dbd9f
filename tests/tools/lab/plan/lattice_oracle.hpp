// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "tools/lab/plan/map_file.hpp"
#include "tools/lab/plan/primitives.hpp"

namespace tread::plan::samples {

/// Least cost from start to goal on a whole map as counted by SBPL, by Dijkstra; -1 if there is no
/// path.
class LatticeOracle {
 public:
  LatticeOracle(const MapFile& map, const PrimitiveFile& file)
      : map_(map), file_(file), blocked_(gridForPoint(map)) {
    actions_.resize(file.headings.size());
    for (SearchPrimitive& action : onLattice(file, {*map.nominal_speed, *map.turn_time}))
      actions_[static_cast<size_t>(action.start_bin)].push_back(std::move(action));
  }

  int64_t cost() {
    const State start = stateOf(*map_.T_map_start);
    const State goal = stateOf(*map_.T_map_goal);
    std::set<std::pair<int64_t, State>> open{{0, start}};
    std::map<State, int64_t> best{{start, 0}};
    while (!open.empty()) {
      const auto [cost, state] = *open.begin();
      open.erase(open.begin());
      if (state == goal) return cost;
      if (cost > best[state]) continue;
      for (const SearchPrimitive& action : actions_[static_cast<size_t>(std::get<2>(state))]) {
        const auto [x, y, bin] = state;
        const int64_t step = costOf({x, y}, action);
        const CellIndex end = action.cells.back();
        const double yaw = file_.headings[static_cast<size_t>(bin)] + action.poses.back().yaw;
        const State next{x + end.x, y + end.y, nearestBin(file_.headings, yaw)};
        const auto known = best.find(next);
        if (step < 0 || (known != best.end() && known->second <= cost + step)) continue;
        best[next] = cost + step;
        open.insert({cost + step, next});
      }
    }
    return -1;
  }

 private:
  using State = std::tuple<int, int, int>;

  State stateOf(const Pose2& pose) const {
    const CellIndex cell = map_.grid.indexOf(pose.position());
    return {cell.x, cell.y, nearestBin(file_.headings, pose.yaw)};
  }

  int64_t costOf(CellIndex from, const SearchPrimitive& action) const {
    int dearest = 0;
    std::vector<CellIndex> cells = action.cells;
    cells.push_back({0, 0});
    for (const CellIndex& offset : cells) {
      const CellIndex cell{from.x + offset.x, from.y + offset.y};
      if (blocked_.at(cell) != kFree) return -1;
      dearest = std::max<int>(dearest, map_.costs[map_.grid.offset(cell)]);
    }
    return static_cast<int64_t>(action.cost) * (dearest + 1);
  }

  const MapFile& map_;
  const PrimitiveFile& file_;
  Grid blocked_;
  std::vector<std::vector<SearchPrimitive>> actions_;  // by start bin
};

}  // namespace tread::plan::samples
