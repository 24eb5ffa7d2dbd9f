// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "modules/planner/core/map/swept_footprint.hpp"
#include "modules/planner/core/search/uncertainty.hpp"

namespace tread::planner {

/// A motion of another planner, from rest to rest, that is searched with like a pattern.
struct Primitive {
  int id = 0;
  std::vector<Pose2> poses;  ///< T_start_pose, without the start, the end last
  double duration = 0.0;     ///< [s] > 0
  double cost = 0.0;         ///< [s, or whatever unit the plan's cost is to have] > 0
};

/// A pattern as the search wants it.
struct TablePattern {
  const MotionPattern* pattern = nullptr;  ///< nullptr = made of a Primitive
  int number = 0;                          ///< its id
  int entry = 0;                           ///< index of the entry class in the set
  int exit = 0;                            ///< index of the exit class
  double duration = 0.0;                   ///< [s]
  double cost = 0.0;                       ///< [s] as a part of a plan's cost: its duration
  double length = 0.0;                     ///< [m] of its path
  bool reverses = false;                   ///< ends behind its start
  std::vector<SweptPose> swept_poses;  ///< poses to check, without the start, at most a step apart
  SweptFootprint swept_footprint;      ///< those of them that are enough for a footprint
  Eigen::Vector2d centre{0.0, 0.0};  ///< of a disc that holds all positions, relative to the start
  double radius = 0.0;               ///< [m] of that disc
  Uncertainty uncertainty;           ///< of its end, in the axes of its start

  int id() const { return number; }
  const SweptPose& end() const { return swept_poses.back(); }
};

/// Standard deviations of the end of a pattern whose covariance nobody has stated.
struct DefaultSigma {
  double position = 0.05;  ///< [m] in both directions
  double yaw = 0.03;       ///< [rad]
};

/// What a metre of way and a radian of turn cost at least, taken together.
/** No pattern of the set costs less than per_metre * length + per_radian * |turn|. */
struct LeastCost {
  double per_metre = 0.0;   ///< [s/m]
  double per_radian = 0.0;  ///< [s/rad]
};

/// All patterns of a set prepared for searching: sampled once, turned and moved while searching.
/** Nothing is assumed about where patterns end: the learner may bend them at will. */
class PatternTable {
 public:
  PatternTable(PatternSet set, const SweepResolution& step, const DefaultSigma& sigma);
  /// Of primitives; the only class is rest.
  PatternTable(const std::vector<Primitive>& primitives, const SweepResolution& step);
  PatternTable(const PatternTable&) = delete;  // its lists point into itself
  PatternTable& operator=(const PatternTable&) = delete;

  /// The set that it was made of; none if it was made of primitives.
  const PatternSet& set() const { return *set_; }
  const std::vector<TablePattern>& patterns() const { return patterns_; }
  /// Patterns that begin in a class, in the order of the set.
  const std::vector<const TablePattern*>& from(int motion_class) const {
    return from_[static_cast<size_t>(motion_class)];
  }
  /// Those of them that end at rest.
  const std::vector<const TablePattern*>& stopsFrom(int motion_class) const {
    return stops_[static_cast<size_t>(motion_class)];
  }
  /// The pattern of that id or nullptr.
  const TablePattern* find(int id) const;
  /// Index of the class in which the vehicle stands; -1 if the set has none.
  int restClass() const { return rest_class_; }
  int classCount() const { return static_cast<int>(from_.size()); }
  const MotionClass& motionClass(int index) const {
    return set_->content().classes[static_cast<size_t>(index)];
  }
  int classIndex(const std::string& name) const;
  /// Greatest path length over duration of a pattern [m/s]: nothing in the set is faster.
  double bestSpeed() const { return best_speed_; }
  /// Greatest turn over duration of a pattern [rad/s].
  double bestTurnRate() const { return best_turn_rate_; }
  /// Two bounds, with as much as possible per metre and per radian.
  const std::array<LeastCost, 2>& leastCosts() const { return least_costs_; }
  /// Why nobody can drive with this set, in words; empty if one can.
  std::string defect() const;

 private:
  TablePattern prepare(const MotionPattern& pattern, const SweepResolution& step,
                       const DefaultSigma& sigma) const;
  int findRestClass() const;
  void index(size_t classes);
  void computeLeastCosts();

  std::optional<PatternSet> set_;
  std::vector<TablePattern> patterns_;
  std::vector<std::vector<const TablePattern*>> from_;
  std::vector<std::vector<const TablePattern*>> stops_;
  int rest_class_ = -1;
  double best_speed_ = 0.0;
  double best_turn_rate_ = 0.0;
  std::array<LeastCost, 2> least_costs_;
};

}  // namespace tread::planner
