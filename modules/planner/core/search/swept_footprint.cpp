// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "modules/planner/core/search/swept_footprint.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tread::planner {
namespace {

/// Largest sagitta of an arc between two checked poses [m].
constexpr double kSagitta = 0.0015;

/// Weight of a radian of turn in the reach [m/rad].
constexpr double kReachOfTurn = 0.7;

/// A vehicle's consecutive poses overlap by more than half of its length [1].
constexpr double kLengthShare = 0.45;

/// Smaller swings of a corner do not justify more poses [m].
constexpr double kSwing = 0.005;

/// Length of a corner's path per disc, about [m].
constexpr double kDisc = 0.25;

/// Number of parts of a path for computing the swing of its corners.
constexpr int kParts = 8;

SweptPose sweptPose(const Pose2& pose, double time) {
  return {pose, std::cos(pose.yaw), std::sin(pose.yaw), time, 0.0};
}

/// A pose between two: a part of the twist that joins them.
Pose2 partOf(const Pose2& from, const Pose2& to, double share) {
  return from * integrate(twistTo(between(from, to), 1.0), share);
}

void addReach(std::vector<SweptPose>& sweep) {
  SweptPose before;
  for (SweptPose& at : sweep) {
    at.reach = before.reach + distanceBetween(before.pose, at.pose) +
               kReachOfTurn * std::abs(at.pose.yaw - before.pose.yaw);
    before = at;
  }
}

using Points = std::array<Eigen::Vector2d, kParts + 1>;
using Way = std::array<SweptPose, kParts + 1>;

Eigen::Vector2d pointOf(const SweptPose& body, const Eigen::Vector2d& p_body) {
  return {body.pose.x + body.cos_yaw * p_body.x() - body.sin_yaw * p_body.y(),
          body.pose.y + body.sin_yaw * p_body.x() + body.cos_yaw * p_body.y()};
}

/// Point of an outline at a pose that is closest to another point.
Eigen::Vector2d nearestOn(const SweptPose& body, const FootprintSize& outline,
                          const Eigen::Vector2d& p) {
  const double dx = p.x() - body.pose.x;
  const double dy = p.y() - body.pose.y;
  return pointOf(
      body,
      {std::clamp(body.cos_yaw * dx + body.sin_yaw * dy, -outline.rear, outline.front),
       std::clamp(body.cos_yaw * dy - body.sin_yaw * dx, -outline.half_width, outline.half_width)});
}

/// Poses that divide a path into equal times, both ends included.
Way divided(const SweptPose& from, const SweptPose& to, const std::vector<Pose2>& trajectory,
            double period) {
  Way way;
  way.front() = from;
  way.back() = to;
  for (size_t k = 1; k < kParts; ++k) {
    const double time = from.time + static_cast<double>(k) / kParts * (to.time - from.time);
    way[k] = sweptPose(poseAlong(trajectory, period, time), time);
  }
  return way;
}

/// A corner's path, and the nearest points of the outlines at both ends.
struct CornerPath {
  CornerPath(const Way& way, const FootprintSize& outline, const Eigen::Vector2d& p_corner) {
    double to_last = 0.0;  // from the part's beginning
    for (size_t k = 0; k <= kParts; ++k) {
      at[k] = pointOf(way[k], p_corner);
      on_first[k] = nearestOn(way.front(), outline, at[k]);
      on_last[k] = nearestOn(way.back(), outline, at[k]);
      // It leaves the first outline and approaches the last, also within a part.
      const double from_first = (at[k] - on_first[k]).norm();
      if (k > 0) swing = std::max(swing, std::min(from_first, to_last));
      to_last = (at[k] - on_last[k]).norm();
      most_first = std::max(most_first, from_first);
      most_last = std::max(most_last, to_last);
    }
  }

  Points at;
  Points on_first;
  Points on_last;
  double most_first = 0.0;  // [m] from the first outline
  double most_last = 0.0;
  double swing = 0.0;  // [m] out of both, upper bound
};

/// The ground that a corner passes over outside of both outlines is between its path and either
/// outline.
void addDiscs(const CornerPath& path, const SweptPose& middle, const Eigen::Vector2d& p_corner,
              double turn, int number, SweptFootprint& cover) {
  const Points& side = path.most_first < path.most_last ? path.on_first : path.on_last;
  const double length = (path.at.back() - path.at.front()).norm();
  const int count = std::clamp(static_cast<int>(std::ceil(length / kDisc)), 1, kParts);
  const Eigen::Vector2d sign(p_corner.x() < 0.0 ? -1.0 : 1.0, p_corner.y() < 0.0 ? -1.0 : 1.0);
  const Eigen::Vector2d out = pointOf(middle, sign) - middle.pose.position();
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<size_t>(kParts * i / count);
    const auto last = static_cast<size_t>((kParts * (i + 1) + count - 1) / count);
    Eigen::Vector2d lower = path.at[first], upper = lower;
    for (size_t k = first; k <= last; ++k) {
      lower = lower.cwiseMin(path.at[k]).cwiseMin(side[k]);
      upper = upper.cwiseMax(path.at[k]).cwiseMax(side[k]);
    }
    const Eigen::Vector2d centre = (lower + upper) / 2.0;
    double radius = 0.0;
    for (size_t k = first; k <= last; ++k)
      radius = std::max({radius, (path.at[k] - centre).norm(), (side[k] - centre).norm()});
    CornerDisc disc;
    disc.x = static_cast<float>(centre.x());
    disc.y = static_cast<float>(centre.y());
    disc.out_x = static_cast<float>(out.x());
    disc.out_y = static_cast<float>(out.y());
    disc.radius = static_cast<float>(radius + kSagitta);
    disc.spread = static_cast<float>(std::abs(turn));
    disc.way = number;
    cover.discs.push_back(disc);
  }
}

void addBetween(const SweptPose& from, const SweptPose& to, double swing,
                const std::vector<Pose2>& trajectory, double period, SweptFootprint& cover) {
  const auto pieces = static_cast<size_t>(std::ceil(swing / kSwing));
  for (size_t k = 1; k < pieces; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(pieces);
    const double time = from.time + share * (to.time - from.time);
    cover.between.push_back(sweptPose(poseAlong(trajectory, period, time), time));
  }
}

void addWays(SweptFootprint& cover, const std::vector<Pose2>& trajectory, double period,
             const FootprintSize& outline) {
  SweptPose before;
  int number = 0;
  for (CheckedPose& pose : cover.poses) {
    pose.first_between = cover.between.size();
    const Way way = divided(before, pose.at, trajectory, period);
    double swing = 0.0;
    for (const double x : {outline.front, -outline.rear}) {
      for (const double y : {outline.half_width, -outline.half_width}) {
        const CornerPath path(way, outline, {x, y});
        if (path.swing <= kSwing) continue;
        swing = std::max(swing, path.swing);
        addDiscs(path, way[kParts / 2], {x, y}, pose.at.pose.yaw - before.pose.yaw, number, cover);
      }
    }
    addBetween(before, pose.at, swing, trajectory, period, cover);
    pose.between_count = cover.between.size() - pose.first_between;
    before = pose.at;
    ++number;
  }
}

}  // namespace

SweepResolution resolutionFor(const FootprintSize& size, double margin, SweepResolution step) {
  const double most = kLengthShare * size.length();
  step.distance = std::min(step.distance, most);
  step.covered = std::min(step.covered, most);
  step.outline = size.widened(margin);
  return step;
}

SweptFootprint sweptFootprintOf(const std::vector<SweptPose>& sweep,
                                const std::vector<Pose2>& trajectory, double period,
                                const SweepResolution& step) {
  SweptFootprint cover;
  cover.front = step.outline.front;
  Pose2 last;
  for (size_t i = 0; i < sweep.size(); ++i) {
    const bool is_end = i + 1 == sweep.size();
    const Pose2& after = sweep[is_end ? i : i + 1].pose;
    const double distance = distanceBetween(last, after);
    const double turn = std::abs(after.yaw - last.yaw);
    const bool next_too_far =
        distance > step.covered || turn > step.turn + 1e-9 || distance * turn > 8.0 * kSagitta;
    if (!is_end && !next_too_far) continue;
    cover.poses.push_back({sweep[i], 0, 0});
    last = sweep[i].pose;
  }
  addWays(cover, trajectory, period, step.outline);
  return cover;
}

std::vector<SweptPose> sampleSweep(const std::vector<Pose2>& trajectory, double period,
                                   const SweepResolution& step) {
  std::vector<SweptPose> sweep;
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
      sweep.push_back(sweptPose(pose, last_time + share * (time - last_time)));
    }
    last = here;
  }
  addReach(sweep);
  return sweep;
}

Pose2 poseAlong(const std::vector<Pose2>& trajectory, double period, double time) {
  const auto size = static_cast<double>(trajectory.size());
  const double steps = period > 0.0 ? std::clamp(time / period, 0.0, size) : size;
  const auto whole = static_cast<size_t>(steps);
  const Pose2 before = whole == 0 ? Pose2{} : trajectory[whole - 1];
  if (whole == trajectory.size()) return before;
  const Twist2 twist = twistTo(between(before, trajectory[whole]), 1.0);
  return before * integrate(twist, steps - static_cast<double>(whole));
}

}  // namespace tread::planner
