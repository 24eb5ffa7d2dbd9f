// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/search/swept_footprint.hpp"
#include "tests/helpers.hpp"
#include "tests/planner/kit/random_ground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

/// Poses of a pattern, at most 1 cm and 0.005 rad apart.
std::vector<SweptPose> finePoses(const std::vector<Pose2>& trajectory, double period) {
  return sampleSweep(trajectory, period, SweepResolution{0.01, 0.005, 0.3, kVehicle});
}

std::vector<Pose2> randomArc(std::mt19937_64& random, double most_turn) {
  const Twist2 twist{drawn(random, -1.5, 1.5), 0.0, drawn(random, -most_turn, most_turn)};
  std::vector<Pose2> poses;
  for (int k = 1; k <= 40; ++k) poses.push_back(integrate(twist, k / 40.0));
  return poses;
}

Margins withoutMargin() {
  Margins none;
  none.check = none.plan = none.growth = none.largest = 0.0;
  return none;
}

struct Count {
  int accepted = 0;
  int refused = 0;  // by the exact test, with a smaller footprint
};

/// Draws grounds and motions, and levels of margin if there are any; counts accepted motions with a
/// contact of a footprint that is `smaller` [m] on all sides.
template <class DrawPoses>
Count judge(uint64_t seed, const SweepResolution& step, double smaller, const DrawPoses& draw,
            const FootprintSize& size = kVehicle, const Margins& margins = withoutMargin()) {
  std::mt19937_64 random(seed);
  Count count;
  RandomGround ground;
  ground.blocks = 4;
  ground.specks = 25;
  for (int i = 0; i < testing::effort(700); ++i) {
    ground.cell_size = i % 4 == 0 ? 0.05 : 0.1;
    const Grid grid = ground.draw(random);
    const CollisionChecker around(grid, size, margins);
    const int level =
        margins.largest > 0.0 ? i % CollisionChecker::kLevels : CollisionChecker::kBare;
    const Footprint exact(size, around.marginOf(level) - smaller);
    for (int k = 0; k < 4; ++k) {
      Primitive primitive;
      primitive.poses = draw(random);
      primitive.duration = primitive.cost = 1.0;
      const PatternTable table({primitive}, step);
      const Pose2 start = ground.pose(random);
      if (!around.isFree(start, level)) continue;
      if (!around.sweepFree(start, table.patterns().front(), level)) continue;
      ++count.accepted;
      for (const SweptPose& at : finePoses(primitive.poses, 1.0 / 40.0)) {
        if (exact.blockedCells(grid, start * at.pose, true) == 0) continue;
        ++count.refused;
        break;
      }
    }
  }
  CHECK(count.accepted > testing::effort(250));
  return count;
}

std::vector<Pose2> randomSpotTurn(std::mt19937_64& random) {
  const double turn = drawn(random, -1.5, 1.5);
  std::vector<Pose2> poses;
  for (int k = 1; k <= 40; ++k) poses.push_back({0.0, 0.0, turn * k / 40.0});
  return poses;
}

}  // namespace

TEST_CASE("a straight sweep that is accepted touches nothing between the poses that are checked") {
  const auto straight = [](std::mt19937_64& random) { return randomArc(random, 0.0); };
  CHECK(judge(1, usualSweep(), 1e-6, straight).refused == 0);
}

TEST_CASE("a vehicle of 10 cm gets poses as close as that, or it would jump over what is thin") {
  const auto straight = [](std::mt19937_64& random) { return randomArc(random, 0.0); };
  const FootprintSize tiny{0.05, 0.05, 0.05};
  for (const double distance : {0.1, 0.5}) {
    const SweepResolution step{distance, 0.105, 0.3, kVehicle.widened(0.09)};
    CHECK(judge(7, resolutionFor(tiny, 0.0, step), 1e-6, straight, tiny).refused == 0);
    CHECK(judge(7, step, 1e-6, straight, tiny).refused > 0);
  }
  const FootprintSize small{0.1, 0.1, 0.1};
  CHECK(judge(7, resolutionFor(small, 0.0, {}), 1e-6, straight, small).refused == 0);
}

TEST_CASE("an arc or a turn that is accepted cuts no obstacle by more than 5 mm") {
  // Between two headings a corner swings out of both, by up to 5 cm.
  const auto arc = [](std::mt19937_64& random) { return randomArc(random, 2.0); };
  CHECK(judge(2, usualSweep(), 0.005, arc).refused == 0);
  CHECK(judge(3, usualSweep(), 0.005, randomSpotTurn).refused == 0);
}

TEST_CASE("with each margin that the search knows no more is cut than without") {
  const auto arc = [](std::mt19937_64& random) { return randomArc(random, 2.0); };
  const FootprintSize size = kVehicle;
  Margins wide;
  wide.largest = 0.2;
  for (const Margins& margins : {Margins{}, wide}) {
    const SweepResolution step = resolutionFor(size, margins.largest, {});
    CHECK(judge(20, step, 0.005, arc, size, margins).refused == 0);
    CHECK(judge(21, step, 0.005, randomSpotTurn, size, margins).refused == 0);
  }
}

TEST_CASE("coarser turns are no reason to cut more") {
  const auto arc = [](std::mt19937_64& random) { return randomArc(random, 2.0); };
  const SweepResolution coarse{0.1, 0.5, 0.3, kVehicle.widened(0.09)};
  CHECK(judge(4, coarse, 0.005, arc).refused == 0);
  CHECK(judge(5, coarse, 0.005, randomSpotTurn).refused == 0);
}

TEST_CASE("long, wide and off-centre vehicles and skidding ones cut no more than others") {
  const auto skid = [](std::mt19937_64& random) {
    const Twist2 twist{drawn(random, -1.0, 1.0), drawn(random, -0.4, 0.4),
                       drawn(random, -2.0, 2.0)};
    std::vector<Pose2> poses;
    for (int k = 1; k <= 40; ++k) poses.push_back(integrate(twist, k / 40.0));
    return poses;
  };
  uint64_t seed = 10;
  for (const FootprintSize& size : {FootprintSize{0.9, 0.2, 0.25}, FootprintSize{0.2, 0.2, 0.5},
                                    FootprintSize{0.735, 0.735, 0.415}})
    CHECK(judge(seed++, resolutionFor(size, 0.0, {}), 0.005, skid, size).refused == 0);
}

TEST_CASE("where a pattern is refused for what lies between its poses it hits or scrapes it") {
  // A refusal must be justified: a footprint larger by 1 mm has a contact.
  std::mt19937_64 random(8);
  const FootprintSize size = kVehicle;
  const Footprint larger(size, 1e-3);
  RandomGround ground;
  ground.specks = 25;
  int refused = 0;
  for (int i = 0; i < testing::effort(300); ++i) {
    const Grid grid = ground.draw(random);
    const CollisionChecker around(grid, size, withoutMargin());
    for (int k = 0; k < 4; ++k) {
      Primitive primitive;
      primitive.poses = i % 2 == 0 ? randomSpotTurn(random) : randomArc(random, 2.0);
      primitive.duration = primitive.cost = 1.0;
      const PatternTable table({primitive}, usualSweep());
      const Pose2 start = ground.pose(random);
      if (!around.isFree(start, CollisionChecker::kBare)) continue;
      if (around.sweepFree(start, table.patterns().front(), CollisionChecker::kBare)) continue;
      ++refused;
      const auto poses = finePoses(primitive.poses, 1.0 / 40.0);
      REQUIRE(std::any_of(poses.begin(), poses.end(), [&](const SweptPose& at) {
        return larger.blockedCells(grid, start * at.pose, true) > 0;
      }));
    }
  }
  CHECK(refused > testing::effort(50));
}

TEST_CASE("a cover is a part of the sweep, in its order, and never leaves more out than it may") {
  std::mt19937_64 random(6);
  const SweepResolution step = usualSweep();
  for (int i = 0; i < testing::effort(500); ++i) {
    Primitive primitive;
    primitive.poses = i % 3 == 0 ? randomSpotTurn(random) : randomArc(random, 2.0);
    primitive.duration = primitive.cost = 1.0;
    const PatternTable table({primitive}, step);
    const TablePattern& pattern = table.patterns().front();
    Pose2 last;
    double last_time = 0.0;
    auto in_sweep = pattern.swept_poses.begin();
    for (const CheckedPose& way : pattern.swept_footprint.poses) {
      const SweptPose& at = way.at;
      REQUIRE(way.first_between + way.between_count <= pattern.swept_footprint.between.size());
      for (size_t b = way.first_between; b < way.first_between + way.between_count; ++b) {
        REQUIRE(pattern.swept_footprint.between[b].time > last_time);
        REQUIRE(pattern.swept_footprint.between[b].time < at.time);
      }
      last_time = at.time;
      in_sweep = std::find_if(in_sweep, pattern.swept_poses.end(),
                              [&](const SweptPose& other) { return other.time == at.time; });
      REQUIRE(in_sweep != pattern.swept_poses.end());
      const double distance = std::hypot(at.pose.x - last.x, at.pose.y - last.y);
      REQUIRE(distance <= step.covered + 1e-9);
      REQUIRE(std::abs(at.pose.yaw - last.yaw) <= step.turn + 1e-9);
      last = at.pose;
    }
    REQUIRE(pattern.swept_footprint.poses.back().at.time == pattern.swept_poses.back().time);
  }
}
