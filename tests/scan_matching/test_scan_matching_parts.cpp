// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "modules/scan_matching/core/motion_filter.hpp"
#include "modules/scan_matching/core/pose_search.hpp"
#include "modules/scan_matching/core/scan_matcher.hpp"

namespace tread::scan_matching {
namespace {

using Eigen::Vector2d;

/// First intersection of a ray from the body with some walls (segments, p_map), seen from the body.
struct Walls {
  std::vector<std::pair<Vector2d, Vector2d>> segments;

  std::vector<PlanarReturn> seenFrom(const Pose2& from, const Pose2& to, int beams = 541) const {
    std::vector<PlanarReturn> returns;
    const Pose2 step = between(from, to);
    for (int i = 0; i < beams; ++i) {
      const double share = static_cast<double>(i) / (beams - 1);
      const double angle = 1.5 * kPi * (share - 0.5);
      const Pose2 body = from * integrate(twistTo(step, 1.0), share);
      const double range = rangeAlong(body, angle);
      if (range < 15.0)
        returns.push_back({range * Vector2d(std::cos(angle), std::sin(angle)), share});
    }
    return returns;
  }
  std::vector<PlanarReturn> seenFrom(const Pose2& pose) const { return seenFrom(pose, pose); }

 private:
  double rangeAlong(const Pose2& body, double angle) const {
    const Vector2d d(std::cos(body.yaw + angle), std::sin(body.yaw + angle));
    double nearest = 1e9;
    for (const auto& [a, b] : segments) {
      const Vector2d e = b - a;
      const Vector2d r = a - body.position();
      const double det = e.x() * d.y() - e.y() * d.x();
      if (std::abs(det) < 1e-12) continue;
      const double range = (e.x() * r.y() - e.y() * r.x()) / det;
      const double along = (d.x() * r.y() - d.y() * r.x()) / det;
      if (range > 0.0 && along >= 0.0 && along <= 1.0) nearest = std::min(nearest, range);
    }
    return nearest;
  }
};

Walls room() {
  const Vector2d a(-4.0, -3.0), b(5.0, -3.0), c(5.0, 3.5), d(-4.0, 3.5);
  return {{{a, b}, {b, c}, {c, d}, {d, a}, {{1.0, 3.5}, {1.0, 2.0}}}};
}

Walls twoWalls() {
  return {{{{-50.0, -1.5}, {50.0, -1.5}}, {{-50.0, 1.5}, {50.0, 1.5}}}};
}

std::vector<ScanPoint> pointsFrom(const Walls& walls, const Pose2& pose) {
  return scanPoints(walls.seenFrom(pose), Vector2d::Zero(), {}, 0.0, {});
}

Registration registered(const Walls& walls, const Pose2& truth, const Pose2& guess,
                        double guess_std = 0.3) {
  LocalMap map(5, 50.0);
  map.add({}, pointsFrom(walls, {}));
  PosePrior prior{guess, guess_std * guess_std * Eigen::Matrix3d::Identity()};
  return registerScan(pointsFrom(walls, truth), map, guess, prior, Vector2d::Zero(), {});
}

Sweep sweepAt(const Walls& walls, int64_t utime, const Pose2& pose) {
  return {utime, utime, Vector2d::Zero(), walls.seenFrom(pose)};
}

}  // namespace

TEST_CASE("a sweep of a turning body is straightened: its wall lies on one line again") {
  const Walls wall{{{{4.0, -20.0}, {4.0, 20.0}}}};
  const Pose2 end{0.1, 0.05, 0.4};
  const auto returns = wall.seenFrom({}, end);
  const Twist2 twist = twistTo(end, 0.2);
  const Pose2 middle = integrate(twist, 0.1);
  double most = 0.0;
  double bent = 0.0;
  for (const ScanPoint& point : scanPoints(returns, Vector2d::Zero(), twist, 0.2, {}))
    most = std::max(most, std::abs((middle * point.p).x() - 4.0));
  for (const ScanPoint& point : scanPoints(returns, Vector2d::Zero(), {}, 0.2, {}))
    bent = std::max(bent, std::abs((middle * point.p).x() - 4.0));
  CHECK(most < 1e-3);
  CHECK(bent > 0.2);
}

TEST_CASE(
    "points of walls have their normal towards the range finder, single points are left out") {
  const auto points = pointsFrom(room(), {});
  REQUIRE(points.size() > 100);
  int lines = 0;
  for (const ScanPoint& point : points) {
    if (point.shape != Shape::kLine) continue;
    ++lines;
    CHECK(point.normal.dot(point.p) < 0.0);
    CHECK(point.normal.norm() == Approx(1.0));
    CHECK(point.normal_variance < 0.01);
  }
  CHECK(lines > 80);
  const std::vector<PlanarReturn> lonely{{{3.0, 0.0}, 0.1}, {{0.0, 4.0}, 0.5}, {{-5.0, 0.0}, 0.9}};
  CHECK(scanPoints(lonely, Vector2d::Zero(), {}, 0.0, {}).empty());
}

TEST_CASE("a scan finds its place in a room to a centimetre, and says how well") {
  const Pose2 truth{0.15, -0.1, 0.08};
  const Registration found = registered(room(), truth, {});
  CHECK(found.undetermined == 0);
  CHECK(distanceBetween(found.T_map_body, truth) < 0.01);
  CHECK(std::abs(found.T_map_body.yaw - truth.yaw) < 0.003);
  CHECK(found.overlap > 0.9);
  CHECK(found.misfit < 0.05);
  CHECK(found.information(0, 0) > 1.0 / (0.05 * 0.05));
}

TEST_CASE("in a corridor the way along it stays what the prior says") {
  const Registration found = registered(twoWalls(), {0.2, 0.1, 0.02}, {0.05, 0.0, 0.0});
  CHECK(found.undetermined == 1);
  CHECK(found.T_map_body.x == Approx(0.05).margin(0.01));
  CHECK(found.T_map_body.y == Approx(0.1).margin(0.01));
  CHECK(found.T_map_body.yaw == Approx(0.02).margin(0.003));
  CHECK(found.information(0, 0) < 1e-3 * found.information(1, 1));
}

TEST_CASE("a place that is badly known is searched for") {
  LocalMap map(5, 50.0);
  map.add({}, pointsFrom(room(), {}));
  const Pose2 truth{0.9, -0.8, 0.45};
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.36, 0.36, 0.06).asDiagonal();
  const Pose2 found = searchPose(pointsFrom(room(), truth), map, {{}, covariance});
  CHECK(distanceBetween(found, truth) < 0.25);
  CHECK(std::abs(found.yaw - truth.yaw) < 0.06);
}

TEST_CASE("the filter's covariance is that of drives with drawn twists") {
  MotionConfig config;
  config.acceleration = config.yaw_acceleration = 1e-3;
  const Pose2 start{1.0, 2.0, 0.7};
  MotionFilter filter(config, start);
  filter.predict(0.01);
  // A known motion: a pose far from the prediction, so that the twist is learned from it.
  const Pose2 moved = filter.pose() * Pose2{0.004, 0.0, 0.002};
  filter.update(moved, 1e-10 * Eigen::Matrix3d::Identity());
  CHECK(filter.twist().v_x == Approx(0.4).epsilon(0.02));
  CHECK(filter.twist().omega == Approx(0.2).epsilon(0.02));
  const Twist2 twist = filter.twist();
  const Pose2 before = filter.pose();
  const Eigen::Matrix3d of_twist = filter.twistCovariance();
  filter.predict(0.5);
  // Numerical derivative with respect to each part of the twist.
  Eigen::Matrix3d J;
  const double small = 1e-4;
  for (int i = 0; i < 3; ++i) {
    Twist2 other = twist;
    (i == 0 ? other.v_x : i == 1 ? other.v_y : other.omega) += small;
    const Pose2 end = before * integrate(other, 0.5);
    const Pose2 plain = before * integrate(twist, 0.5);
    J.col(i) = Eigen::Vector3d(end.x - plain.x, end.y - plain.y, end.yaw - plain.yaw) / small;
  }
  const Eigen::Matrix3d expected = J * of_twist * J.transpose();
  CHECK((filter.poseCovariance() - expected).norm() < 0.02 * expected.norm() + 1e-6);
}

TEST_CASE("scans that are not newer are refused, after a long pause the map begins anew") {
  ScanMatcher matcher({});
  CHECK(matcher.take(sweepAt(room(), 1'000'000, {})).outcome == MatchOutcome::kFirst);
  CHECK(matcher.take(sweepAt(room(), 1'100'000, {})).outcome == MatchOutcome::kMatched);
  const MatchedPose old = matcher.take(sweepAt(room(), 1'100'000, {}));
  CHECK(old.outcome == MatchOutcome::kNotNewer);
  CHECK_FALSE(old.position_known);
  const MatchedPose later = matcher.take(sweepAt(room(), 5'000'000, {}));
  CHECK(later.outcome == MatchOutcome::kFirst);
  CHECK(later.new_track);
  CHECK_FALSE(matcher.take(sweepAt(room(), 5'100'000, {})).new_track);
}

TEST_CASE("who is carried away loses the pose, then begins a new track where it is put down") {
  ScanMatcher matcher({});
  int64_t t = 1'000'000;
  for (int i = 0; i < 5; ++i) matcher.take(sweepAt(room(), t += 100'000, {}));
  const Walls elsewhere{
      {{{2.0, -9.0}, {9.0, 6.0}}, {{-6.0, -7.0}, {-8.0, 9.0}}, {{-8.0, 9.5}, {9.0, 6.0}}}};
  bool lost = false;
  bool again = false;
  for (int i = 0; i < 30; ++i) {
    const MatchedPose pose = matcher.take(sweepAt(elsewhere, t += 100'000, {}));
    lost = lost || !pose.position_known;
    again = again || (lost && pose.new_track && pose.position_known);
  }
  CHECK(lost);
  CHECK(again);
}

}  // namespace tread::scan_matching
