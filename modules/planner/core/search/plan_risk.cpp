// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/search/plan_risk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tread::planner {
namespace {

/// Obstacles farther away, in standard deviations, are never touched.
constexpr double kFarthestSigmas = 5.0;
/// Probabilities for the front, the rear and both sides.
using Sides = std::array<double, 4>;

double sum(const Sides& sides) {
  return std::min(1.0, sides[0] + sides[1] + sides[2] + sides[3]);
}

/// Variance of a point of the body along a direction, both in map axes [m2].
double varianceOf(const Uncertainty& u, const Eigen::Vector2d& along,
                  const Eigen::Vector2d& from_origin) {
  const double arm = along.y() * from_origin.x() - along.x() * from_origin.y();
  const double variance =
      along.x() * along.x() * static_cast<double>(u.xx) +
      2.0 * along.x() * along.y() * static_cast<double>(u.xy) +
      along.y() * along.y() * static_cast<double>(u.yy) +
      2.0 * arm *
          (along.x() * static_cast<double>(u.xyaw) + along.y() * static_cast<double>(u.yyaw)) +
      arm * arm * static_cast<double>(u.yawyaw);
  return std::max(0.0, variance);
}

/// The footprint at one pose, and its possible error there.
class PoseRisk {
 public:
  PoseRisk(const CollisionChecker& around, const TurnedPose& pose, const Uncertainty& uncertainty)
      : around_(around), size_(around.footprint()), pose_(pose), uncertainty_(uncertainty) {}

  /// Raises the probabilities of the sides to those at this pose.
  void raise(Sides& sides) const {
    const auto arm = static_cast<float>(around_.circumscribedRadius());
    const double sigma = std::sqrt(static_cast<double>(uncertainty_.ofPoint(arm)));
    const Grid& grid = around_.grid();
    const double reach = around_.circumscribedRadius() + kFarthestSigmas * sigma + grid.cellSize();
    if (around_.field().quick(pose_.x, pose_.y) > reach) return;
    const CellIndex first = grid.indexOf({pose_.x - reach, pose_.y - reach});
    const CellIndex last = grid.indexOf({pose_.x + reach, pose_.y + reach});
    // Beyond the grid nothing is known, however large the error may be.
    const CellIndex lower = grid.lower();
    for (int y = std::max(first.y, lower.y); y <= std::min(last.y, lower.y + grid.height() - 1);
         ++y)
      for (int x = std::max(first.x, lower.x); x <= std::min(last.x, lower.x + grid.width() - 1);
           ++x)
        if (grid.at({x, y}) == kObstacle) raiseBy(grid.centre({x, y}), sides);
  }

 private:
  void raiseBy(const Eigen::Vector2d& p_map, Sides& sides) const {
    const double c = pose_.cos_yaw;
    const double s = pose_.sin_yaw;
    const Eigen::Vector2d off(p_map.x() - pose_.x, p_map.y() - pose_.y);
    const Eigen::Vector2d p(c * off.x() + s * off.y(), c * off.y() - s * off.x());
    const Eigen::Vector2d nearest(std::clamp(p.x(), -size_.rear, size_.front),
                                  std::clamp(p.y(), -size_.half_width, size_.half_width));
    const Eigen::Vector2d way = p - nearest;
    const Eigen::Vector2d x_map(c, s);
    const Eigen::Vector2d y_map(-s, c);
    const Eigen::Vector2d arm = nearest.x() * x_map + nearest.y() * y_map;
    // An obstacle off a corner is touched only by a motion that far in both directions.
    const double lengthwise = chanceOf(way.x(), x_map, arm);
    const double sideways = chanceOf(way.y(), y_map, arm);
    const size_t side = lengthwise < sideways ? (way.x() < 0.0 ? 1 : 0) : (way.y() < 0.0 ? 3 : 2);
    sides[side] = std::max(sides[side], std::min(lengthwise, sideways));
  }

  /// Probability that a point of the body moves this far along an axis.
  double chanceOf(double way, const Eigen::Vector2d& axis, const Eigen::Vector2d& arm) const {
    if (way == 0.0) return 1.0;
    // An observed obstacle may be anywhere in its cell.
    const double cell = around_.grid().cellSize();
    const double variance = cell * cell / 12.0 + varianceOf(uncertainty_, axis, arm);
    return 0.5 * std::erfc(std::abs(way) / std::sqrt(2.0 * variance));
  }

  const CollisionChecker& around_;
  const FootprintSize& size_;
  TurnedPose pose_;
  Uncertainty uncertainty_;
};

/// Follows the patterns of a plan, with the error of the newest of them.
class RiskAlong {
 public:
  explicit RiskAlong(const RiskQuestion& question) : question_(question) {}

  /// Probability in a step that begins at a pose.
  double of(size_t step, const Pose2& T_map_start) const {
    const TablePattern& pattern = *question_.patterns.find(question_.steps[step].pattern_id);
    const TurnedPose start = turned(T_map_start);
    Sides sides{};
    for (const SweptPose& at : pattern.swept_poses) {
      const double dx = start.cos_yaw * at.pose.x - start.sin_yaw * at.pose.y;
      const double dy = start.sin_yaw * at.pose.x + start.cos_yaw * at.pose.y;
      const TurnedPose pose{start.x + dx, start.y + dy,
                            start.cos_yaw * at.cos_yaw - start.sin_yaw * at.sin_yaw,
                            start.sin_yaw * at.cos_yaw + start.cos_yaw * at.sin_yaw};
      const double recent = std::min(at.time, question_.reaction);
      const Uncertainty own = partOf(pattern, recent, T_map_start.yaw);
      const Uncertainty off = compose(before(step, question_.reaction - recent), own,
                                      static_cast<float>(dx), static_cast<float>(dy), 1.0F, 0.0F);
      PoseRisk(question_.around, pose, off).raise(sides);
    }
    return sum(sides);
  }

 private:
  /// Of this many seconds of a pattern, in map axes.
  static Uncertainty partOf(const TablePattern& pattern, double seconds, double yaw) {
    return scaled(pattern.uncertainty, std::min(1.0, seconds / pattern.duration), yaw);
  }
  Pose2 startOf(size_t step) const {
    return step == 0 ? question_.start.T_map_end : question_.steps[step - 1].T_map_end;
  }
  /// Of the last seconds before a step.
  Uncertainty before(size_t step, double seconds) const {
    if (seconds <= 0.0) return {};
    if (step == 0) return question_.start.uncertainty;
    const TablePattern& last = *question_.patterns.find(question_.steps[step - 1].pattern_id);
    const Pose2 from = startOf(step - 1);
    const Pose2 to = startOf(step);
    return compose(before(step - 1, seconds - last.duration),
                   partOf(last, std::min(seconds, last.duration), from.yaw),
                   static_cast<float>(to.x - from.x), static_cast<float>(to.y - from.y), 1.0F,
                   0.0F);
  }

  const RiskQuestion& question_;
};

}  // namespace

PlanRisk riskOf(const RiskQuestion& question) {
  PlanRisk risk;
  const RiskAlong along(question);
  double untouched = 1.0;
  double metres = 0.0;
  Pose2 from = question.start.T_map_end;
  for (size_t i = 0; i < question.steps.size(); ++i) {
    const double chance = along.of(i, from);
    if (i == 0) risk.first = chance;
    untouched *= 1.0 - chance;
    metres += question.patterns.find(question.steps[i].pattern_id)->length;
    from = question.steps[i].T_map_end;
  }
  if (question.steps.empty()) return risk;
  risk.touch = 1.0 - untouched;
  if (metres > 0.0) risk.per_metre = risk.touch / metres;
  return risk;
}

}  // namespace tread::planner
