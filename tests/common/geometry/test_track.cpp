// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <limits>

#include <catch2/catch.hpp>

#include "common/geometry/track.hpp"
#include "tests/helpers.hpp"

namespace tread {
namespace {

constexpr int64_t kSpan = 60'000'000;
constexpr int64_t kStep = 20'000;  // [us] between poses: 50 Hz
constexpr int64_t kAnyGap = std::numeric_limits<int64_t>::max();
using tread::testing::kNan;

/// A track of steady motion from the origin, with yaw wrapped as by an INS.
PoseTrack trackOf(const Twist2& twist, int64_t duration) {
  PoseTrack track(kSpan);
  for (int64_t utime = 0; utime <= duration; utime += kStep) {
    Pose2 pose = integrate(twist, static_cast<double>(utime) * 1e-6);
    pose.yaw = wrapAngle(pose.yaw);
    REQUIRE(track.push(utime, pose));
  }
  return track;
}

}  // namespace

TEST_CASE("between poses of a steady motion the track is exact") {
  const Twist2 twist{1.2, 0.1, 0.8};
  const PoseTrack track = trackOf(twist, 2'000'000);
  for (int64_t utime = 0; utime <= 2'000'000; utime += 1'777) {
    const auto pose = track.at(utime, kStep);
    REQUIRE(pose);
    const Pose2 expected = integrate(twist, static_cast<double>(utime) * 1e-6);
    CHECK(pose->x == Approx(expected.x).margin(1e-9));
    CHECK(pose->y == Approx(expected.y).margin(1e-9));
    CHECK(pose->yaw == Approx(expected.yaw).margin(1e-9));
  }
}

TEST_CASE("yaw goes on over full turns, both ways, though the INS wraps it") {
  for (const double omega : {2.0, -2.0}) {
    const PoseTrack track = trackOf({0.5, 0.0, omega}, 10'000'000);
    CHECK(track.at(10'000'000, kStep)->yaw == Approx(10.0 * omega));
    CHECK(track.at(4'990'000, kStep)->yaw == Approx(4.99 * omega));
  }
}

TEST_CASE("the track is never extrapolated") {
  const PoseTrack track = trackOf({1.0, 0.0, 0.0}, 100'000);
  CHECK(track.at(0, kStep));
  CHECK(track.at(100'000, kStep));
  CHECK_FALSE(track.at(-1, kAnyGap));
  CHECK_FALSE(track.at(100'001, kAnyGap));
  CHECK_FALSE(PoseTrack(kSpan).at(0, kAnyGap));
}

TEST_CASE("nothing is made up inside a gap, and its edges are kept") {
  PoseTrack track(kSpan);
  track.push(0, {0, 0, 0});
  track.push(20'000, {0.02, 0, 0});
  track.push(520'000, {0.52, 0, 0});
  CHECK_FALSE(track.at(200'000, 100'000));
  CHECK(track.at(200'000, 500'000)->x == Approx(0.2));
  CHECK(track.at(20'000, 100'000)->x == 0.02);
  CHECK(track.at(520'000, 100'000)->x == 0.52);
  CHECK(track.longestGap(0, 20'000) == 20'000);
  CHECK(track.longestGap(0, 30'000) == 500'000);
  CHECK(track.longestGap(100'000, 520'000) == 500'000);
  CHECK_FALSE(track.longestGap(0, 520'001));
  CHECK_FALSE(track.longestGap(-1, 20'000));
  CHECK_FALSE(PoseTrack(kSpan).longestGap(0, 0));
}

TEST_CASE("duplicates, late poses and poses that are not finite are refused and change nothing") {
  PoseTrack track(kSpan);
  REQUIRE(track.push(1000, {1, 2, 3}));
  REQUIRE(track.push(2000, {2, 2, 3}));
  CHECK_FALSE(track.push(2000, {9, 9, 9}));
  CHECK_FALSE(track.push(1500, {9, 9, 9}));
  CHECK_FALSE(track.push(3000, {kNan, 0, 0}));
  CHECK_FALSE(track.push(3000, {0, std::numeric_limits<double>::infinity(), 0}));
  CHECK_FALSE(track.push(3000, {0, 0, kNan}));
  CHECK(track.poses().size() == 2);
  CHECK(track.at(2000, kAnyGap)->x == 2.0);
  CHECK(track.push(3000, {3, 2, 3}));
}

TEST_CASE("a track that is not finite at its very first pose stays empty") {
  PoseTrack track(kSpan);
  CHECK_FALSE(track.push(0, {kNan, 0, 0}));
  CHECK(track.poses().empty());
}

TEST_CASE("a time before all clocks is refused: no difference of times overflows") {
  PoseTrack track(kSpan);
  CHECK_FALSE(track.push(std::numeric_limits<int64_t>::min(), {0, 0, 0}));
  CHECK_FALSE(track.push(-1, {0, 0, 0}));
  CHECK(track.poses().empty());
  CHECK(track.push(0, {0, 0, 0}));
}

TEST_CASE("poses older than the span are let go") {
  PoseTrack track(1'000'000);
  for (int64_t utime = 0; utime <= 5'000'000; utime += 100'000) track.push(utime, {0, 0, 0});
  CHECK(track.poses().front().utime == 4'000'000);
  CHECK_FALSE(track.at(3'900'000, kAnyGap));
  track.clear();
  CHECK(track.poses().empty());
  CHECK(track.push(0, {0, 0, 0}));
}

TEST_CASE("the twist before a time is that of the motion") {
  const Twist2 twist{1.2, -0.1, 0.8};
  const PoseTrack track = trackOf(twist, 2'000'000);
  const auto measured = track.twistBefore(1'234'567, 200'000, kStep);
  REQUIRE(measured);
  CHECK(measured->v_x == Approx(twist.v_x));
  CHECK(measured->v_y == Approx(twist.v_y));
  CHECK(measured->omega == Approx(twist.omega));
  CHECK_FALSE(track.twistBefore(100'000, 200'000, kStep));
  CHECK_FALSE(track.twistBefore(2'000'001, 200'000, kStep));
}

}  // namespace tread
