// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::planner {

/// The poses on a coarse grid at which the footprint is free: the states of HeadingAwareHeuristic.
/** A square is free in a heading if the footprint is free at the cell of the square with the
 * largest clearance. Computed on demand and cached for all goals on the same map. */
class FreeConfigurations {
 public:
  static constexpr int kHeadings = 16;
  /// Squares of blocked ground around the map, which stop every move.
  static constexpr int kRim = 2;

  /// `radius`: of the disc inside the footprint [m]; a square's side is a little less, so that no
  /// wall falls between two squares. `grown`: earlier inflation of obstacles [m], which makes walls
  /// thicker. `checker` must outlive this.
  FreeConfigurations(const CollisionChecker& collision_checker, double radius, double grown = 0.0);

  double size() const { return size_; }
  int width() const { return width_; }
  int height() const { return height_; }
  int stride() const { return width_ + 2 * kRim; }
  size_t count() const { return best_.size(); }
  size_t number(int column, int row) const {
    return static_cast<size_t>(row + kRim) * static_cast<size_t>(stride()) +
           static_cast<size_t>(column + kRim);
  }
  /// Column and row of the square that contains a point of map; may be outside.
  int column(double x) const { return static_cast<int>(std::floor((x - lower_.x()) / size_)); }
  int row(double y) const { return static_cast<int>(std::floor((y - lower_.y()) / size_)); }
  Eigen::Vector2d centre(int column, int row) const {
    return lower_ + size_ * Eigen::Vector2d(column + 0.5, row + 0.5);
  }
  const Eigen::Vector2d& lower() const { return lower_; }

  /// Whether a disc is free somewhere in the square.
  bool passable(size_t square) const { return headings_[square] != Headings::kNone; }
  bool isFree(size_t square, int heading) {
    if (headings_[square] == Headings::kAll) return true;
    if (headings_[square] == Headings::kNone) return false;
    const auto bit = static_cast<uint16_t>(1U << static_cast<unsigned>(heading));
    if ((asked_[square] & bit) == 0) ask(square, heading);
    return (free_[square] & bit) != 0;
  }

 private:
  enum class Headings : uint8_t { kNone, kSome, kAll };
  void ask(size_t square, int heading);

  const CollisionChecker& checker_;
  double size_ = 0.3;
  Eigen::Vector2d lower_{0.0, 0.0};
  int width_ = 0;
  int height_ = 0;
  std::vector<Headings> headings_;
  std::vector<CellIndex> best_;  // cell with the largest clearance, in map
  std::vector<uint16_t> asked_;
  std::vector<uint16_t> free_;
};

/// Least cost of driving and turning with any pattern of a set.
struct MotionRates {
  /// Cost of a path combined with a turn: the larger of two sums.
  struct Rate {
    LeastCost by_way;
    LeastCost by_turn;
    bool any = false;    ///< whether the set has such patterns
    bool turns = false;  ///< whether any of them turns
    float cost(double way, double turn) const;
  };
  /// By direction: straight ahead, 22.5 degrees to the left of that, and so on.
  std::array<Rate, FreeConfigurations::kHeadings> along;
  Rate turn;  ///< of patterns that turn on the spot
};

MotionRates motionRates(const PatternTable& patterns);

/// Cost to the goal by position and heading on a coarse grid, including the cost of turns.
/** The vehicle drives along its heading, ahead or back, and turns while driving or on the spot,
 * each at the least cost of the set's patterns, but with no minimum radius. A* from the goal over
 * positions and headings towards the start; expanded until the start is reached, and somewhat
 * further. See SearchProblem::heading_heuristic for its users. */
class HeadingAwareHeuristic {
 public:
  static constexpr int kHeadings = FreeConfigurations::kHeadings;

  HeadingAwareHeuristic() = default;
  /// `beyond`: share of the start's cost [1] by which it is expanded further. `configurations` must
  /// outlive this. If interrupted, it does not reach the start.
  HeadingAwareHeuristic(FreeConfigurations& configurations, const Goal& goal,
                        const Pose2& T_map_start, const MotionRates& rates, double beyond,
                        const Interruption& interruption = {});

  bool empty() const { return cost_.empty(); }
  /// Cost from a pose to the goal, yaw within half a turn; infinite if there is no path. A state
  /// that was not expanded costs, together with the path to it from the start, more than any
  /// expanded one: it gets the least such cost.
  float at(double x, double y, float yaw) const {
    const double column = (x - lower_.x()) * per_size_;
    const double row = (y - lower_.y()) * per_size_;
    if (!(column >= 0.0 && row >= 0.0 && column < configurations_->width() &&
          row < configurations_->height()))
      return cut_;
    const int c = static_cast<int>(column);
    const int r = static_cast<int>(row);
    const float value =
        cost_[configurations_->number(c, r) * kHeadings + static_cast<size_t>(binOf(yaw))];
    // A cost that was found but not settled may exceed the minimum.
    return std::min(value, std::max(0.0F, cut_ - fromStart(c, r)));
  }
  /// Whether the start can be reached from the goal.
  bool reached() const { return reached_; }
  int filled() const { return filled_; }
  size_t bytes() const { return cost_.capacity() * sizeof(float); }

 private:
  struct Front;
  struct Move {
    int offset = 0;   // [squares] from a square to its predecessor
    int between = 0;  // a square passed on the way; 0 = none
    int between_too = 0;
    int turn = 0;  // [bins] from the predecessor's heading to this one
    float cost = 0.0F;
  };

  static int binOf(float yaw) {
    const float turns = yaw * static_cast<float>(kHeadings / (2.0 * kPi)) + kHeadings + 0.5F;
    return static_cast<int>(turns) % kHeadings;
  }
  void prepareMoves(const MotionRates& rates);
  void addMoves(int heading, int direction, const MotionRates::Rate& rate);
  void seed(const Goal& goal, Front& front);
  void fill(const Pose2& T_map_start, double beyond, Front& front,
            const Interruption& interruption);
  void relax(size_t state, Front& front);
  /// Least cost between the start and a square.
  float fromStart(int column, int row) const {
    const auto dx = static_cast<float>(column - start_column_);
    const auto dy = static_cast<float>(row - start_row_);
    return square_cost_ * std::sqrt(dx * dx + dy * dy);
  }
  float fromStart(size_t square) const;

  FreeConfigurations* configurations_ = nullptr;
  double per_size_ = 1.0;
  Eigen::Vector2d lower_{0.0, 0.0};
  std::vector<float> cost_;  // by square and heading
  std::vector<Move> moves_[kHeadings];
  float cut_ = std::numeric_limits<float>::infinity();
  float least_move_ = 0.0F;
  float square_cost_ = 0.0F;  // to cross a square, at least
  int start_column_ = 0;
  int start_row_ = 0;
  size_t start_ = 0;
  bool reached_ = false;
  int filled_ = 0;
};

}  // namespace tread::planner
