// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/mapping/core/column_classifier.hpp"

using namespace tread;
using namespace tread::mapping;

namespace {

constexpr int kLower = -32;

/// The bit of the voxel for a height [m], voxels of 0.1 m.
uint64_t at(double z) {
  return uint64_t{1} << (static_cast<int>(std::floor(z * 10.0)) - kLower);
}

Column columnOf(uint64_t free, uint64_t occupied) {
  return {free | occupied, occupied};
}

Cell classified(uint64_t free, uint64_t occupied, double ground = 0.0, double doubt = 0.0) {
  return ColumnClassifier(ObstacleConfig{0.15, 1.2}, 0.1)
      .classify(columnOf(free, occupied), kLower, {ground, doubt});
}

}  // namespace

TEST_CASE("a column of which nothing is known is unknown, one seen only outside the band too") {
  REQUIRE(classified(0, 0) == kUnknown);
  REQUIRE(classified(at(1.55), 0) == kUnknown);
  REQUIRE(classified(at(0.05), 0) == kUnknown);
}

TEST_CASE("occupied in the band is an obstacle, below the step or above the robot it is not") {
  REQUIRE(classified(at(0.55), at(0.25)) == kObstacle);
  REQUIRE(classified(0, at(1.05)) == kObstacle);
  REQUIRE(classified(at(0.55), at(0.05)) == kFree);
  REQUIRE(classified(at(0.55), at(1.35)) == kFree);
  REQUIRE(classified(at(0.55) | at(0.25), at(0.45)) == kObstacle);
}

TEST_CASE("heights count from the ground, not from the origin of map") {
  REQUIRE(classified(at(1.55), at(1.05), 1.0) == kFree);
  REQUIRE(classified(at(1.55), at(1.35), 1.0) == kObstacle);
  REQUIRE(classified(at(-1.45), at(0.05), -2.0) == kFree);
}

TEST_CASE(
    "what may be the ground itself is unknown, and free if the space above it was seen free") {
  REQUIRE(classified(0, at(0.25) | at(-0.15), 0.0, 0.3) == kUnknown);
  REQUIRE(classified(at(0.55), at(0.25), 0.0, 0.3) == kFree);
  REQUIRE(classified(at(0.15), at(0.25) | at(-0.15), 0.0, 0.3) == kUnknown);
  REQUIRE(classified(at(0.75), at(0.55), 0.0, 0.3) == kObstacle);
  REQUIRE(classified(at(0.55), at(0.25), 0.0, 0.0) == kObstacle);
}

TEST_CASE("the ground is no higher than the lowest voxel that was seen, within the doubt") {
  // Free at -0.2: the ground is below. Occupied at 0.15 is 0.25 above it.
  REQUIRE(classified(at(-0.15), at(0.15), 0.0, 0.0) == kObstacle);
  REQUIRE(classified(at(-0.15) | at(0.55), 0, 0.0, 0.1) == kFree);
  // A single false beam far below the ground must not raise an obstacle above the robot.
  REQUIRE(classified(at(-2.0), at(0.55), 0.0, 0.1) == kObstacle);
}

TEST_CASE("ground seen more than a step below the neighbour's is a drop") {
  const ColumnClassifier classifier(ObstacleConfig{0.15, 1.2}, 0.1);
  const int low = classifier.surface(columnOf(at(0.55), at(-0.45) | at(0.75)), kLower, {});
  const int high = classifier.surface(columnOf(at(0.55), at(-0.05)), kLower, {});
  CHECK(low == 27);
  CHECK(high == 31);
  CHECK(classifier.surface(columnOf(at(0.55), 0), kLower, {}) == -1);
  CHECK(classifier.isDrop(low, high));
  CHECK_FALSE(classifier.isDrop(high, low));
  CHECK_FALSE(classifier.isDrop(high - 2, high));  // up to two voxels may be one step
  CHECK_FALSE(classifier.isDrop(-1, high));
}

TEST_CASE("ground far above or below the column's voxels calls nothing free or obstacle") {
  REQUIRE(classified(at(0.55), at(0.75), 50.0) == kUnknown);
  REQUIRE(classified(at(0.55), at(0.75), -50.0) == kUnknown);
}
