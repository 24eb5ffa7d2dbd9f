// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "modules/planner/core/execution/situation.hpp"

namespace tread::planner {

/// Whether the inputs allow to drive.
struct Readiness {
  enum class Level {
    kGo,
    kFinish,  ///< no new pattern but one that stops
    kStop     ///< the program is emptied now
  };
  Level level = Level::kGo;
  PlanStatus status = PlanStatus::kDriving;  ///< to report if not kGo
  std::string reason;                        ///< in words, empty if kGo
};

/// What map and patterns are like, beside the situation.
struct Supplies {
  int64_t map_utime = 0;                          ///< [us] of the newest scan in the map; 0 = none
  std::string set_defect = "no PATTERN_SET yet";  ///< why the set is of no use; empty = good
  bool was_armed =
      false;  ///< the bridge was armed since the start: what it does not allow now was taken away
};

/// Judges the inputs: the worst of what is wrong decides.
Readiness judge(const Situation& situation, const Supplies& supplies, const AgeLimits& limits);

}  // namespace tread::planner
