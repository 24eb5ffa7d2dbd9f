// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/mapping/cloud_insertion.hpp"

using namespace tread::mapping;
using octomap::OcTree;
using octomap::point3d;
using octomap::Pointcloud;

namespace {

double between(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}

point3d pointAt(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

/// Walls of a room of this radius around the origin of map, seen from a place in it; a third of the
/// points are random, some beyond the room.
Pointcloud roomFrom(std::mt19937_64& random, const point3d& origin, double radius, int points) {
  Pointcloud cloud;
  const double turn = between(random, -3.1, 3.1);
  for (int i = 0; i < points; ++i) {
    const double yaw = turn + 6.28 * i / points;
    const double pitch = between(random, -0.5, 0.5);
    const double range = i % 3 == 0 ? between(random, 0.0, 1.6 * radius) : radius;
    cloud.push_back(origin + pointAt(range * std::cos(yaw) * std::cos(pitch),
                                     range * std::sin(yaw) * std::cos(pitch),
                                     range * std::sin(pitch)));
  }
  return cloud;
}

/// Both methods of insertion.
struct Pair {
  Pair(double resolution, double range)
      : max_range(range), theirs(resolution), ours(resolution), insertion(resolution, range) {}

  void insert(const Pointcloud& cloud, const point3d& origin) {
    theirs.insertPointCloud(cloud, origin, max_range, false, true);
    insertion.insert(ours, cloud, origin);
  }
  void requireSame() {
    REQUIRE(ours.size() == theirs.size());
    REQUIRE(ours.calcNumNodes() == ours.size());
    REQUIRE((bytesOf(ours) == bytesOf(theirs)));
  }

  double max_range;
  OcTree theirs;
  OcTree ours;
  CloudInsertion insertion;
};

}  // namespace

TEST_CASE("a tree is OctoMap's own byte for byte after each of many moving, turning scans") {
  for (const double resolution : {0.05, 0.1, 0.37}) {
    std::mt19937_64 random(static_cast<uint64_t>(1000.0 * resolution));
    Pair pair(resolution, 30.0 * resolution);
    for (int scan = 0; scan < 25; ++scan) {
      const double s = 2.0 * resolution * scan;
      const point3d origin = pointAt(s, 0.3 * s * std::sin(0.3 * scan), 0.11 * s);
      pair.insert(roomFrom(random, origin, 20.0 * resolution, 400), origin);
      CAPTURE(resolution, scan);
      pair.requireSame();
    }
    REQUIRE(pair.ours.size() > 5000);
  }
}

TEST_CASE("what is saturated stays, and what has gone is cleared, as in OctoMap") {
  std::mt19937_64 random(2);
  Pair pair(0.1, 3.0);
  const point3d origin = pointAt(0.02, -0.03, 0.04);
  const Pointcloud near = roomFrom(random, origin, 1.2, 600);
  const Pointcloud far = roomFrom(random, origin, 2.4, 600);
  for (int scan = 0; scan < 12; ++scan) pair.insert(far, origin);
  pair.requireSame();
  for (int scan = 0; scan < 12; ++scan) pair.insert(near, origin);
  pair.requireSame();
  for (int scan = 0; scan < 12; ++scan) {
    pair.insert(far, origin);
    pair.requireSame();
  }
}

TEST_CASE("wide free space is one pruned node in both, opened again where something stands") {
  Pair pair(0.1, 4.0);
  Pointcloud all_around;
  for (int yaw = 0; yaw < 360; ++yaw)
    for (int pitch = -90; pitch <= 90; ++pitch)
      all_around.push_back(pointAt(5.0 * std::cos(yaw * 0.01745) * std::cos(pitch * 0.01745),
                                   5.0 * std::sin(yaw * 0.01745) * std::cos(pitch * 0.01745),
                                   5.0 * std::sin(pitch * 0.01745)));
  const point3d origin = pointAt(1.61, 1.62, 1.63);
  for (int scan = 0; scan < 6; ++scan) pair.insert(all_around, origin);
  pair.requireSame();
  // Larger than a block, so that nodes above the blocks are expanded, too.
  REQUIRE(pair.ours.search(pair.ours.coordToKey(1.6, 1.6, 1.6), 11) != nullptr);
  size_t large = 0;
  for (auto leaf = pair.ours.begin_leafs(); leaf != pair.ours.end_leafs(); ++leaf)
    large += leaf.getDepth() < 13 ? 1 : 0;
  REQUIRE(large > 0);
  Pointcloud one;
  one.push_back(pointAt(2.2, 1.7, 1.6));
  for (int scan = 0; scan < 3; ++scan) {
    pair.insert(one, origin);
    pair.requireSame();
  }
}

TEST_CASE("ends on the borders of voxels, beams along the axes and points on the sensor") {
  Pair pair(0.1, 2.0);
  std::mt19937_64 random(3);
  for (int scan = 0; scan < 20; ++scan) {
    const auto border = [&] { return 0.1 * std::round(between(random, -25.0, 25.0)); };
    const point3d origin = scan % 2 == 0 ? pointAt(0.0, 0.0, 0.0)
                                         : pointAt(border() / 10, border() / 10, border() / 10);
    Pointcloud cloud;
    cloud.push_back(origin);
    for (unsigned axis = 0; axis < 3; ++axis)
      for (const double range : {-2.5, -2.0, -0.1, 0.05, 0.1, 1.0, 2.0, 2.05}) {
        point3d point = origin;
        point(axis) += static_cast<float>(range);
        cloud.push_back(point);
      }
    for (int i = 0; i < 100; ++i) cloud.push_back(pointAt(border(), border(), border()));
    pair.insert(cloud, origin);
    pair.requireSame();
  }
}

TEST_CASE("near the end of what a tree can number beams that leave it are left out in both") {
  const double edge = 0.1 * 32768;
  std::mt19937_64 random(4);
  Pair pair(0.1, 2.0);
  for (const double sign : {-1.0, 1.0})
    for (int scan = 0; scan < 5; ++scan) {
      const point3d origin = pointAt(sign * (edge - 1.1), 0.3, sign * (edge - 0.7));
      Pointcloud cloud;
      for (int i = 0; i < 60; ++i)
        cloud.push_back(origin + pointAt(between(random, -1.0, 1.0), between(random, -1.0, 1.0),
                                         between(random, -0.6, 0.6)));
      pair.insert(cloud, origin);
      pair.requireSame();
    }
}

TEST_CASE("beams that leave the grid mark what lies inside of it") {
  OcTree tree(0.1);
  RayGrid grid({16, 16, 16});
  grid.moveTo({32768, 32768, 32768});
  const auto marked = [&] {
    size_t bits = 0;
    for (const VoxelBlock& block : grid.takeBlocks())
      for (size_t i = 0; i < 8; ++i)
        bits += static_cast<size_t>(__builtin_popcountll(block.seen(i)));
    return bits;
  };
  grid.trace(tree, pointAt(-1.0, 0.55, 0.55), pointAt(3.0, 0.55, 0.55), true);
  REQUIRE(marked() == 16);
  REQUIRE(marked() == 0);
  grid.trace(tree, pointAt(0.55, 0.55, 0.55), pointAt(0.55, 0.55, 5.0), true);
  REQUIRE(marked() == 11);
  grid.trace(tree, pointAt(-1.0, -1.0, 0.55), pointAt(-3.0, 2.0, 0.55), true);
  REQUIRE(marked() == 0);
  grid.trace(tree, pointAt(0.55, 0.55, 0.55), pointAt(1e6, 0.55, 0.55), true);
  REQUIRE(marked() == 0);
  REQUIRE_THROWS_AS(RayGrid({16, 12, 16}), std::invalid_argument);
}
