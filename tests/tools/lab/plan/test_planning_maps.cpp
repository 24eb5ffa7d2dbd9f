// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <vector>

#include "common/grid/clearance.hpp"
#include "common/store/store.hpp"
#include "tests/tools/lab/plan/plan_samples.hpp"
#include "tests/tools/lab/plan/planning_maps.hpp"
#include "tools/lab/plan/map_file.hpp"
#include "tools/lab/plan/plan_files.hpp"

using namespace tread;
using namespace tread::plan;
using namespace tread::plan::samples;

namespace {

const std::string kFolder = std::string(TREAD_SOURCE_DIR) + "/tests/data/planning/";

/// Number of one-cell steps that a disc needs from a point to each cell.
class Ways {
 public:
  Ways(const std::string& name, const Eigen::Vector2d& from, double radius)
      : map_(readMap(kFolder + name)), clearance_(map_.grid, true), radius_(radius) {
    steps_.assign(map_.grid.cells().size(), -1);
    std::vector<CellIndex> front{cellAt(from)};
    for (int step = 0; !front.empty(); ++step) front = onwards(front, step);
  }

  /// -1 = unreachable.
  int stepsTo(const Eigen::Vector2d& p_map) const {
    return steps_[map_.grid.offset(cellAt(p_map))];
  }
  /// Share of the reachable cells among those where the disc fits.
  double share() const {
    size_t free = 0;
    size_t reached = 0;
    for (int y = 0; y < map_.grid.height(); ++y)
      for (int x = 0; x < map_.grid.width(); ++x) {
        free += isFree({x, y}) ? 1 : 0;
        reached += steps_[map_.grid.offset({x, y})] >= 0 ? 1 : 0;
      }
    return static_cast<double>(reached) / static_cast<double>(free);
  }

 private:
  CellIndex cellAt(const Eigen::Vector2d& p_map) const {
    return map_.grid.indexOf(inverse(map_.T_map_grid) * p_map);
  }
  bool isFree(CellIndex cell) const { return clearance_.at(map_.grid.centre(cell)) >= radius_; }
  std::vector<CellIndex> onwards(const std::vector<CellIndex>& front, int step) {
    std::vector<CellIndex> next;
    for (const CellIndex& cell : front) {
      if (!map_.grid.contains(cell) || steps_[map_.grid.offset(cell)] >= 0 || !isFree(cell))
        continue;
      steps_[map_.grid.offset(cell)] = step;
      next.insert(
          next.end(),
          {{cell.x + 1, cell.y}, {cell.x - 1, cell.y}, {cell.x, cell.y + 1}, {cell.x, cell.y - 1}});
    }
    return next;
  }

  MapFile map_;
  ClearanceField clearance_;
  double radius_;
  std::vector<int> steps_;
};

/// The same without obstacles.
int straightSteps(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  return static_cast<int>((to - from).lpNorm<1>() / 0.05);
}

}  // namespace

TEST_CASE("our maps in the tree are those that make-planning-maps makes") {
  for (const PlanningMap& map : planningMaps(kPlanningMapsSeed)) {
    CAPTURE(map.name);
    CHECK(readText(kFolder + map.name + ".yaml") == map.yaml);
    CHECK((readText(kFolder + map.name + ".pgm") == map.picture));
  }
}

TEST_CASE("our maps have a way for their task, and the dead ends a long one") {
  const Eigen::Vector2d office(13.5, 0.1);
  CHECK(Ways("office.yaml", -office, 0.45).stepsTo(office) > 0);
  CHECK(Ways("forest.yaml", {1.5, 1.5}, 0.35).stepsTo({28.5, 18.5}) > 0);
  const Ways dead_end("dead_end.yaml", {5.0, 9.0}, 0.5);
  CHECK(dead_end.stepsTo({29.5, 9.0}) > 2 * straightSteps({5.0, 9.0}, {29.5, 9.0}));
  for (const double y : {7.0, 9.0, 11.0, 15.0}) CHECK(dead_end.stepsTo({25.0, y}) > 0);
}

TEST_CASE("nearly all free room of our maps can be come to") {
  CHECK(Ways("office.yaml", {-13.5, 0.1}, 0.45).share() > 0.95);
  CHECK(Ways("forest.yaml", {1.5, 1.5}, 0.35).share() > 0.95);
  CHECK(Ways("dead_end.yaml", {5.0, 9.0}, 0.5).share() > 0.95);
}
