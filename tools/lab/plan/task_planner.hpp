// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "tools/lab/plan/lattice_planner.hpp"
#include "tools/lab/plan/map_file.hpp"
#include "tools/lab/plan/plan_files.hpp"
#include "tools/lab/plan/plan_report.hpp"

namespace tread::plan {

/// Options of tread-plan.
struct PlanOptions {
  std::string map;
  std::string patterns;
  bool exact = false;
  std::string footprint;         ///< "LENGTH,WIDTH" [m]
  std::optional<double> radius;  ///< [m]
  std::string start;             ///< "x,y,yaw" [m, m, rad] in the map's frame
  std::string goal;
  std::string tolerance = "0.25,0.26";  ///< "METRES,RADIANS"
  bool come_close = false;              ///< plan to the nearest place if the goal is unreachable
  std::optional<double> deadline_ms;
  std::optional<double> speed;      ///< [m/s]
  std::optional<double> turn_time;  ///< [s]
  std::string queries;
  int64_t random = 0;  ///< queries to draw; 0 = none
  uint64_t seed = 1;
  double apart = 3.0;  ///< [m]
  std::string write_queries;
  std::string json;
  std::string picture;
};

/// The robot's outline around its origin: a rectangle, or a disc if it has no length.
struct RobotShape {
  double length = 0.0;  ///< [m]
  double width = 0.0;   ///< [m]
  double radius = 0.0;  ///< [m] 0 = a point

  bool isRectangle() const { return length > 0.0; }
  bool isPoint() const { return !isRectangle() && radius <= 0.0; }
};

/// Everything to plan, read and checked.
struct PlanTask {
  MapFile map;
  Grid grid;  ///< the map for this robot; for a round robot with grown obstacles
  RobotShape shape;
  std::optional<PatternSet> patterns;       ///< pattern set
  std::optional<PrimitiveFile> primitives;  ///< or lattice primitives
  PrimitivePace pace;                       ///< of the primitives
  bool exact = false;                       ///< use the primitives on their lattice
  double position_tolerance = 0.25;         ///< [m]
  double yaw_tolerance = 0.26;              ///< [rad]
  bool come_close = false;
  std::optional<double> deadline_ms;  ///< none = until the search is complete
  std::vector<PlanQuery> queries;
  bool many = false;  ///< report on all queries instead of a plan
};

/// Reads the inputs that the options name; writes random queries if requested.
/** Throws std::runtime_error with one line for unreadable inputs and contradictory options. */
PlanTask loadTask(const PlanOptions& options);

/// Whether the robot is free at a pose in the grid's frame: nothing unknown or blocked under it.
bool standsFree(const PlanTask& task, const ClearanceField& clearance, const Pose2& T_grid_body);

/// Answers the queries of a task with the planner's core, and measures the time.
class TaskPlanner {
 public:
  /// Prepares what all queries share. Throws std::runtime_error with one line for an unusable
  /// pattern set.
  explicit TaskPlanner(const PlanTask& task);

  /// Its total_ms excludes preparationMs(). `spent_ms` of the deadline have passed.
  PlanAnswer answer(const PlanQuery& query, double spent_ms = 0.0);
  /// [ms] for patterns, clearance and connected areas.
  double preparationMs() const { return preparation_ms_; }
  /// Picture of the last query.
  PlanScene scene(const PlanQuery& query, const PlanAnswer& answer) const;

 private:
  void prepareLattice();
  void preparePlanner();
  const planner::PatternSearch& search() const {
    return lattice_ ? lattice_->search() : planner_->search();
  }
  const planner::PatternTable& patterns() const {
    return lattice_ ? lattice_->patterns() : *patterns_;
  }
  std::string nameOf(int number) const;
  void tellPlan(const Pose2& T_grid_start, const planner::SearchResult& result,
                PlanAnswer& answer) const;
  ClosestApproach closestApproach(const planner::PathAnswer& found, const PlanQuery& query,
                                  const PlanAnswer& answer) const;

  const PlanTask& task_;
  std::vector<SearchPrimitive> primitives_;  // if a file's primitives are used
  std::unique_ptr<planner::PatternTable> patterns_;
  std::unique_ptr<planner::PathPlanner> planner_;
  std::unique_ptr<LatticePlanner> lattice_;  // replaces it if the primitives are used exactly
  double preparation_ms_ = 0.0;
};

}  // namespace tread::plan
