// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/map/pose_to_go.hpp"

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
  rate.turns = radians > 0.0;
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
  std::vector<const TablePattern*> along[PoseToGo::kHeadings];
  std::vector<const TablePattern*> spot;
  for (const TablePattern& p : patterns.patterns()) {
    const Pose2& end = p.end().pose;
    if (end.yaw != 0.0 && p.length < kOnTheSpot * std::abs(end.yaw)) {
      spot.push_back(&p);
      continue;
    }
    if (p.length < kNowhere) continue;
    // An arc's chord lies half its turn off the heading at its start.
    const double direction = std::atan2(end.y, end.x) - end.yaw / 2.0;
    const auto bin = static_cast<int>(std::lround(direction / kBin));
    along[(bin % PoseToGo::kHeadings + PoseToGo::kHeadings) % PoseToGo::kHeadings].push_back(&p);
  }
  MotionRates rates;
  for (size_t i = 0; i < PoseToGo::kHeadings; ++i) rates.along[i] = rateOf(along[i]);
  rates.turn = rateOf(spot);
  return rates;
}

/// States waiting, by cost and what is left to the start at least, in buckets as wide as the
/// cheapest move.
struct PoseToGo::Front {
  explicit Front(float width) : per_width(1.0F / width) {}

  struct Entry {
    uint32_t state;
    float cost;
  };

  void add(size_t state, float cost, float from_start) {
    const auto bucket = std::max(current, static_cast<size_t>((cost + from_start) * per_width));
    if (bucket >= buckets.size()) buckets.resize(bucket + 64);
    buckets[bucket].push_back({static_cast<uint32_t>(state), cost});
  }

  std::vector<std::vector<Entry>> buckets;
  size_t current = 0;
  float per_width;
};

PoseToGo::PoseToGo(Places& places, const Goal& goal, const Pose2& T_map_start,
                   const MotionRates& rates, double beyond, const Interruption& interruption)
    : places_(&places), per_size_(1.0 / places.size()), lower_(places.lower()) {
  prepareMoves(rates);
  if (!(least_move_ > 0.0F) || places.count() == 0) return;
  start_column_ = std::clamp(places.column(T_map_start.x), 0, places.width() - 1);
  start_row_ = std::clamp(places.row(T_map_start.y), 0, places.height() - 1);
  cost_.assign(places.count() * kHeadings, kNever);
  Front front(least_move_);
  seed(goal, front);
  fill(T_map_start, beyond, front, interruption);
}

void PoseToGo::prepareMoves(const MotionRates& rates) {
  for (int heading = 0; heading < kHeadings; ++heading) {
    for (int direction = 0; direction < kHeadings; ++direction)
      if (rates.along[direction].any) addMoves(heading, direction, rates.along[direction]);
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
  double metre = kNever;
  for (const MotionRates::Rate& rate : rates.along)
    if (rate.any) metre = std::min(metre, rate.by_way.per_metre);
  square_cost_ = std::isfinite(metre) ? static_cast<float>(metre * places_->size()) : 0.0F;
  if (!std::isfinite(least_move_)) least_move_ = 0.0F;
}

void PoseToGo::addMoves(int heading, int direction, const MotionRates::Rate& rate) {
  const Step step = stepAlong((heading + direction) % kHeadings);
  const double way = std::hypot(step.x, step.y) * places_->size();
  for (const int turn : {0, -1, 1}) {
    if (turn != 0 && !rate.turns) continue;
    Move move;
    move.turn = turn;
    move.cost = rate.cost(way, std::abs(turn) * kBin);
    move.offset = -(step.y * places_->stride() + step.x);
    const bool is_long = std::abs(step.x) + std::abs(step.y) > 2;
    if (is_long) {
      const bool wide = std::abs(step.x) > std::abs(step.y);
      const int sx = step.x > 0 ? 1 : -1;
      const int sy = step.y > 0 ? 1 : -1;
      move.between = -(wide ? sx : sy * places_->stride());
      move.between_too = -(sy * places_->stride() + sx);
    }
    moves_[heading].push_back(move);
  }
}

void PoseToGo::seed(const Goal& goal, Front& front) {
  const Pose2& at = goal.T_map_goal;
  const double reach = goal.position_tolerance;
  const int column = places_->column(at.x);
  const int row = places_->row(at.y);
  const double most = places_->width() + places_->height();
  const int around = static_cast<int>(std::min(std::ceil(reach * per_size_), most));
  for (int y = std::max(0, row - around); y <= std::min(places_->height() - 1, row + around); ++y) {
    for (int x = std::max(0, column - around); x <= std::min(places_->width() - 1, column + around);
         ++x) {
      const bool own = x == column && y == row;
      if (!own && (places_->centre(x, y) - at.position()).norm() > reach) continue;
      const size_t square = places_->number(x, y);
      for (int heading = 0; heading < kHeadings; ++heading) {
        const double off = std::abs(wrapAngle(heading * kBin - at.yaw));
        if (off > std::max(goal.yaw_tolerance, 0.5 * kBin)) continue;
        if (!own && !places_->isFree(square, heading)) continue;
        const size_t state = square * kHeadings + static_cast<size_t>(heading);
        cost_[state] = 0.0F;
        front.add(state, 0.0F, fromStart(square));
      }
    }
  }
}

void PoseToGo::fill(const Pose2& start, double beyond, Front& front,
                    const Interruption& interruption) {
  const size_t own = places_->number(start_column_, start_row_) * kHeadings +
                     static_cast<size_t>(binOf(static_cast<float>(wrapAngle(start.yaw))));
  start_ = own;
  float stop_at = kNever;
  for (; front.current < front.buckets.size(); ++front.current) {
    const float now = static_cast<float>(front.current) / front.per_width;
    if (now > stop_at) break;
    if (interruption && interruption()) {
      if (!reached_) return;
      break;
    }
    // A move may come back into its own bucket.
    for (size_t i = 0; i < front.buckets[front.current].size(); ++i) {
      const Front::Entry entry = front.buckets[front.current][i];
      if (cost_[entry.state] == entry.cost) relax(entry.state, front);
    }
    if (reached_ || cost_[own] > now) continue;
    reached_ = true;
    stop_at = now * static_cast<float>(1.0 + beyond);
  }
  if (reached_ && front.current < front.buckets.size())
    cut_ = static_cast<float>(front.current) / front.per_width;
}

float PoseToGo::fromStart(size_t square) const {
  const auto stride = static_cast<size_t>(places_->stride());
  return fromStart(static_cast<int>(square % stride) - Places::kRim,
                   static_cast<int>(square / stride) - Places::kRim);
}

void PoseToGo::relax(size_t state, Front& front) {
  ++filled_;
  const float cost = cost_[state];
  const auto square = static_cast<int>(state / kHeadings);
  const auto heading = static_cast<int>(state % kHeadings);
  for (const Move& move : moves_[heading]) {
    const auto before = static_cast<size_t>(square + move.offset);
    const int turned = (heading - move.turn + kHeadings) % kHeadings;
    const size_t next = before * kHeadings + static_cast<size_t>(turned);
    const float value = cost + move.cost;
    if (value >= cost_[next]) continue;
    if (move.between != 0 && !places_->passable(static_cast<size_t>(square + move.between)) &&
        !places_->passable(static_cast<size_t>(square + move.between_too)))
      continue;
    // The vehicle stands at the start, whatever it is like there.
    if (next != start_ && !places_->isFree(before, turned)) continue;
    cost_[next] = value;
    front.add(next, value, fromStart(before));
  }
}

}  // namespace tread::planner
