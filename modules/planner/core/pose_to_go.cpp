// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/pose_to_go.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
constexpr double kBin = 2.0 * kPi / PoseToGo::kHeadings;
/// A pattern that goes less than this per radian of its turn turns on the spot [m/rad].
constexpr double kOnTheSpot = 0.05;
/// Shorter patterns go nowhere [m].
constexpr double kNowhere = 1e-3;

/// Cells that a move along each heading of the first quarter goes, about as long as the next.
constexpr int kSteps[4][2] = {{1, 0}, {2, 1}, {1, 1}, {1, 2}};

struct Step {
  int x;
  int y;
};

Step stepAlong(int heading) {
  const int* step = kSteps[heading % 4];
  switch (heading / 4) {
    case 0:
      return {step[0], step[1]};
    case 1:
      return {-step[1], step[0]};
    case 2:
      return {-step[0], -step[1]};
    default:
      return {step[1], -step[0]};
  }
}

/// The two bounds of the least cost, of a part of the patterns (see PatternTable::leastCosts()).
MotionRates::Rate rateOf(const std::vector<const TablePattern*>& patterns) {
  MotionRates::Rate rate;
  rate.any = !patterns.empty();
  double metres = 0.0;
  double radians = 0.0;
  for (const TablePattern* p : patterns) {
    metres = std::max(metres, p->length / p->cost);
    radians = std::max(radians, std::abs(p->end().pose.yaw) / p->cost);
  }
  rate.by_way = {metres > 0.0 ? 1.0 / metres : 0.0, kNever};
  rate.by_turn = {kNever, radians > 0.0 ? 1.0 / radians : 0.0};
  for (const TablePattern* p : patterns) {
    const double turn = std::abs(p->end().pose.yaw);
    if (turn > 0.0)
      rate.by_way.per_radian =
          std::min(rate.by_way.per_radian, (p->cost - rate.by_way.per_metre * p->length) / turn);
    if (p->length > 0.0)
      rate.by_turn.per_metre =
          std::min(rate.by_turn.per_metre, (p->cost - rate.by_turn.per_radian * turn) / p->length);
  }
  for (double* value : {&rate.by_way.per_radian, &rate.by_turn.per_metre})
    *value = std::isfinite(*value) ? std::max(0.0, *value) : 0.0;
  return rate;
}

}  // namespace

float MotionRates::Rate::cost(double way, double turn) const {
  return static_cast<float>(std::max(by_way.per_metre * way + by_way.per_radian * turn,
                                     by_turn.per_metre * way + by_turn.per_radian * turn));
}

MotionRates motionRates(const PatternTable& patterns) {
  std::vector<const TablePattern*> ahead;
  std::vector<const TablePattern*> back;
  std::vector<const TablePattern*> spot;
  for (const TablePattern& p : patterns.patterns()) {
    const double turn = std::abs(p.end().pose.yaw);
    if (turn > 0.0 && p.length < kOnTheSpot * turn)
      spot.push_back(&p);
    else if (p.length > kNowhere)
      (p.reverses ? back : ahead).push_back(&p);
  }
  return {rateOf(ahead), rateOf(back), rateOf(spot)};
}

/// States waiting, in buckets as wide as the cheapest move: what is taken is final.
struct PoseToGo::Front {
  explicit Front(float width) : per_width(1.0F / width) {}

  void add(size_t state, float cost) {
    const auto bucket = std::max(current, static_cast<size_t>(cost * per_width));
    if (bucket >= buckets.size()) buckets.resize(bucket + 64);
    buckets[bucket].push_back(static_cast<uint32_t>(state));
  }

  std::vector<std::vector<uint32_t>> buckets;
  size_t current = 0;
  float per_width;
};

PoseToGo::PoseToGo(const PassageSource& map, const Goal& goal, const Pose2& T_map_start,
                   const MotionRates& rates, int merge, double radius, double beyond) {
  layOut(map, goal, T_map_start, merge, radius);
  prepareMoves(rates);
  if (!(least_move_ > 0.0F)) {
    cost_.clear();
    return;
  }
  Front front(least_move_);
  seed(goal, front);
  fill(T_map_start, beyond, front);
}

void PoseToGo::layOut(const PassageSource& map, const Goal&, const Pose2&, int merge,
                      double radius) {
  PassageWindow window = *map.bounds();
  const double coarse = map.coarseSize();
  size_ = coarse * merge;
  per_size_ = 1.0 / size_;
  lower_x_ = static_cast<int>(std::floor(static_cast<double>(window.lower_x) / merge));
  lower_y_ = static_cast<int>(std::floor(static_cast<double>(window.lower_y) / merge));
  const int right = window.lower_x + window.width;
  const int top = window.lower_y + window.height;
  width_ = static_cast<int>(std::ceil(static_cast<double>(right) / merge)) - lower_x_;
  height_ = static_cast<int>(std::ceil(static_cast<double>(top) / merge)) - lower_y_;
  stride_ = width_ + 2 * kRim;
  window.room.assign(static_cast<size_t>(window.width) * static_cast<size_t>(window.height), 0.0F);
  window.unknown.assign(window.room.size(), 0);
  map.fill(window);
  const auto cells = static_cast<size_t>(stride_) * static_cast<size_t>(height_ + 2 * kRim);
  passable_.assign(cells, 0);
  for (int y = window.lower_y; y < top; ++y) {
    for (int x = window.lower_x; x < right; ++x) {
      if (!(window.room[window.at(x, y)] >= static_cast<float>(radius))) continue;
      const int column = (x - lower_x_ * merge) / merge;
      const int row = (y - lower_y_ * merge) / merge;
      passable_[cellNumber(column, row)] = 1;
    }
  }
  cost_.assign(cells * kHeadings, kNever);
}

void PoseToGo::prepareMoves(const MotionRates& rates) {
  for (int heading = 0; heading < kHeadings; ++heading) {
    if (rates.forward.any) addMoves(heading, rates.forward, 1);
    if (rates.reverse.any) addMoves(heading, rates.reverse, -1);
    if (!rates.turn.any) continue;
    for (const int turn : {-1, 1}) {
      Move move;
      move.turn = turn;
      move.cost = rates.turn.cost(0.0, kBin);
      moves_[heading].push_back(move);
    }
  }
  least_move_ = kNever;
  for (const auto& moves : moves_)
    for (const Move& move : moves) least_move_ = std::min(least_move_, move.cost);
  if (!std::isfinite(least_move_)) least_move_ = 0.0F;
}

void PoseToGo::addMoves(int heading, const MotionRates::Rate& rate, int sign) {
  const Step step = stepAlong(heading);
  const double way = std::hypot(step.x, step.y) * size_;
  for (const int turn : {0, -1, 1}) {
    Move move;
    move.turn = turn;
    move.cost = rate.cost(way, std::abs(turn) * kBin);
    move.offset = -sign * (step.y * stride_ + step.x);
    const bool is_long = std::abs(step.x) + std::abs(step.y) > 2;
    if (is_long) {
      const bool wide = std::abs(step.x) > std::abs(step.y);
      const int sx = step.x > 0 ? 1 : -1;
      const int sy = step.y > 0 ? 1 : -1;
      move.between = -sign * (wide ? sx : sy * stride_);
      move.between_too = -sign * (sy * stride_ + sx);
    }
    moves_[heading].push_back(move);
  }
}

void PoseToGo::seed(const Goal& goal, Front& front) {
  const Pose2& at = goal.T_map_goal;
  const double reach = goal.position_tolerance + 0.5 * size_;
  const int column = static_cast<int>(std::floor(at.x * per_size_)) - lower_x_;
  const int row = static_cast<int>(std::floor(at.y * per_size_)) - lower_y_;
  const int around = static_cast<int>(std::ceil(reach * per_size_));
  for (int y = std::max(0, row - around); y <= std::min(height_ - 1, row + around); ++y) {
    for (int x = std::max(0, column - around); x <= std::min(width_ - 1, column + around); ++x) {
      const double dx = (lower_x_ + x + 0.5) * size_ - at.x;
      const double dy = (lower_y_ + y + 0.5) * size_ - at.y;
      const size_t cell = cellNumber(x, y);
      const bool own = x == column && y == row;
      if ((!own && std::hypot(dx, dy) > reach) || passable_[cell] == 0) continue;
      for (int heading = 0; heading < kHeadings; ++heading) {
        const double off = std::abs(wrapAngle(heading * kBin - at.yaw));
        if (goal.yaw_tolerance < kPi && off > goal.yaw_tolerance + 0.5 * kBin) continue;
        const size_t state = cell * kHeadings + static_cast<size_t>(heading);
        cost_[state] = 0.0F;
        front.add(state, 0.0F);
      }
    }
  }
}

void PoseToGo::fill(const Pose2& start, double beyond, Front& front) {
  const int column =
      std::clamp(static_cast<int>(std::floor(start.x * per_size_)) - lower_x_, 0, width_ - 1);
  const int row =
      std::clamp(static_cast<int>(std::floor(start.y * per_size_)) - lower_y_, 0, height_ - 1);
  const size_t own = cellNumber(column, row) * kHeadings +
                     static_cast<size_t>(binOf(static_cast<float>(wrapAngle(start.yaw))));
  float stop_at = kNever;
  for (; front.current < front.buckets.size(); ++front.current) {
    const float reached = static_cast<float>(front.current) / front.per_width;
    if (reached > stop_at) break;
    // A move may come back into its own bucket.
    for (size_t i = 0; i < front.buckets[front.current].size(); ++i) {
      const size_t state = front.buckets[front.current][i];
      if (cost_[state] * front.per_width < static_cast<float>(front.current)) continue;
      relax(state, front);
    }
    if (!reached_ && cost_[own] <= reached) {
      reached_ = true;
      stop_at = reached + static_cast<float>(beyond);
    }
  }
  cut_ = reached_ && front.current < front.buckets.size()
             ? static_cast<float>(front.current) / front.per_width
             : kNever;
}

void PoseToGo::relax(size_t state, Front& front) {
  ++filled_;
  const float cost = cost_[state];
  const size_t cell = state / kHeadings;
  const auto heading = static_cast<int>(state % kHeadings);
  for (const Move& move : moves_[heading]) {
    const auto before = static_cast<size_t>(static_cast<int>(cell) + move.offset);
    if (passable_[before] == 0) continue;
    if (move.between != 0 &&
        passable_[static_cast<size_t>(static_cast<int>(cell) + move.between)] == 0 &&
        passable_[static_cast<size_t>(static_cast<int>(cell) + move.between_too)] == 0)
      continue;
    const int turned = (heading - move.turn + kHeadings) % kHeadings;
    const size_t next = before * kHeadings + static_cast<size_t>(turned);
    const float value = cost + move.cost;
    if (value >= cost_[next]) continue;
    cost_[next] = value;
    front.add(next, value);
  }
}

}  // namespace tread::planner
