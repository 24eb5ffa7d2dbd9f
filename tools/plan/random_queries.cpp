// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/plan/random_queries.hpp"

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

namespace tread::plan {
namespace {

constexpr size_t kDrawsEach = 1000;

/// Draws poses over a grid's window; the standard's distributions differ by library, this does not.
class Draw {
 public:
  Draw(const Grid& grid, uint64_t seed) : grid_(grid), random_(seed) {}

  Pose2 pose() {
    const double x = share() * grid_.width() * grid_.cellSize();
    const double y = share() * grid_.height() * grid_.cellSize();
    return {grid_.lower().x * grid_.cellSize() + x, grid_.lower().y * grid_.cellSize() + y,
            (2.0 * share() - 1.0) * kPi};
  }

 private:
  double share() { return static_cast<double>(random_() >> 11) * 0x1p-53; }  // [0, 1)

  const Grid& grid_;
  std::mt19937_64 random_;
};

}  // namespace

std::vector<PlanQuery> randomQueries(const Grid& grid, const Pose2& T_map_grid,
                                     const RandomQueries& wanted,
                                     const std::function<bool(const Pose2&)>& is_free) {
  Draw draw(grid, wanted.seed);
  std::vector<PlanQuery> queries;
  Pose2 start;
  bool has_start = false;
  for (size_t draws = kDrawsEach * wanted.count; queries.size() < wanted.count; --draws) {
    if (draws == 0)
      throw std::runtime_error("only " + std::to_string(queries.size()) + " of " +
                               std::to_string(wanted.count) +
                               " random queries found; the map has too little free room for the "
                               "footprint, or start and goal shall be too far apart");
    const Pose2 pose = draw.pose();
    if (!is_free(pose)) continue;
    // A pair that is too near is dropped as a whole: its start may have nothing far enough away.
    if (has_start && (pose.position() - start.position()).norm() > wanted.apart)
      queries.push_back({T_map_grid * start, T_map_grid * pose});
    has_start = !has_start;
    start = pose;
  }
  return queries;
}

}  // namespace tread::plan
