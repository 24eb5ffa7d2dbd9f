// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "modules/planner/core/execution/side_hysteresis.hpp"
#include "modules/planner/core/map/local_map.hpp"

namespace tread::planner {

/// From where to plan, and with what.
struct PlanRequest {
  std::shared_ptr<const PatternTable> table;
  const LocalMap& local_map;
  const PlanStep& start;                    ///< the end of the running pattern, or where it stands
  const std::vector<PlanStep>& last_steps;  ///< of the last plan, from there on
  bool may_keep_next;                       ///< a pattern runs: its queued successor may be kept
};

/// Searches for plans, and keeps to the side that the last plan turned to.
class MotionPlanner {
 public:
  using Counters = std::map<std::string, int64_t>;

  MotionPlanner(const SearchConfig& search, const SideHysteresisConfig& side)
      : search_(search), branch_search_(search), side_(side) {}

  /// May end searches before the expansions do.
  void setStop(const StopPredicate& stop) { stop_ = stop; }
  SearchResult plan(const PlanRequest& request, int expansions, Counters& counters);

  SideHysteresis& side() { return side_; }
  const PatternSearch& search() const { return search_; }
  /// Call once a cycle with the set in use.
  void countCycle(const std::shared_ptr<const PatternTable>& table, bool driving) {
    if (searched_table_ != table && driving) ++cycles_with_old_set_;
  }
  void setReplaced() { cycles_with_old_set_ = 0; }

 private:
  SearchResult keepSide(SearchProblem& problem, SearchResult fresh, const StopPredicate& stop,
                        Counters& counters);
  SearchResult keepNext(SearchProblem& problem, SearchResult fresh, const StopPredicate& stop,
                        Counters& counters);

  PatternSearch search_;
  PatternSearch branch_search_;  ///< along a prescribed branch
  SideHysteresis side_;
  StopPredicate stop_;
  /// Of the last search: its tree, which is drawn later, points into it.
  std::shared_ptr<const PatternTable> searched_table_;
  int cycles_with_old_set_ = 0;  ///< since the newest set was taken
};

}  // namespace tread::planner
