// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::planner {

/// Moves for a vehicle that stands and finds no way on: back a little, or turn and look.
class Recovery {
 public:
  /// Ids of patterns that lead from rest to rest over free ground; empty if there are none.
  /** Every call prefers another kind: backing out, turning one way, turning the other way. On
   * blocked ground only moves that overlap no more than the vehicle does already. */
  std::vector<int> propose(const PatternTable& table, const CollisionChecker& collision_checker,
                           const Pose2& T_map_body);
  int tries() const { return tries_; }
  void restart() { tries_ = 0; }

 private:
  int tries_ = 0;
};

}  // namespace tread::planner
