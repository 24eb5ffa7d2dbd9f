// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

#include "modules/planner/core/map/heading_aware_heuristic.hpp"
#include "modules/planner/core/search/pattern_table.hpp"
#include "tests/helpers.hpp"
#include "tests/planner/kit/random_ground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

Primitive arc(int id, const Twist2& twist, double duration, double cost) {
  Primitive primitive;
  primitive.id = id;
  constexpr int kPoses = 20;
  for (int k = 1; k <= kPoses; ++k)
    primitive.poses.push_back(integrate(twist, duration * k / kPoses));
  primitive.duration = duration;
  primitive.cost = cost;
  return primitive;
}

/// Random arcs, straight motions ahead, back and sideways, and turns on the spot, at random costs.
std::vector<Primitive> randomPrimitives(std::mt19937_64& random) {
  std::vector<Primitive> primitives;
  const int count = drawn(random, 1, 12);
  for (int id = 0; id < count; ++id) {
    Twist2 twist;
    const int kind = drawn(random, 0, 3);
    if (kind != 0) twist.v_x = drawn(random, -1.2, 1.2);
    if (kind != 1) twist.omega = drawn(random, -1.5, 1.5);
    if (kind == 3) twist.v_y = drawn(random, -0.3, 0.3);
    primitives.push_back(arc(id, twist, drawn(random, 0.3, 2.0), drawn(random, 0.05, 4.0)));
  }
  return primitives;
}

double turnOf(const TablePattern& pattern) {
  return std::abs(pattern.end().pose.yaw);
}

/// No pattern is cheaper than either bound; each bound is reached by a pattern.
void checkBounds(const PatternTable& table) {
  double nearest[2] = {std::numeric_limits<double>::infinity(),
                       std::numeric_limits<double>::infinity()};
  for (const TablePattern& pattern : table.patterns()) {
    for (size_t i = 0; i < 2; ++i) {
      const LeastCost& least = table.leastCosts()[i];
      const double bound = least.per_metre * pattern.length + least.per_radian * turnOf(pattern);
      REQUIRE(bound <= pattern.cost * (1.0 + 1e-9));
      nearest[i] = std::min(nearest[i], pattern.cost - bound);
      REQUIRE(least.per_metre >= 0.0);
      REQUIRE(least.per_radian >= 0.0);
      REQUIRE(std::isfinite(least.per_metre + least.per_radian));
    }
  }
  CHECK(nearest[0] == Approx(0.0).margin(1e-9));
  CHECK(nearest[1] == Approx(0.0).margin(1e-9));
}

}  // namespace

TEST_CASE("no pattern of any set costs less than its way and its turn at the least costs") {
  std::mt19937_64 random(1);
  for (int i = 0; i < testing::effort(2000); ++i)
    checkBounds(PatternTable(randomPrimitives(random), usualSweep()));
  checkBounds(PatternTable(samplePatterns(), usualSweep(), {}));
  checkBounds(PatternTable(latticePatterns(), usualSweep(), {}));
}

TEST_CASE("a chain of patterns costs no less than both bounds of its whole way and net turn") {
  std::mt19937_64 random(2);
  for (int i = 0; i < testing::effort(300); ++i) {
    const PatternTable table(randomPrimitives(random), usualSweep());
    Pose2 end;
    double cost = 0.0;
    for (int k = 0; k < 8; ++k) {
      const auto& all = table.from(table.restClass());
      const TablePattern& next = *all[static_cast<size_t>(drawn(random, 0, int(all.size()) - 1))];
      end = end * next.end().pose;
      cost += next.cost;
    }
    for (const LeastCost& least : table.leastCosts())
      REQUIRE(least.per_metre * end.position().norm() + least.per_radian * std::abs(end.yaw) <=
              cost * (1.0 + 1e-9));
  }
}

TEST_CASE("each pattern costs at least what its direction is said to cost at least") {
  std::mt19937_64 random(3);
  constexpr double kBin = 2.0 * kPi / HeadingAwareHeuristic::kHeadings;
  for (int i = 0; i < testing::effort(1000); ++i) {
    const PatternTable table(randomPrimitives(random), usualSweep());
    const MotionRates rates = motionRates(table);
    for (const TablePattern& pattern : table.patterns()) {
      const Pose2& end = pattern.end().pose;
      const double turn = turnOf(pattern);
      if (turn > 0.0 && pattern.length < 0.04 * turn) {
        REQUIRE(rates.turn.any);
        REQUIRE(rates.turn.turns);
        REQUIRE(static_cast<double>(rates.turn.cost(pattern.length, turn)) <=
                pattern.cost * (1.0 + 1e-6));
        continue;
      }
      if (turn > 0.0 && pattern.length < 0.06 * turn) continue;  // both directions are valid
      if (pattern.length < 0.002) continue;
      const double towards = wrapAngle(std::atan2(end.y, end.x) - end.yaw / 2.0);
      const double bins = towards / kBin;
      if (std::abs(bins - std::round(bins)) > 0.499) continue;
      const int bin = (static_cast<int>(std::lround(bins)) + HeadingAwareHeuristic::kHeadings) %
                      HeadingAwareHeuristic::kHeadings;
      const MotionRates::Rate& rate = rates.along[static_cast<size_t>(bin)];
      REQUIRE(rate.any);
      REQUIRE(rate.turns >= (turn > 0.0));
      REQUIRE(static_cast<double>(rate.cost(pattern.length, turn)) <= pattern.cost * (1.0 + 1e-6));
    }
  }
}

TEST_CASE("a set that only turns, only drives or does neither leaves no bound of what it lacks") {
  const PatternTable turns({arc(0, {0.0, 0.0, 0.5}, 1.0, 2.0)}, usualSweep());
  CHECK(turns.leastCosts()[0].per_metre == 0.0);
  CHECK(turns.leastCosts()[1].per_radian == Approx(4.0));
  const PatternTable drives({arc(0, {0.5, 0.0, 0.0}, 1.0, 2.0)}, usualSweep());
  CHECK(drives.leastCosts()[0].per_metre == Approx(4.0));
  CHECK(drives.leastCosts()[1].per_radian == 0.0);
  CHECK_FALSE(motionRates(drives).turn.any);
  const PatternTable stands({arc(0, {}, 1.0, 2.0)}, usualSweep());
  for (const LeastCost& least : stands.leastCosts()) {
    CHECK(least.per_metre == 0.0);
    CHECK(least.per_radian == 0.0);
  }
}

TEST_CASE("a table of primitives begins and stops at rest with each, ending where each ends") {
  std::mt19937_64 random(4);
  for (int i = 0; i < testing::effort(50); ++i) {
    std::vector<Primitive> primitives = randomPrimitives(random);
    const PatternTable table(primitives, usualSweep());
    REQUIRE(table.patterns().size() == primitives.size());
    CHECK(table.classCount() == 1);
    CHECK(table.from(table.restClass()).size() == primitives.size());
    CHECK(table.stopsFrom(table.restClass()).size() == primitives.size());
    CHECK(table.find(static_cast<int>(primitives.size())) == nullptr);
    for (const Primitive& primitive : primitives) {
      const TablePattern& pattern = *table.find(primitive.id);
      CHECK(pattern.pattern == nullptr);
      CHECK(pattern.cost == primitive.cost);
      CHECK(pattern.duration == primitive.duration);
      for (const SweptPose& end :
           {pattern.swept_poses.back(), pattern.swept_footprint.poses.back().at}) {
        CHECK(end.pose.x == primitive.poses.back().x);
        CHECK(end.pose.y == primitive.poses.back().y);
        CHECK(end.pose.yaw == primitive.poses.back().yaw);
        CHECK(end.time == Approx(primitive.duration));
      }
    }
  }
}
