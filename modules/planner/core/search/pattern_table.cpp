// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/search/pattern_table.hpp"

#include <algorithm>
#include <limits>

#include "common/statistics/statistics.hpp"
#include "modules/planner/core/search/swept_footprint.hpp"

namespace tread::planner {
namespace {

/// Slower counts as standing [m/s, rad/s].
constexpr double kStanding = 0.02;

/// Smallest disc around the middle of the positions that contains them all.
void addDisc(TablePattern& entry) {
  Eigen::Vector2d lower(0.0, 0.0), upper(0.0, 0.0);
  for (const SweptPose& at : entry.swept_poses) {
    lower = lower.cwiseMin(at.pose.position());
    upper = upper.cwiseMax(at.pose.position());
  }
  entry.centre = (lower + upper) / 2.0;
  entry.radius = entry.centre.norm();
  for (const SweptPose& at : entry.swept_poses)
    entry.radius = std::max(entry.radius, (at.pose.position() - entry.centre).norm());
}

Uncertainty uncertaintyOf(const DefaultSigma& sigma) {
  Uncertainty result;
  result.xx = result.yy = static_cast<float>(sigma.position * sigma.position);
  result.yawyaw = static_cast<float>(sigma.yaw * sigma.yaw);
  return result;
}

/// Velocity at the end of a trajectory, in the axes of its end: at least that of its exit class,
/// where the vehicle still accelerates.
Eigen::Vector2d endVelocity(const std::vector<Pose2>& poses, double period,
                            const MotionClass& exit) {
  constexpr double kWindow = 0.15;  // [s]
  const double wanted = exit.standing() ? 1.0 : std::max(1.0, std::round(kWindow / period));
  const size_t steps = std::min(poses.size(), static_cast<size_t>(wanted));
  const Pose2 before = steps < poses.size() ? poses[poses.size() - 1 - steps] : Pose2{};
  const Pose2& end = poses.back();
  // In the body frame halfway: rotated back by the middle heading.
  const Pose2 middle{0.0, 0.0, 0.5 * (before.yaw + end.yaw)};
  const Eigen::Vector2d way = end.position() - before.position();
  const Eigen::Vector2d v =
      between(middle, {way.x(), way.y(), 0.0}).position() / (period * static_cast<double>(steps));
  const Eigen::Vector2d steady(exit.twist.v_x, exit.twist.v_y);
  return v.norm() < steady.norm() ? steady : v;
}

/// Common part of all patterns: their path, and the poses to check along it.
TablePattern swept(const std::vector<Pose2>& poses, double period, const SweepResolution& step) {
  TablePattern entry;
  entry.length = lengthOfPath(poses);
  entry.reverses = poses.back().x < -kStanding;
  entry.swept_poses = sampleSweep(poses, period, step);
  entry.swept_footprint = sweptFootprintOf(entry.swept_poses, poses, period, step);
  addDisc(entry);
  return entry;
}

}  // namespace

std::array<LeastCost, 2> leastCostsOf(const std::vector<const TablePattern*>& patterns) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double most_metres = 0.0;  // per cost, like the next
  double most_radians = 0.0;
  for (const TablePattern* p : patterns) {
    most_metres = std::max(most_metres, p->length / p->cost);
    most_radians = std::max(most_radians, std::abs(p->end().pose.yaw) / p->cost);
  }
  LeastCost by_way{most_metres > 0.0 ? 1.0 / most_metres : 0.0, kNone};
  LeastCost by_turn{kNone, most_radians > 0.0 ? 1.0 / most_radians : 0.0};
  for (const TablePattern* p : patterns) {
    const double turn = std::abs(p->end().pose.yaw);
    if (turn > 0.0)
      by_way.per_radian =
          std::min(by_way.per_radian, (p->cost - by_way.per_metre * p->length) / turn);
    if (p->length > 0.0)
      by_turn.per_metre =
          std::min(by_turn.per_metre, (p->cost - by_turn.per_radian * turn) / p->length);
  }
  // Rounding can give slightly negative values; without turns or motion there is no bound.
  for (double* value : {&by_way.per_radian, &by_turn.per_metre})
    *value = std::isfinite(*value) ? std::max(0.0, *value) : 0.0;
  return {by_way, by_turn};
}

PatternTable::PatternTable(PatternSet set, const SweepResolution& step, const DefaultSigma& sigma,
                           double top_speed)
    : set_(std::move(set)), rest_class_(findRestClass()) {
  for (const MotionPattern& pattern : set_->patterns())
    patterns_.push_back(prepare(pattern, step, sigma));
  index(set_->content().classes.size(), top_speed);
}

PatternTable::PatternTable(const std::vector<Primitive>& primitives, const SweepResolution& step)
    : rest_class_(0) {
  for (const Primitive& primitive : primitives) {
    const double period = primitive.duration / static_cast<double>(primitive.poses.size());
    patterns_.push_back(swept(primitive.poses, period, step));
    patterns_.back().number = primitive.id;
    patterns_.back().duration = primitive.duration;
    patterns_.back().cost = primitive.cost;
  }
  index(1, std::numeric_limits<double>::infinity());
}

bool PatternTable::isTooFast(const TablePattern& pattern, double top_speed) const {
  const bool fast = pattern.length / pattern.duration > top_speed;
  if (!set_) return fast;
  const auto speed = [this](int motion_class) {
    const Twist2& v_body = motionClass(motion_class).twist;
    return std::hypot(v_body.v_x, v_body.v_y);
  };
  if (speed(pattern.exit) > top_speed) return true;
  // A pattern that slows the vehicle down is allowed if the vehicle is already too fast.
  return speed(pattern.entry) <= top_speed && fast;
}

double PatternTable::medianDuration() const {
  std::vector<double> joining;
  std::vector<double> all;
  for (const TablePattern& pattern : patterns_) {
    all.push_back(pattern.duration);
    if (pattern.entry != rest_class_ && pattern.exit != rest_class_)
      joining.push_back(pattern.duration);
  }
  return upperMedian(std::move(joining.empty() ? all : joining));
}

void PatternTable::index(size_t classes, double top_speed) {
  usual_duration_ = medianDuration();
  std::vector<const TablePattern*> all;
  from_.resize(classes);
  stops_.resize(classes);
  for (const TablePattern& entry : patterns_) {
    if (entry.exit == rest_class_) stops_[static_cast<size_t>(entry.entry)].push_back(&entry);
    if (isTooFast(entry, top_speed)) continue;
    from_[static_cast<size_t>(entry.entry)].push_back(&entry);
    const double speed = entry.length / entry.duration;
    if (speed <= top_speed) best_speed_ = std::max(best_speed_, speed);
    all.push_back(&entry);
  }
  least_costs_ = leastCostsOf(all);
}

TablePattern PatternTable::prepare(const MotionPattern& pattern, const SweepResolution& step,
                                   const DefaultSigma& sigma) const {
  TablePattern entry = swept(pattern.trajectory, set_->periodSeconds(), step);
  entry.pattern = &pattern;
  entry.number = pattern.id;
  entry.entry = classIndex(pattern.entry_class);
  entry.exit = classIndex(pattern.exit_class);
  entry.duration = set_->periodSeconds() * static_cast<double>(pattern.commands.size());
  entry.cost = entry.duration;
  entry.v_exit = endVelocity(pattern.trajectory, set_->periodSeconds(), motionClass(entry.exit));
  entry.uncertainty = uncertaintyOf(pattern.end_covariance, uncertaintyOf(sigma));
  return entry;
}

const TablePattern* PatternTable::find(int id) const {
  const auto found = std::find_if(patterns_.begin(), patterns_.end(),
                                  [id](const TablePattern& entry) { return entry.id() == id; });
  return found == patterns_.end() ? nullptr : &*found;
}

int PatternTable::classIndex(const std::string& name) const {
  const auto& classes = set_->content().classes;
  for (size_t i = 0; i < classes.size(); ++i)
    if (classes[i].name == name) return static_cast<int>(i);
  return -1;
}

int PatternTable::findRestClass() const {
  const auto& classes = set_->content().classes;
  const auto rest = std::find_if(classes.begin(), classes.end(),
                                 [](const MotionClass& each) { return each.standing(); });
  return rest == classes.end() ? -1 : static_cast<int>(rest - classes.begin());
}

std::string PatternTable::defect() const {
  if (rest_class_ < 0) return "the pattern set has no class of standing";
  if (from(rest_class_).empty()) return "the pattern set has no pattern that begins at rest";
  for (int i = 0; i < classCount(); ++i) {
    const bool entered = std::any_of(patterns_.begin(), patterns_.end(),
                                     [i](const TablePattern& entry) { return entry.exit == i; });
    if (i != rest_class_ && entered && stopsFrom(i).empty())
      return "the pattern set has no pattern that stops from class " + motionClass(i).name;
  }
  return best_speed_ > 0.0 ? "" : "no pattern of the set moves";
}

}  // namespace tread::planner
