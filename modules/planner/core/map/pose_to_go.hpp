// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "modules/planner/core/map/cost_to_go.hpp"
#include "modules/planner/core/map/places.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::planner {

/// What driving and turning cost, as little as any pattern of a set can do it for.
struct MotionRates {
  /// Cost of a way and of a turn made together: the greater of two sums.
  struct Rate {
    LeastCost by_way;
    LeastCost by_turn;
    bool any = false;    ///< whether the set has such patterns at all
    bool turns = false;  ///< whether any of them turns
    float cost(double way, double turn) const;
  };
  /// By direction: those that go ahead, 22.5 degrees to the left of that, and so on.
  std::array<Rate, Places::kHeadings> along;
  Rate turn;  ///< of patterns that turn on the spot
};

MotionRates motionRates(const PatternTable& patterns);

/// Cost to the goal by place and heading, on a coarse grid: a guide that knows what turns cost.
/** The vehicle drives along its heading, ahead or back, and turns on the way or on the spot, each
 * for the least that the set's patterns do it for, but with no least radius. A* from the goal over
 * places and headings towards the start; filled in until that is reached, and some further. */
class PoseToGo {
 public:
  static constexpr int kHeadings = Places::kHeadings;

  PoseToGo() = default;
  /// `beyond`: share of the start's cost [1] by which more is filled in. `places` must stay.
  /// Interrupted, it does not reach the start.
  PoseToGo(Places& places, const Goal& goal, const Pose2& T_map_start, const MotionRates& rates,
           double beyond, const Interruption& interruption = {});

  bool empty() const { return cost_.empty(); }
  /// Cost from a pose to the goal, yaw within half a turn; infinite where there is no way. What was
  /// not filled in costs, with the way there from the start, more than what was: there it is the
  /// least that it can be.
  float at(double x, double y, float yaw) const {
    const double column = (x - lower_.x()) * per_size_;
    const double row = (y - lower_.y()) * per_size_;
    if (!(column >= 0.0 && row >= 0.0 && column < places_->width() && row < places_->height()))
      return cut_;
    const int c = static_cast<int>(column);
    const int r = static_cast<int>(row);
    const float value = cost_[places_->number(c, r) * kHeadings + static_cast<size_t>(binOf(yaw))];
    // A cost that was found but not settled may be more than the least.
    return std::min(value, std::max(0.0F, cut_ - fromStart(c, r)));
  }
  /// Whether the start can be reached from the goal.
  bool reached() const { return reached_; }
  int filled() const { return filled_; }
  size_t bytes() const { return cost_.capacity() * sizeof(float); }

 private:
  struct Front;
  struct Move {
    int offset = 0;   // [squares] from a square to the one before it
    int between = 0;  // a square that is passed; 0 = none
    int between_too = 0;
    int turn = 0;  // [bins] from the heading before to this one
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

  Places* places_ = nullptr;
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
