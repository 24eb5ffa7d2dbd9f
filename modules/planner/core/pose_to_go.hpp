// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "modules/planner/core/cost_to_go.hpp"
#include "modules/planner/core/passage_source.hpp"
#include "modules/planner/core/pattern_table.hpp"

namespace tread::planner {

/// What driving and turning cost, as little as any pattern of a set can do it for.
struct MotionRates {
  /// Cost of a way and of a turn made together: the greater of two sums.
  struct Rate {
    LeastCost by_way;
    LeastCost by_turn;
    bool any = false;  ///< whether the set has such patterns at all
    float cost(double way, double turn) const;
  };
  Rate forward;  ///< of patterns that end ahead of their start
  Rate reverse;
  Rate turn;  ///< of patterns that turn on the spot
};

MotionRates motionRates(const PatternTable& patterns);

/// Cost to the goal by place and heading, on a coarse grid: a guide that knows what turns cost.
/** The vehicle is a disc here that drives along its heading, ahead or back, and turns on the way or
 * on the spot, each for the least that the set's patterns do it for, but with no least radius.
 * Dijkstra from the goal over cells and kHeadings headings; filled in until the start is reached,
 * and some further. */
class PoseToGo {
 public:
  static constexpr int kHeadings = 16;

  PoseToGo() = default;
  /// `map` is seen in squares of `merge` x `merge` of its coarse cells; a square is passable if any
  /// of its cells has `radius` [m] of room. `beyond`: cost by which more than the start is filled
  /// in.
  PoseToGo(const PassageSource& map, const Goal& goal, const Pose2& T_map_start,
           const MotionRates& rates, int merge, double radius, double beyond);

  bool empty() const { return cost_.empty(); }
  /// Cost from a pose to the goal; of what was not filled in the least that it can be; infinite
  /// where there is no way.
  float at(double x, double y, float yaw) const {
    const double column = x * per_size_ - lower_x_;
    const double row = y * per_size_ - lower_y_;
    if (!(column >= 0.0 && row >= 0.0 && column < width_ && row < height_)) return cut_;
    const size_t cell = cellNumber(static_cast<int>(column), static_cast<int>(row));
    const float value = cost_[cell * kHeadings + static_cast<size_t>(binOf(yaw))];
    return value < cut_ ? value : cut_;
  }
  /// Whether the start can be reached from the goal at all.
  bool reached() const { return reached_; }
  int filled() const { return filled_; }
  size_t bytes() const { return cost_.capacity() * sizeof(float); }

 private:
  struct Front;
  struct Move {
    int offset = 0;   // [cells] from a cell to the one before it
    int between = 0;  // a cell that is passed; 0 = none
    int between_too = 0;
    int turn = 0;  // [bins] from the heading before to this one
    float cost = 0.0F;
  };

  static int binOf(float yaw) {
    const float turns = yaw * static_cast<float>(kHeadings / (2.0 * kPi)) + kHeadings + 0.5F;
    return static_cast<int>(turns) % kHeadings;
  }
  size_t cellNumber(int x, int y) const {
    return static_cast<size_t>(y + kRim) * static_cast<size_t>(stride_) +
           static_cast<size_t>(x + kRim);
  }
  void layOut(const PassageSource& map, const Goal& goal, const Pose2& T_map_start, int merge,
              double radius);
  void prepareMoves(const MotionRates& rates);
  void addMoves(int heading, const MotionRates::Rate& rate, int sign);
  void seed(const Goal& goal, Front& front);
  void fill(const Pose2& T_map_start, double beyond, Front& front);
  void relax(size_t state, Front& front);

  static constexpr int kRim = 2;  // a move passes two cells at most

  double size_ = 0.3;
  double per_size_ = 1.0;
  int lower_x_ = 0;
  int lower_y_ = 0;
  int width_ = 0;
  int height_ = 0;
  int stride_ = 0;
  std::vector<uint8_t> passable_;
  std::vector<float> cost_;  // by cell and heading
  std::vector<Move> moves_[kHeadings];
  float cut_ = std::numeric_limits<float>::infinity();
  float least_move_ = 0.0F;
  bool reached_ = false;
  int filled_ = 0;
};

}  // namespace tread::planner
