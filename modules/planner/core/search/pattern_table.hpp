// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::planner {

/// A pose along a pattern, relative to its start, with the sine and cosine of its yaw.
struct SweptPose {
  Pose2 pose;
  double cos_yaw = 1.0;
  double sin_yaw = 0.0;
  double time = 0.0;   ///< [s] from the start of the pattern
  double reach = 0.0;  ///< [m] that a point of the outline has moved since then, approximately
};

/// How finely a pattern is sampled for collision checks.
struct SweepResolution {
  double distance = 0.10;  ///< [m]
  double turn = 0.105;     ///< [rad]
  /// [m] The footprint's sweep over this distance of a straight path is covered by the footprint at
  /// both ends, if it is at least this long: the search checks no more poses than that, and as many
  /// as turns need.
  double covered = 0.3;
  /// The largest footprint used, margins included: determines how far its corners swing.
  FootprintSize outline;
};

/// A disc around ground that a corner of the outline passes over between two checked poses and that
/// neither of these covers; in the axes of the sweep's start.
struct CornerDisc {
  float x = 0.0F;       ///< [m] its centre
  float y = 0.0F;       ///< [m]
  float out_x = 0.0F;   ///< [m per m] displacement of the centre per metre of margin
  float out_y = 0.0F;   ///< [m per m]
  float radius = 0.0F;  ///< [m]
  float spread = 0.0F;  ///< [m per m] to be added per metre of other margin
  int way = 0;          ///< the one that ends at the cover's pose with this number
};

/// A pose of a sweep that is always checked, and the path to it from the previous one.
struct CheckedPose {
  SweptPose at;
  /// First of the further poses to check if not all discs of the path are free: index into
  /// SweptFootprint::between.
  size_t first_between = 0;
  size_t between_count = 0;
};

/// The poses of a sweep to check for a footprint, without the start, the end last.
struct SweptFootprint {
  std::vector<CheckedPose> poses;
  std::vector<CornerDisc> discs;
  std::vector<SweptPose> between;
  double front = 0.0;  ///< [m] of the outline for which they were computed
};

/// Covariance of a planar pose, upper triangle [m2, m rad, rad2]; all 0 = certain.
struct Uncertainty {
  float xx = 0.0F, xy = 0.0F, xyaw = 0.0F;
  float yy = 0.0F, yyaw = 0.0F;
  float yawyaw = 0.0F;

  /// Largest variance of the position in any direction [m2].
  float position() const {
    const float half = 0.5F * (xx - yy);
    return 0.5F * (xx + yy) + std::sqrt(half * half + xy * xy);
  }
  /// Upper bound of the variance of a point `arm` [m] away from the origin [m2].
  /** The sum of two standard deviations is that of fully correlated errors. */
  float ofPoint(float arm) const {
    const float sigma = std::sqrt(position()) + arm * std::sqrt(yawyaw);
    return sigma * sigma;
  }
};

/// A covariance as in pattern sets; `otherwise` if it is unknown (NaN).
inline Uncertainty uncertaintyOf(const PoseCovariance& c, const Uncertainty& otherwise) {
  for (const double value : c)
    if (!std::isfinite(value)) return otherwise;
  Uncertainty result;
  result.xx = std::max(0.0F, static_cast<float>(c[0]));
  result.xy = static_cast<float>(c[1]);
  result.xyaw = static_cast<float>(c[2]);
  result.yy = std::max(0.0F, static_cast<float>(c[3]));
  result.yyaw = static_cast<float>(c[4]);
  result.yawyaw = std::max(0.0F, static_cast<float>(c[5]));
  return result;
}

/// Uncertainty, in map, of T_map_b * T_b_c with independent errors.
/** `at` belongs to T_map_b and is in map axes; `step` to T_b_c, in the axes of b; (dx, dy) is
 * T_b_c's translation in map axes [m], (c, s) are cosine and sine of b's yaw. First order: P' = F P
 * F' + G Q G' with F = [1 0 -dy; 0 1 dx; 0 0 1] and G = rotation by b's yaw. */
inline Uncertainty compose(const Uncertainty& at, const Uncertainty& step, float dx, float dy,
                           float c, float s) {
  Uncertainty r;
  r.yawyaw = at.yawyaw + step.yawyaw;
  r.xyaw = at.xyaw - dy * at.yawyaw + c * step.xyaw - s * step.yyaw;
  r.yyaw = at.yyaw + dx * at.yawyaw + s * step.xyaw + c * step.yyaw;
  r.xx = at.xx - 2.0F * dy * at.xyaw + dy * dy * at.yawyaw + c * c * step.xx -
         2.0F * c * s * step.xy + s * s * step.yy;
  r.yy = at.yy + 2.0F * dx * at.yyaw + dx * dx * at.yawyaw + s * s * step.xx +
         2.0F * c * s * step.xy + c * c * step.yy;
  r.xy = at.xy + dx * at.xyaw - dy * at.yyaw - dx * dy * at.yawyaw + c * s * (step.xx - step.yy) +
         (c * c - s * s) * step.xy;
  return r;
}

/// A share [1] of an uncertainty, in axes rotated by a yaw [rad].
inline Uncertainty scaled(const Uncertainty& u, double share, double yaw) {
  const auto k = static_cast<float>(share);
  const Uncertainty part{k * u.xx, k * u.xy, k * u.xyaw, k * u.yy, k * u.yyaw, k * u.yawyaw};
  return compose({}, part, 0.0F, 0.0F, static_cast<float>(std::cos(yaw)),
                 static_cast<float>(std::sin(yaw)));
}

/// A motion of another planner, from rest to rest, used in the search like a pattern.
struct Primitive {
  int id = 0;
  std::vector<Pose2> poses;  ///< T_start_pose, without the start, the end last
  double duration = 0.0;     ///< [s] > 0
  double cost = 0.0;         ///< [s, or the unit of the plan's cost] > 0
};

/// A pattern prepared for the search.
struct TablePattern {
  const MotionPattern* pattern = nullptr;  ///< nullptr = made from a Primitive
  int number = 0;                          ///< its id
  int entry = 0;                           ///< index of the entry class in the set
  int exit = 0;                            ///< index of the exit class
  double duration = 0.0;                   ///< [s]
  double cost = 0.0;                       ///< [s] contribution to a plan's cost: its duration
  double length = 0.0;                     ///< [m] of its path
  bool reverses = false;                   ///< ends behind its start
  std::vector<SweptPose> swept_poses;  ///< poses to check, without the start, at most a step apart
  SweptFootprint swept_footprint;      ///< those of them that suffice for a footprint
  Eigen::Vector2d centre{0.0,
                         0.0};  ///< of a disc that contains all positions, relative to the start
  double radius = 0.0;          ///< [m] of that disc
  Uncertainty uncertainty;      ///< of its end, in the axes of its start
  Eigen::Vector2d v_exit{0.0, 0.0};  ///< [m/s] at its end, in the axes of its end

  int id() const { return number; }
  const SweptPose& end() const { return swept_poses.back(); }
};

/// Standard deviations of the end of a pattern without a covariance.
struct DefaultSigma {
  double position = 0.05;  ///< [m] in both directions
  double yaw = 0.03;       ///< [rad]
};

/// Least cost of a metre of path and a radian of turn, combined.
/** No pattern of the set costs less than per_metre * length + per_radian * |turn|. */
struct LeastCost {
  double per_metre = 0.0;   ///< [s/m]
  double per_radian = 0.0;  ///< [s/rad]
};

/// Two lower bounds of the cost of some patterns: with the largest possible part per metre, and per
/// radian.
std::array<LeastCost, 2> leastCostsOf(const std::vector<const TablePattern*>& patterns);

/// All patterns of a set prepared for searching: sampled once, then rotated and moved.
/** Nothing is assumed about the ends of patterns: the learner may change them arbitrarily. */
class PatternTable {
 public:
  /// `top_speed` [m/s]: faster patterns, and those that enter or leave a faster class, are not
  /// started, except those that slow the vehicle down or stop it.
  PatternTable(PatternSet set, const SweepResolution& step, const DefaultSigma& sigma,
               double top_speed = std::numeric_limits<double>::infinity());
  /// Of primitives; the only class is rest.
  PatternTable(const std::vector<Primitive>& primitives, const SweepResolution& step);
  PatternTable(const PatternTable&) = delete;  // its lists point into itself
  PatternTable& operator=(const PatternTable&) = delete;

  /// The set it was made from; none if it was made from primitives.
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
  /// Index of the class in which the vehicle is at rest; -1 if the set has none.
  int restClass() const { return rest_class_; }
  int classCount() const { return static_cast<int>(from_.size()); }
  const MotionClass& motionClass(int index) const {
    return set_->content().classes[static_cast<size_t>(index)];
  }
  int classIndex(const std::string& name) const;
  /// Greatest path length over duration of a pattern within the top speed [m/s].
  double bestSpeed() const { return best_speed_; }
  /// [s] median of the patterns that can be joined at both ends; of all if there are none.
  double usualDuration() const { return usual_duration_; }
  /// leastCostsOf() all patterns.
  const std::array<LeastCost, 2>& leastCosts() const { return least_costs_; }
  /// Why the set is unusable for driving, in words; empty if it is usable.
  std::string defect() const;

 private:
  TablePattern prepare(const MotionPattern& pattern, const SweepResolution& step,
                       const DefaultSigma& sigma) const;
  int findRestClass() const;
  bool isTooFast(const TablePattern& pattern, double top_speed) const;
  double medianDuration() const;
  void index(size_t classes, double top_speed);

  std::optional<PatternSet> set_;
  std::vector<TablePattern> patterns_;
  std::vector<std::vector<const TablePattern*>> from_;
  std::vector<std::vector<const TablePattern*>> stops_;
  int rest_class_ = -1;
  double best_speed_ = 0.0;
  double usual_duration_ = 0.0;
  std::array<LeastCost, 2> least_costs_;
};

}  // namespace tread::planner
