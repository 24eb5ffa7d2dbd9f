// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/map/distance_to_goal.hpp"

#include <array>
#include <utility>

#include "modules/planner/core/map/ground_cost.hpp"

namespace tread::planner {
namespace {

constexpr float kOpenGround = 1e6F;
/// Cells whose lengths differ by less may be settled in any order [m].
constexpr float kBucket = 0.05F;
/// Shortest step from a neighbour, in slowness times cell size: half a diagonal.
constexpr float kLeastStep = 0.707F;
/// Least margin of the area around vehicle and goal, however far apart they are [m].
constexpr double kLeastMargin = 8.0;
/// If the vehicle's own cell is too close to an obstacle, the best cell within this distance counts
/// [m].
constexpr double kNearby = 0.5;

float slownessOf(float clearance, const DistanceFieldConfig& config) {
  if (clearance <= 0.0F || clearance < static_cast<float>(config.inflation))
    return std::numeric_limits<float>::infinity();
  const double tight = (config.wide - static_cast<double>(clearance)) /
                       std::max(1e-3, config.wide - config.inflation);
  return static_cast<float>(1.0 + config.tight_weight * std::clamp(tight, 0.0, 1.0));
}

/// A rectangle around goal and vehicle, with a margin [m].
void chooseArea(const Eigen::Vector2d& p_goal, const Eigen::Vector2d& p_vehicle, double margin,
                const DistanceFieldConfig& config, RimmedCells& cells) {
  const Eigen::Vector2d middle = (p_goal + p_vehicle) / 2.0;
  const Eigen::Vector2d needed = (p_goal - p_vehicle).cwiseAbs() / 2.0;
  const Eigen::Vector2d half = (needed + Eigen::Vector2d::Constant(margin))
                                   .cwiseMin(config.max_area / 2.0)
                                   .cwiseMax(needed + Eigen::Vector2d::Constant(kLeastMargin));
  cells.lower_x = static_cast<int>(std::floor((middle.x() - half.x()) / cells.size));
  cells.lower_y = static_cast<int>(std::floor((middle.y() - half.y()) / cells.size));
  cells.width = static_cast<int>(std::ceil(2.0 * half.x() / cells.size));
  cells.height = static_cast<int>(std::ceil(2.0 * half.y() / cells.size));
}

/// The cells of the whole map if it is bounded, otherwise of an area.
RimmedCells cellsFor(const ClearanceSource& map, const Eigen::Vector2d& p_goal,
                     const Eigen::Vector2d& p_vehicle, double margin,
                     const DistanceFieldConfig& config) {
  RimmedCells cells;
  cells.size = map.coarseSize();
  cells.per_size = 1.0 / cells.size;
  if (const std::optional<ClearanceWindow> bounds = map.bounds()) {
    cells.lower_x = bounds->lower_x;
    cells.lower_y = bounds->lower_y;
    cells.width = bounds->width;
    cells.height = bounds->height;
  } else {
    chooseArea(p_goal, p_vehicle, margin, config, cells);
  }
  cells.stride = cells.width + 2;
  return cells;
}

}  // namespace

/// Cells waiting to be settled, in buckets of nearly equal length.
class MarchFront {
 public:
  void add(size_t cell, float length) {
    const size_t wanted = std::max(current_, static_cast<size_t>(length * (1.0F / kBucket)));
    const size_t bucket = std::min(wanted, current_ + kBuckets - 1) % kBuckets;
    buckets_[bucket].push_back(static_cast<uint32_t>(cell));
    ++waiting_;
  }
  bool empty() const { return waiting_ == 0; }
  const std::vector<uint32_t>& take() {
    while (buckets_[current_ % kBuckets].empty()) ++current_;
    taken_.clear();
    taken_.swap(buckets_[current_ % kBuckets]);
    waiting_ -= taken_.size();
    return taken_;
  }
  /// [m] All shorter lengths were taken.
  float reached() const { return static_cast<float>(current_) * kBucket; }

 private:
  static constexpr size_t kBuckets = 256;  // a power of two, to avoid a division
  std::array<std::vector<uint32_t>, kBuckets> buckets_;
  std::vector<uint32_t> taken_;
  size_t current_ = 0;
  size_t waiting_ = 0;
};

/// One fast marching from the goal over the prepared cells.
class DistanceToGoal::March {
 public:
  explicit March(DistanceToGoal& of)
      : of_(of), cells_(of.cells_), stride_(static_cast<size_t>(of.cells_.stride)) {}

  /// False if no cell of the goal is passable.
  bool seed(const Goal& goal);
  /// Whether there is a path from the vehicle, or the march was interrupted.
  bool run(const Eigen::Vector2d& p_vehicle, float further, const Interruption& interruption);
  bool touchedBorder() const { return touched_border_; }

 private:
  void settle(size_t cell);
  void relax(size_t cell);

  DistanceToGoal& of_;
  const RimmedCells& cells_;
  size_t stride_;
  MarchFront front_;
  bool touched_border_ = false;
};

void DistanceToGoal::compute(const ClearanceSource& map, const Goal& goal,
                             const Eigen::Vector2d& p_vehicle, const std::vector<Detour>& detours,
                             const DistanceFieldConfig& config, const Interruption& interruption) {
  problem_.clear();
  enclosed_ = false;
  const Eigen::Vector2d p_goal = goal.T_map_goal.position();
  if (!((p_goal - p_vehicle).norm() <= config.max_distance)) {
    *this = DistanceToGoal();
    problem_ = "the goal is farther away than " + std::to_string(std::lround(config.max_distance)) +
               " m: add intermediate goals";
    return;
  }
  for (double margin = config.area_margin;; margin *= 2.0) {
    layOut(cellsFor(map, p_goal, p_vehicle, margin, config));
    paint(map, detours, config);
    March march(*this);
    if (!march.seed(goal)) {
      problem_ = "the goal lies on obstacles";
      return;
    }
    if (march.run(p_vehicle, static_cast<float>(config.reach), interruption)) return;
    const double longest = cells_.size * std::max(cells_.width, cells_.height);
    const bool all_seen = !march.touchedBorder() || map.bounds().has_value();
    if (all_seen || longest >= config.max_area - cells_.size) break;
  }
  problem_ = "obstacles enclose the goal or the vehicle";
  enclosed_ = true;
}

void DistanceToGoal::layOut(const RimmedCells& cells) {
  cells_ = cells;
  slowness_.assign(cells.count(), kNoWay);
  unknown_.assign(cells.count(), 1);
  tentative_.assign(cells.count(), kNoWay);
  settled_.assign(cells.count(), kOpen);
  slopes_.resize(cells.count());
  cut_ = 0.0F;
  cut_short_ = false;
  filled_ = 0;
}

void DistanceToGoal::paint(const ClearanceSource& map, const std::vector<Detour>& detours,
                           const DistanceFieldConfig& config) {
  ClearanceWindow window{cells_.lower_x, cells_.lower_y, cells_.width, cells_.height, {}, {}, {}};
  window.clearance.assign(static_cast<size_t>(window.width) * static_cast<size_t>(window.height),
                          kOpenGround);
  window.unknown.assign(window.clearance.size(), 1);
  if (!config.slowness.empty()) window.roughness.assign(window.clearance.size(), kFree);
  map.fill(window);
  if (!config.slowness.empty()) {
    constexpr double kReach = 15.0;  // [m]
    spreadRoughness(window.roughness, window.width, static_cast<int>(kReach / cells_.size));
  }
  size_t from = 0;
  for (int y = 0; y < cells_.height; ++y) {
    for (int x = 0; x < cells_.width; ++x, ++from) {
      const size_t to = cells_.number(x, y);
      slowness_[to] = slownessOf(window.clearance[from], config);
      if (!config.slowness.empty()) slowness_[to] *= config.slowness[window.roughness[from]];
      unknown_[to] = window.unknown[from];
    }
  }
  for (const Detour& detour : detours) {
    for (size_t cell = 0; cell < slowness_.size(); ++cell)
      if ((cells_.centreOf(cell) - detour.p_map).norm() < detour.radius)
        slowness_[cell] *= static_cast<float>(1.0 + config.detour_weight);
  }
}

bool DistanceToGoal::March::seed(const Goal& goal) {
  const double most = cells_.width + cells_.height;
  const int reach =
      static_cast<int>(std::min(std::ceil(goal.position_tolerance / cells_.size), most));
  const Eigen::Vector2d p_goal = goal.T_map_goal.position();
  const int own_x = static_cast<int>(std::floor(p_goal.x() / cells_.size)) - cells_.lower_x;
  const int own_y = static_cast<int>(std::floor(p_goal.y() / cells_.size)) - cells_.lower_y;
  const int last_x = std::min(cells_.width - 1, own_x + reach);
  const int last_y = std::min(cells_.height - 1, own_y + reach);
  for (int y = std::max(0, own_y - reach); y <= last_y; ++y) {
    for (int x = std::max(0, own_x - reach); x <= last_x; ++x) {
      const size_t cell = cells_.number(x, y);
      const bool inside = (cells_.centreOf(cell) - p_goal).norm() <= goal.position_tolerance;
      const bool own = x == own_x && y == own_y;
      if ((!inside && !own) || of_.slowness_[cell] == kNoWay) continue;
      of_.tentative_[cell] = 0.0F;
      front_.add(cell, 0.0F);
    }
  }
  return !front_.empty();
}

bool DistanceToGoal::March::run(const Eigen::Vector2d& p_vehicle, float further,
                                const Interruption& interruption) {
  float stop_at = kNoWay;
  while (!front_.empty()) {
    for (const uint32_t cell : front_.take()) {
      if (of_.settled_[cell] < kOpen) continue;
      settle(cell);
      relax(cell);
    }
    of_.cut_ = front_.reached();
    if (stop_at == kNoWay && std::isfinite(of_.length(p_vehicle))) stop_at = of_.cut_ + further;
    if (of_.cut_ > stop_at || (interruption && interruption())) {
      of_.cut_short_ = true;
      return true;
    }
  }
  return std::isfinite(of_.length(p_vehicle));
}

void DistanceToGoal::March::settle(size_t cell) {
  std::vector<float>& settled = of_.settled_;
  ++of_.filled_;
  const float own = of_.tentative_[cell];
  const float left = settled[cell - 1];
  const float right = settled[cell + 1];
  const float below = settled[cell - stride_];
  const float above = settled[cell + stride_];
  settled[cell] = own;
  const size_t column = cell % stride_;
  const size_t row = cell / stride_;
  touched_border_ = touched_border_ || column == 1 || row == 1 ||
                    column == static_cast<size_t>(cells_.width) ||
                    row == static_cast<size_t>(cells_.height);
  Slope& slope = of_.slopes_[cell];
  slope = Slope{};
  slope.step = of_.slowness_[cell] * static_cast<float>(cells_.size);
  // relax() skips it from now on
  const float slowness = std::exchange(of_.slowness_[cell], kNoWay);
  const float x = std::min(left, right);
  const float y = std::min(below, above);
  const float along_x = x < own ? (left < right ? x - own : own - x) : 0.0F;
  const float along_y = y < own ? (below < above ? y - own : own - y) : 0.0F;
  const float norm = std::sqrt(along_x * along_x + along_y * along_y);
  if (norm > 0.0F) {
    slope.along_x = along_x / norm;
    slope.along_y = along_y / norm;
  }
  float until = kUnknownCap;
  if (std::min(x, y) < own) {
    const size_t next = x < y ? (left < right ? cell - 1 : cell + 1)
                              : (below < above ? cell - stride_ : cell + stride_);
    until = of_.slopes_[next].until_unknown + (own - settled[next]) / slowness;
  }
  slope.until_unknown = of_.unknown_[cell] != 0 ? 0.0F : std::min(until, kUnknownCap);
}

void DistanceToGoal::March::relax(size_t cell) {
  const float* const settled = of_.settled_.data();
  const float* const slownesses = of_.slowness_.data();
  float* const tentative = of_.tentative_.data();
  const size_t stride = stride_;
  const auto size = static_cast<float>(cells_.size);
  for (const size_t next : {cell - 1, cell + 1, cell - stride, cell + stride}) {
    const float slowness = slownesses[next];
    if (slowness == kNoWay) continue;
    const float step = slowness * size;
    const float a = std::min(settled[next - 1], settled[next + 1]);
    const float b = std::min(settled[next - stride], settled[next + stride]);
    const float nearer = std::min(a, b);
    if (nearer + kLeastStep * step >= tentative[next]) continue;
    const float apart = std::min(std::max(a, b) - nearer, step);
    // Upwind solution of |grad| = slowness; one-sided if the two neighbours differ too much.
    const float value = nearer + 0.5F * (apart + std::sqrt(2.0F * step * step - apart * apart));
    if (value >= tentative[next]) continue;
    tentative[next] = value;
    front_.add(next, value);
  }
}

size_t RimmedCells::cellAt(const Eigen::Vector2d& p_map) const {
  const double x = std::clamp(std::floor(p_map.x() / size) - lower_x, 0.0, width - 1.0);
  const double y = std::clamp(std::floor(p_map.y() / size) - lower_y, 0.0, height - 1.0);
  return number(static_cast<int>(x), static_cast<int>(y));
}

Eigen::Vector2d RimmedCells::centreOf(size_t cell) const {
  const auto columns = static_cast<size_t>(stride);
  return {(lower_x + static_cast<double>(cell % columns) - 0.5) * size,
          (lower_y + static_cast<double>(cell / columns) - 0.5) * size};
}

double DistanceToGoal::length(const Eigen::Vector2d& p_map) const {
  if (cells_.empty()) return static_cast<double>(kNoWay);
  const double gx =
      std::clamp(p_map.x() / cells_.size - cells_.lower_x - 0.5, -1.0, double(cells_.width));
  const double gy =
      std::clamp(p_map.y() / cells_.size - cells_.lower_y - 0.5, -1.0, double(cells_.height));
  const int x = std::min(static_cast<int>(std::floor(gx)), cells_.width - 1);
  const int y = std::min(static_cast<int>(std::floor(gy)), cells_.height - 1);
  const double fx = gx - x;
  const double fy = gy - y;
  const double weights[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
  double sum = 0.0;
  double weight = 0.0;
  for (int k = 0; k < 4; ++k) {
    const float value = settled_[cells_.number(x + k % 2, y + k / 2)];
    if (value == kNoWay) continue;
    sum += weights[k] * static_cast<double>(value);
    weight += weights[k];
  }
  if (weight > 0.05) return sum / weight;
  const size_t cell = cells_.cellAt(p_map);
  const bool passable = slowness_[cell] != kNoWay || settled_[cell] < kOpen;
  if (passable && cut_short_) return static_cast<double>(cut_);
  return lengthNearby(p_map);
}

double DistanceToGoal::lengthNearby(const Eigen::Vector2d& p_map) const {
  const int reach = static_cast<int>(std::ceil(kNearby / cells_.size));
  const auto own = static_cast<int>(cells_.cellAt(p_map));
  const int own_x = own % cells_.stride;
  const int own_y = own / cells_.stride;
  double best = static_cast<double>(kNoWay);
  for (int y = std::max(1, own_y - reach); y <= std::min(cells_.height, own_y + reach); ++y) {
    for (int x = std::max(1, own_x - reach); x <= std::min(cells_.width, own_x + reach); ++x) {
      const auto cell = static_cast<size_t>(y * cells_.stride + x);
      // Passable cells that were not computed get the longest computed length.
      const float open = cut_short_ && slowness_[cell] != kNoWay ? cut_ : kNoWay;
      const float way = std::min(settled_[cell], open);
      if (way == kNoWay) continue;
      const double away = (cells_.centreOf(cell) - p_map).norm();
      if (away <= kNearby) best = std::min(best, static_cast<double>(way) + away);
    }
  }
  return best;
}

double DistanceToGoal::untilUnknown(const Eigen::Vector2d& p_map) const {
  if (cells_.empty()) return 0.0;
  size_t cell = cells_.placeOf(p_map.x(), p_map.y()).cell;
  if (!(settled_[cell] < kOpen)) cell = cells_.cellAt(p_map);
  if (settled_[cell] < kOpen) return static_cast<double>(slopes_[cell].until_unknown);
  return unknown_[cell] != 0 ? 0.0 : static_cast<double>(kUnknownCap);
}

Eigen::Vector2d DistanceToGoal::direction(const Eigen::Vector2d& p_map) const {
  if (cells_.empty()) return {0.0, 0.0};
  const size_t cell = cells_.cellAt(p_map);
  if (settled_[cell] == kOpen) return {0.0, 0.0};
  return {static_cast<double>(slopes_[cell].along_x), static_cast<double>(slopes_[cell].along_y)};
}

std::vector<Eigen::Vector2d> DistanceToGoal::descend(const Eigen::Vector2d& p_map, double step,
                                                     int count) const {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d p = p_map;
  while (static_cast<int>(points.size()) < count) {
    const Eigen::Vector2d way = direction(p);
    if (way.squaredNorm() == 0.0) break;
    p += step * way;
    points.push_back(p);
  }
  return points;
}

std::optional<Eigen::Vector2d> DistanceToGoal::nearestWithinReach(
    const Eigen::Vector2d& p_vehicle, const Eigen::Vector2d& p_goal,
    const std::optional<Eigen::Vector2d>& before) const {
  if (cells_.empty()) return std::nullopt;
  const auto stride = static_cast<size_t>(cells_.stride);
  std::vector<uint8_t> seen(slowness_.size(), 0);
  std::vector<size_t> waiting{cells_.cellAt(p_vehicle)};
  seen[waiting.back()] = 1;
  std::optional<Eigen::Vector2d> nearest;
  while (!waiting.empty()) {
    const size_t cell = waiting.back();
    waiting.pop_back();
    // Settled ones are on the goal's side.
    if (slowness_[cell] == kNoWay) continue;
    const Eigen::Vector2d centre = cells_.centreOf(cell);
    if (!nearest || (centre - p_goal).norm() < (*nearest - p_goal).norm()) nearest = centre;
    for (const size_t next : {cell - 1, cell + 1, cell - stride, cell + stride}) {
      if (seen[next] == 0) waiting.push_back(next);
      seen[next] = 1;
    }
  }
  if (!before || !nearest) return nearest;
  const size_t cell = cells_.cellAt(*before);
  const bool still = seen[cell] != 0 && slowness_[cell] != kNoWay;
  const bool as_good = (*before - p_goal).norm() < (*nearest - p_goal).norm() + kMuchNearer;
  return still && as_good ? before : nearest;
}

bool DistanceToGoal::covers(const Eigen::Vector2d& p_map, double reach) const {
  const Eigen::Vector2d lower(cells_.lower_x * cells_.size + reach,
                              cells_.lower_y * cells_.size + reach);
  const Eigen::Vector2d upper((cells_.lower_x + cells_.width) * cells_.size - reach,
                              (cells_.lower_y + cells_.height) * cells_.size - reach);
  return !cells_.empty() && (p_map.array() >= lower.array()).all() &&
         (p_map.array() <= upper.array()).all();
}

}  // namespace tread::planner
