// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <limits>
#include <random>

#include <catch2/catch.hpp>

#include "common/fence/fence.hpp"
#include "tests/helpers.hpp"

using namespace tread;
using Eigen::Vector2d;

namespace {

constexpr FootprintSize kBody{0.65, 0.65, 0.34};

const Fence kYard{"yard", false, {{0, 0}, {20, 0}, {20, 10}, {0, 10}}};
const Fence kPond{"pond", true, {{8, 4}, {12, 4}, {12, 6}, {8, 6}}};
/// It has a reflex corner.
const Fence kHook{"hook", false, {{0, 0}, {20, 0}, {20, 10}, {10, 5}, {0, 10}}};
/// Narrower than the robot, with corners under it.
const Fence kDitch{"ditch", true, {{-3, 3}, {23, 6}, {23, 6.15}, {-3, 3.15}}};
const Fence kPath{
    "path", true, {{2, -3}, {2, 5}, {9, 6}, {18, 13}, {18, 12.7}, {9, 5.7}, {2.3, 4.7}, {2.3, -3}}};

/// Across the path of a robot that drives along x.
Fence ditchOf(double width) {
  return {"ditch", true, {{0, -9}, {width, -9}, {width, 9}, {0, 9}}};
}

/// Whether any point of the finely sampled outline is on forbidden ground.
bool crossesBySampling(const Fence& fence, const Pose2& pose) {
  constexpr int kSteps = 60;
  for (int i = 0; i <= kSteps; ++i)
    for (int k = 0; k <= kSteps; ++k) {
      const Vector2d p(-kBody.rear + kBody.length() * i / kSteps,
                       kBody.half_width * (2.0 * k / kSteps - 1.0));
      if (roomAt(fence, pose * p) < 0.0) return true;
    }
  return false;
}

}  // namespace

TEST_CASE("a point has room up to the fence, and less than none beyond it") {
  CHECK(roomAt(kYard, Vector2d(5, 3)) == Approx(3));
  CHECK(roomAt(kYard, Vector2d(-2, 3)) == Approx(-2));
  CHECK(roomAt(kYard, Vector2d(-3, -4)) == Approx(-5));
  CHECK(roomAt(kPond, Vector2d(7, 5)) == Approx(1));
  CHECK(roomAt(kPond, Vector2d(10, 4.5)) == Approx(-0.5));
}

TEST_CASE("an outline has the room of its nearest part") {
  CHECK(roomAt(kYard, {1.0, 5.0, 0.0}, kBody) == Approx(0.35));
  CHECK(roomAt(kYard, {1.0, 5.0, kPi / 2}, kBody) == Approx(0.66));
  CHECK(roomAt(kYard, {0.5, 5.0, 0.0}, kBody) == Approx(-0.15));
  CHECK(roomAt(kPond, {7.0, 5.0, 0.0}, kBody) == Approx(0.35));
  // The reflex corner is inside the body's side.
  CHECK(roomAt(kHook, {10.0, 4.9, 0.0}, kBody) == Approx(-0.24));
  CHECK(roomAt(kHook, {10.0, 4.5, 0.0}, kBody) == Approx(0.16));
}

TEST_CASE("a fence smaller than the robot is not overlooked under it") {
  const Fence post{"post", true, {{5, 5}, {5.1, 5}, {5.1, 5.1}, {5, 5.1}}};
  CHECK(roomAt(post, {5.0, 5.0, 0.3}, kBody) < 0.0);
  CHECK(roomAt(post, {5.0, 6.0, 0.0}, kBody) == Approx(0.56));
}

TEST_CASE(
    "wholly beyond a fence the room grows with every way back, and is never more than half in") {
  double before = -1e9;
  for (double x = -6.0; x < 1.5; x += 0.01) {
    const double room = roomAt(kYard, {x, 5.0, 0.0}, kBody);
    CHECK(room >= before - 1e-9);
    before = room;
  }
  CHECK(roomAt(kYard, {-6.0, 5.0, 0.0}, kBody) < -6.0);
}

TEST_CASE("what has room crosses nothing, and what crosses has none, wherever it stands") {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> x(-3.0, 23.0), y(-3.0, 13.0), yaw(-kPi, kPi);
  int crossing = 0;
  for (int i = 0; i < testing::effort(4000); ++i) {
    const Pose2 pose{x(engine), y(engine), yaw(engine)};
    for (const Fence& fence : {kYard, kPond, kHook, kDitch, kPath}) {
      const double room = roomAt(fence, pose, kBody);
      const bool crosses = crossesBySampling(fence, pose);
      crossing += crosses ? 1 : 0;
      INFO(fence.name << " " << pose.x << " " << pose.y << " " << pose.yaw << " room " << room);
      if (crosses) REQUIRE(room < 0.0);
      // A part of its edge between the samples may cross.
      if (!crosses) REQUIRE(roomAt(fence, pose, kBody.widened(-0.03)) >= 0.0);
    }
  }
  CHECK(crossing > testing::effort(1000));
}

TEST_CASE("over a ditch narrower than itself the room is negative, and grows to both ways out") {
  for (const double width : {0.02, 0.1, 0.3, 0.6, 0.9, 1.2, 1.31, 3.0})
    for (const double yaw : {0.0, 0.3, kPi / 4, kPi / 2})
      for (const double way : {-1.0, 1.0}) {
        double before = -1e9;
        for (double x = width / 2; std::abs(x) < 9.0; x += way * 0.01) {
          const double room = roomAt(ditchOf(width), {x, 0.0, yaw}, kBody);
          INFO(width << " " << yaw << " at " << x << ": " << room << " after " << before);
          if (std::abs(x - width / 2) < width / 2 + 0.33) REQUIRE(room < -0.01);
          REQUIRE(room >= before - 1e-9);
          before = std::min(room, 0.0);
        }
        CHECK(before == 0.0);
      }
}

TEST_CASE("the nearest of all fences counts, and without fences there is endless room") {
  const std::vector<Fence> both{kYard, kPond};
  CHECK(roomAt(both, {7.0, 5.0, 0.0}, kBody).nearest == "pond");
  CHECK(roomAt(both, {1.0, 5.0, 0.0}, kBody).nearest == "yard");
  CHECK(roomAt(both, Vector2d(7.0, 5.0)).nearest == "pond");
  CHECK(roomAt(both, Vector2d(7.0, 5.0)).metres == Approx(1.0));
  CHECK(roomAt(std::vector<Fence>{}, {7.0, 5.0, 0.0}, kBody).metres ==
        std::numeric_limits<double>::infinity());
}

TEST_CASE("what is no polygon is told in words") {
  const auto fault = [](std::vector<Vector2d> corners, const std::string& name = "a") {
    return faultOf({name, false, std::move(corners)});
  };
  CHECK(fault({{0, 0}, {1, 0}, {1, 1}}).empty());
  CHECK(fault({{0, 0}, {1, 0}}) == "a fence needs 3 to 64 corners");
  CHECK(fault({{0, 0}, {1, 0}, {2, 0}}) == "its corners enclose nothing");
  CHECK(fault({{0, 0}, {4, 3}, {4, 0}, {0, 2}}) == "it crosses itself: give its corners in turn");
  CHECK(fault({{0, 0}, {1, 0}, {std::nan(""), 1}}) == "a corner is no place in map");
  CHECK(fault({{0, 0}, {1, 0}, {1, 1e6}}) == "a corner is no place in map");
  const std::string name = "its name needs 1 to 32 printable ASCII characters";
  CHECK(fault({{0, 0}, {1, 0}, {1, 1}}, "People's yard, no. 2 ~").empty());
  for (const char* odd : {"", "a\nb", "\x1b[2J", "caf\xc3\xa9", "\x7f", "\x9b"})
    CHECK(fault({{0, 0}, {1, 0}, {1, 1}}, odd) == name);
  CHECK(fault({{0, 0}, {1, 0}, {1, 1}}, std::string(33, 'a')) == name);
}
