// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace tread::plan::samples {

/// The two files of a generated map.
struct PlanningMap {
  std::string name;  ///< of the files: NAME.yaml and NAME.pgm
  std::string yaml;
  std::string picture;  ///< PGM, P5
};

/// The seed of the maps in tests/data/planning.
inline constexpr uint64_t kPlanningMapsSeed = 1;

/// 30 x 20 m in 5 cm cells each; a seed gives the same bytes on every platform.
/** office: rooms with doors of 1.0 m on both sides of a corridor, desks and chairs in them. forest:
 * trunks of 10 to 40 cm radius with gaps of at least 0.4 m. dead_end: four cul-de-sacs 18 m long
 * lead towards the goal; the only path is a slalom far from it. */
std::array<PlanningMap, 3> planningMaps(uint64_t seed);

}  // namespace tread::plan::samples
