// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/pattern_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::planner {
namespace {

/// Slower than this counts as standing [m/s, rad/s].
constexpr double kStanding = 0.02;

/// An arc may bulge so much between two poses that are checked [m].
constexpr double kSagitta = 0.0015;

/// How far from the body's origin its outline is, about: what a turn moves [m].
constexpr double kArm = 0.7;

double distanceBetween(const Pose2& a, const Pose2& b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

SweepPose sweepPose(const Pose2& pose, double time) {
  return {pose, std::cos(pose.yaw), std::sin(pose.yaw), time, 0.0};
}

/// A pose between two: the twist that joins them, followed for a part of the way.
Pose2 partOf(const Pose2& from, const Pose2& to, double share) {
  return from * integrate(twistTo(between(from, to), 1.0), share);
}

void addReach(std::vector<SweepPose>& sweep) {
  SweepPose before;
  for (SweepPose& at : sweep) {
    at.reach = before.reach + distanceBetween(before.pose, at.pose) +
               kArm * std::abs(at.pose.yaw - before.pose.yaw);
    before = at;
  }
}

/// The poses of a sweep that a footprint needs, the end last.
std::vector<SweepPose> coverOf(const std::vector<SweepPose>& sweep, SweepStep step) {
  std::vector<SweepPose> cover;
  Pose2 last;
  for (size_t i = 0; i < sweep.size(); ++i) {
    const bool is_end = i + 1 == sweep.size();
    const Pose2& after = sweep[is_end ? i : i + 1].pose;
    const double distance = distanceBetween(last, after);
    const double turn = std::abs(after.yaw - last.yaw);
    const bool next_too_far =
        distance > step.covered || turn > step.turn + 1e-9 || distance * turn > 8.0 * kSagitta;
    if (!is_end && !next_too_far) continue;
    cover.push_back(sweep[i]);
    last = sweep[i].pose;
  }
  return cover;
}

/// Smallest disc around the middle of the positions that holds them all.
void addDisc(TablePattern& entry) {
  Eigen::Vector2d lower(0.0, 0.0), upper(0.0, 0.0);
  for (const SweepPose& at : entry.sweep) {
    lower = lower.cwiseMin(at.pose.position());
    upper = upper.cwiseMax(at.pose.position());
  }
  entry.centre = (lower + upper) / 2.0;
  entry.radius = entry.centre.norm();
  for (const SweepPose& at : entry.sweep)
    entry.radius = std::max(entry.radius, (at.pose.position() - entry.centre).norm());
}

double lengthOf(const std::vector<Pose2>& poses) {
  double length = 0.0;
  Pose2 before;
  for (const Pose2& pose : poses) {
    length += distanceBetween(before, pose);
    before = pose;
  }
  return length;
}

Uncertainty uncertaintyOf(const DefaultSigma& sigma) {
  Uncertainty result;
  result.xx = result.yy = static_cast<float>(sigma.position * sigma.position);
  result.yawyaw = static_cast<float>(sigma.yaw * sigma.yaw);
  return result;
}

TablePattern prepare(const Primitive& primitive, SweepStep step) {
  TablePattern entry;
  entry.number = primitive.id;
  entry.duration = primitive.duration;
  entry.cost = primitive.cost;
  entry.length = lengthOf(primitive.poses);
  entry.reverses = primitive.poses.back().x < -kStanding;
  entry.sweep = sampleSweep(primitive.poses,
                            primitive.duration / static_cast<double>(primitive.poses.size()), step);
  entry.cover = coverOf(entry.sweep, step);
  entry.start_bin = primitive.start_bin;
  entry.cells = primitive.cells;
  addDisc(entry);
  return entry;
}

}  // namespace

std::vector<SweepPose> sampleSweep(const std::vector<Pose2>& trajectory, double period,
                                   SweepStep step) {
  std::vector<SweepPose> sweep;
  Pose2 last;  // the start
  for (size_t i = 0; i < trajectory.size(); ++i) {
    const bool is_end = i + 1 == trajectory.size();
    const Pose2& after = trajectory[is_end ? i : i + 1];
    const bool next_too_far =
        distanceBetween(last, after) > step.distance || std::abs(after.yaw - last.yaw) > step.turn;
    if (!is_end && !next_too_far) continue;
    const Pose2& here = trajectory[i];
    const double steps = std::max(distanceBetween(last, here) / step.distance,
                                  std::abs(here.yaw - last.yaw) / step.turn);
    const int pieces = std::max(1, static_cast<int>(std::ceil(steps - 1e-9)));
    const double last_time = sweep.empty() ? 0.0 : sweep.back().time;
    const double time = period * static_cast<double>(i + 1);
    for (int k = 1; k <= pieces; ++k) {
      const double share = static_cast<double>(k) / pieces;
      const Pose2 pose = k == pieces ? here : partOf(last, here, share);
      sweep.push_back(sweepPose(pose, last_time + share * (time - last_time)));
    }
    last = here;
  }
  addReach(sweep);
  return sweep;
}

PatternTable::PatternTable(PatternSet set, SweepStep step, const DefaultSigma& sigma)
    : set_(std::move(set)), rest_class_(findRestClass()) {
  for (const MotionPattern& pattern : set_->patterns())
    patterns_.push_back(prepare(pattern, step, sigma));
  index(set_->content().classes.size());
  bound();
}

PatternTable::PatternTable(const std::vector<Primitive>& primitives, SweepStep step)
    : rest_class_(0) {
  for (const Primitive& primitive : primitives)
    patterns_.push_back(planner::prepare(primitive, step));
  index(1);
  bound();
}

void PatternTable::index(size_t classes) {
  from_.resize(classes);
  stops_.resize(classes);
  for (const TablePattern& entry : patterns_) {
    from_[static_cast<size_t>(entry.entry)].push_back(&entry);
    if (entry.exit == rest_class_) stops_[static_cast<size_t>(entry.entry)].push_back(&entry);
  }
}

void PatternTable::bound() {
  double most_metres = 0.0;  // per cost, as the next
  double most_radians = 0.0;
  for (const TablePattern& entry : patterns_) {
    const double turn = std::abs(entry.end().pose.yaw);
    best_speed_ = std::max(best_speed_, entry.length / entry.duration);
    best_turn_rate_ = std::max(best_turn_rate_, turn / entry.duration);
    most_metres = std::max(most_metres, entry.length / entry.cost);
    most_radians = std::max(most_radians, turn / entry.cost);
  }
  LeastCost& by_way = least_costs_[0];
  LeastCost& by_turn = least_costs_[1];
  by_way = {most_metres > 0.0 ? 1.0 / most_metres : 0.0, std::numeric_limits<double>::infinity()};
  by_turn = {std::numeric_limits<double>::infinity(),
             most_radians > 0.0 ? 1.0 / most_radians : 0.0};
  for (const TablePattern& entry : patterns_) {
    const double turn = std::abs(entry.end().pose.yaw);
    if (turn > 0.0)
      by_way.per_radian =
          std::min(by_way.per_radian, (entry.cost - by_way.per_metre * entry.length) / turn);
    if (entry.length > 0.0)
      by_turn.per_metre =
          std::min(by_turn.per_metre, (entry.cost - by_turn.per_radian * turn) / entry.length);
  }
  // Rounding can leave a little below nothing; a set that never turns or moves leaves no bound.
  for (double* value : {&by_way.per_radian, &by_turn.per_metre})
    *value = std::isfinite(*value) ? std::max(0.0, *value) : 0.0;
}

TablePattern PatternTable::prepare(const MotionPattern& pattern, SweepStep step,
                                   const DefaultSigma& sigma) const {
  TablePattern entry;
  entry.pattern = &pattern;
  entry.number = pattern.id;
  entry.entry = classIndex(pattern.entry_class);
  entry.exit = classIndex(pattern.exit_class);
  entry.duration = set_->periodSeconds() * static_cast<double>(pattern.commands.size());
  entry.cost = entry.duration;
  entry.length = pattern.pathLength();
  entry.reverses = pattern.end().x < -kStanding;
  entry.sweep = sampleSweep(pattern.trajectory, set_->periodSeconds(), step);
  entry.cover = coverOf(entry.sweep, step);
  entry.uncertainty = uncertaintyOf(pattern.end_covariance, uncertaintyOf(sigma));
  addDisc(entry);
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
  for (size_t i = 0; i < classes.size(); ++i) {
    const Twist2& twist = classes[i].twist;
    if (std::hypot(twist.v_x, twist.v_y) < kStanding && std::abs(twist.omega) < kStanding)
      return static_cast<int>(i);
  }
  return -1;
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
