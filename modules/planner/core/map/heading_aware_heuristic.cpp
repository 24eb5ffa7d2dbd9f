// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/map/heading_aware_heuristic.hpp"

namespace tread::planner {
namespace {

constexpr float kUnreachable = std::numeric_limits<float>::infinity();
constexpr double kBin = 2.0 * kPi / HeadingAwareHeuristic::kHeadings;
/// A pattern with a shorter path per radian turns on the spot [m/rad].
constexpr double kOnTheSpot = 0.05;
/// Shorter patterns count as no motion [m].
constexpr double kNowhere = 1e-3;
/// Side of a square as a share of the radius of the disc inside the footprint.
constexpr double kSizeShare = 0.9;
/// A cell's corner may have this much more clearance than its centre, in cells.
constexpr double kCorner = 0.71;

/// Cell steps of a move along each heading of the first quadrant, of similar length.
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

MotionRates::Rate rateOf(const std::vector<const TablePattern*>& patterns) {
  const std::array<LeastCost, 2> least = leastCostsOf(patterns);
  const bool turns = std::any_of(patterns.begin(), patterns.end(),
                                 [](const TablePattern* p) { return p->end().pose.yaw != 0.0; });
  return {least[0], least[1], !patterns.empty(), turns};
}

}  // namespace

FreeConfigurations::FreeConfigurations(const CollisionChecker& collision_checker, double radius,
                                       double grown)
    : checker_(collision_checker) {
  const Grid& grid = collision_checker.grid();
  const double cell = grid.cellSize();
  const int side = std::max(1, static_cast<int>(kSizeShare * (radius + grown) / cell));
  size_ = cell * side;
  lower_ = cell * Eigen::Vector2d(grid.lower().x, grid.lower().y);
  width_ = (grid.width() + side - 1) / side;
  height_ = (grid.height() + side - 1) / side;
  const size_t squares = static_cast<size_t>(stride()) * static_cast<size_t>(height_ + 2 * kRim);
  best_.resize(squares);
  headings_.assign(squares, Headings::kNone);
  asked_.assign(squares, 0);
  free_.assign(squares, 0);
  std::vector<float> clearance(squares, 0.0F);
  for (int y = 0; y < grid.height(); ++y) {
    const float* row = collision_checker.field().row(y);
    for (int x = 0; x < grid.width(); ++x) {
      const size_t square = number(x / side, y / side);
      if (row[x] <= clearance[square]) continue;
      clearance[square] = row[x];
      best_[square] = {grid.lower().x + x, grid.lower().y + y};
    }
  }
  const auto whole = static_cast<float>(collision_checker.circumscribedRadius());
  const auto least = static_cast<float>(radius - kCorner * cell);
  for (size_t i = 0; i < squares; ++i)
    if (clearance[i] > 0.0F && clearance[i] >= least)
      headings_[i] = clearance[i] >= whole ? Headings::kAll : Headings::kSome;
}

void FreeConfigurations::ask(size_t square, int heading) {
  const double yaw = heading * kBin;
  const Eigen::Vector2d p_map = checker_.grid().centre(best_[square]);
  const TurnedPose pose{p_map.x(), p_map.y(), std::cos(yaw), std::sin(yaw)};
  const auto bit = static_cast<uint16_t>(1U << static_cast<unsigned>(heading));
  asked_[square] = static_cast<uint16_t>(asked_[square] | bit);
  if (checker_.isFree(pose, CollisionChecker::kBare))
    free_[square] = static_cast<uint16_t>(free_[square] | bit);
}

float MotionRates::Rate::cost(double way, double turn) const {
  return static_cast<float>(std::max(by_way.per_metre * way + by_way.per_radian * turn,
                                     by_turn.per_metre * way + by_turn.per_radian * turn));
}

MotionRates motionRates(const PatternTable& patterns) {
  std::vector<const TablePattern*> along[HeadingAwareHeuristic::kHeadings];
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
    along[(bin % HeadingAwareHeuristic::kHeadings + HeadingAwareHeuristic::kHeadings) %
          HeadingAwareHeuristic::kHeadings]
        .push_back(&p);
  }
  MotionRates rates;
  for (size_t i = 0; i < HeadingAwareHeuristic::kHeadings; ++i) rates.along[i] = rateOf(along[i]);
  rates.turn = rateOf(spot);
  return rates;
}

/// States to be expanded, by cost plus the least remaining cost to the start, in buckets as wide as
/// the cheapest move.
struct HeadingAwareHeuristic::Front {
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

HeadingAwareHeuristic::HeadingAwareHeuristic(FreeConfigurations& configurations, const Goal& goal,
                                             const Pose2& T_map_start, const MotionRates& rates,
                                             double beyond, const Interruption& interruption)
    : configurations_(&configurations),
      per_size_(1.0 / configurations.size()),
      lower_(configurations.lower()) {
  prepareMoves(rates);
  if (!(least_move_ > 0.0F) || configurations.count() == 0) return;
  start_column_ = std::clamp(configurations.column(T_map_start.x), 0, configurations.width() - 1);
  start_row_ = std::clamp(configurations.row(T_map_start.y), 0, configurations.height() - 1);
  cost_.assign(configurations.count() * kHeadings, kUnreachable);
  Front front(least_move_);
  seed(goal, front);
  fill(T_map_start, beyond, front, interruption);
}

void HeadingAwareHeuristic::prepareMoves(const MotionRates& rates) {
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
  least_move_ = kUnreachable;
  for (const auto& moves : moves_)
    for (const Move& move : moves) least_move_ = std::min(least_move_, move.cost);
  double metre = kUnreachable;
  for (const MotionRates::Rate& rate : rates.along)
    if (rate.any) metre = std::min(metre, rate.by_way.per_metre);
  square_cost_ = std::isfinite(metre) ? static_cast<float>(metre * configurations_->size()) : 0.0F;
  if (!std::isfinite(least_move_)) least_move_ = 0.0F;
}

void HeadingAwareHeuristic::addMoves(int heading, int direction, const MotionRates::Rate& rate) {
  const Step step = stepAlong((heading + direction) % kHeadings);
  const double way = std::hypot(step.x, step.y) * configurations_->size();
  for (const int turn : {0, -1, 1}) {
    if (turn != 0 && !rate.turns) continue;
    Move move;
    move.turn = turn;
    move.cost = rate.cost(way, std::abs(turn) * kBin);
    move.offset = -(step.y * configurations_->stride() + step.x);
    const bool is_long = std::abs(step.x) + std::abs(step.y) > 2;
    if (is_long) {
      const bool wide = std::abs(step.x) > std::abs(step.y);
      const int sx = step.x > 0 ? 1 : -1;
      const int sy = step.y > 0 ? 1 : -1;
      move.between = -(wide ? sx : sy * configurations_->stride());
      move.between_too = -(sy * configurations_->stride() + sx);
    }
    moves_[heading].push_back(move);
  }
}

void HeadingAwareHeuristic::seed(const Goal& goal, Front& front) {
  const Pose2& at = goal.T_map_goal;
  const double reach = goal.position_tolerance;
  const int column = configurations_->column(at.x);
  const int row = configurations_->row(at.y);
  const double most = configurations_->width() + configurations_->height();
  const int around = static_cast<int>(std::min(std::ceil(reach * per_size_), most));
  for (int y = std::max(0, row - around);
       y <= std::min(configurations_->height() - 1, row + around); ++y) {
    for (int x = std::max(0, column - around);
         x <= std::min(configurations_->width() - 1, column + around); ++x) {
      const bool own = x == column && y == row;
      if (!own && (configurations_->centre(x, y) - at.position()).norm() > reach) continue;
      const size_t square = configurations_->number(x, y);
      for (int heading = 0; heading < kHeadings; ++heading) {
        const double off = std::abs(wrapAngle(heading * kBin - at.yaw));
        if (off > std::max(goal.yaw_tolerance, 0.5 * kBin)) continue;
        if (!own && !configurations_->isFree(square, heading)) continue;
        const size_t state = square * kHeadings + static_cast<size_t>(heading);
        cost_[state] = 0.0F;
        front.add(state, 0.0F, fromStart(square));
      }
    }
  }
}

void HeadingAwareHeuristic::fill(const Pose2& start, double beyond, Front& front,
                                 const Interruption& interruption) {
  const size_t own = configurations_->number(start_column_, start_row_) * kHeadings +
                     static_cast<size_t>(binOf(static_cast<float>(wrapAngle(start.yaw))));
  start_ = own;
  float stop_at = kUnreachable;
  for (; front.current < front.buckets.size(); ++front.current) {
    const float now = static_cast<float>(front.current) / front.per_width;
    if (now > stop_at) break;
    if (interruption && interruption()) {
      if (!reached_) return;
      break;
    }
    // A move may end in its own bucket.
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

float HeadingAwareHeuristic::fromStart(size_t square) const {
  const auto stride = static_cast<size_t>(configurations_->stride());
  return fromStart(static_cast<int>(square % stride) - FreeConfigurations::kRim,
                   static_cast<int>(square / stride) - FreeConfigurations::kRim);
}

void HeadingAwareHeuristic::relax(size_t state, Front& front) {
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
    if (move.between != 0 &&
        !configurations_->passable(static_cast<size_t>(square + move.between)) &&
        !configurations_->passable(static_cast<size_t>(square + move.between_too)))
      continue;
    // The vehicle stands at the start, whether or not it is free.
    if (next != start_ && !configurations_->isFree(before, turned)) continue;
    cost_[next] = value;
    front.add(next, value, fromStart(before));
  }
}

}  // namespace tread::planner
