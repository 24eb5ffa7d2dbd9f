// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <random>

#include "modules/mapping/core/voxel_map.hpp"
#include "tests/mapping/cloud_insertion.hpp"

using namespace tread;
using namespace tread::mapping;

namespace {

constexpr int kSide = 64;

/// Rays from about the middle of the window with a common origin, as insertPointCloud() requires.
std::vector<Ray> randomRays(std::mt19937_64& random, const Eigen::Vector3d& middle) {
  std::uniform_real_distribution<double> turn(-3.1, 3.1);
  std::uniform_real_distribution<double> tilt(-0.1, 0.1);
  std::uniform_real_distribution<double> length(0.3, 2.8);
  std::vector<Ray> rays;
  for (int i = 0; i < 300; ++i) {
    const double angle = turn(random);
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), tilt(random));
    rays.push_back({middle, middle + direction * length(random), i % 4 != 0});
  }
  return rays;
}

/// By definition: OctoMap's own insertion; beams without return end beyond its range.
void insertByOctoMap(octomap::OcTree& tree, const std::vector<Ray>& rays) {
  octomap::KeySet passed;
  octomap::KeySet hit;
  octomap::KeyRay keys;
  for (const Ray& ray : rays) {
    const octomap::point3d from(float(ray.from.x()), float(ray.from.y()), float(ray.from.z()));
    const octomap::point3d to(float(ray.to.x()), float(ray.to.y()), float(ray.to.z()));
    if (tree.computeRayKeys(from, to, keys)) passed.insert(keys.begin(), keys.end());
    if (ray.hit) hit.insert(tree.coordToKey(to));
  }
  for (const auto& key : passed)
    if (hit.count(key) == 0) tree.updateNode(key, false);
  for (const auto& key : hit) tree.updateNode(key, true);
}

octomap::OcTreeKey keyAt(CellIndex cell, int z) {
  const auto key = [](int index) { return static_cast<octomap::key_type>(index + 32768); };
  return {key(cell.x), key(cell.y), key(z)};
}

/// Pruned and up to date: repeating both changes no byte.
void requireNeat(const octomap::OcTree& tree) {
  octomap::OcTree again(tree);
  again.updateInnerOccupancy();
  again.prune();
  REQUIRE((bytesOf(again) == bytesOf(tree)));
}

/// The bit image compared with the tree, voxel by voxel.
void requireSameAsTree(const VoxelMap& map) {
  size_t known = 0;
  size_t wrong = 0;
  for (size_t i = 0; i < map.columns().size(); ++i) {
    const Column& column = map.columns()[i];
    for (int bit = 0; bit < kColumnHeight; ++bit) {
      const auto* node = map.tree().search(keyAt(map.columns().indexOf(i), map.lowerZ() + bit));
      const bool is_known = (column.known >> bit & 1u) != 0;
      const bool is_occupied = (column.occupied >> bit & 1u) != 0;
      if (is_known != (node != nullptr)) ++wrong;
      if (node != nullptr && is_occupied != map.tree().isNodeOccupied(node)) ++wrong;
      known += node != nullptr ? 1 : 0;
    }
  }
  REQUIRE(wrong == 0);
  size_t voxels = 0;  // including voxels that the tree has outside of the window
  for (auto leaf = map.tree().begin_leafs(); leaf != map.tree().end_leafs(); ++leaf)
    voxels += size_t{1} << 3 * (16 - leaf.getDepth());
  REQUIRE(voxels == known);
  REQUIRE(map.tree().size() == map.tree().calcNumNodes());
  requireNeat(map.tree());
}

}  // namespace

TEST_CASE("the voxels hold what OctoMap's own insertion gives for the same beams") {
  const VoxelConfig config;
  VoxelMap map(config, kSide);
  map.moveTo({-32, -32}, -32);
  octomap::OcTree tree(config.cell_size);
  tree.setProbHit(config.hit);
  tree.setProbMiss(config.miss);
  tree.setClampingThresMin(config.clamp_min);
  tree.setClampingThresMax(config.clamp_max);
  std::mt19937_64 random(5);
  for (int scan = 0; scan < 12; ++scan) {
    const auto rays = randomRays(random, {0.02 * scan, 0.03 - 0.01 * scan, 0.04});
    map.insert(rays);
    insertByOctoMap(tree, rays);
    REQUIRE((bytesOf(map.tree()) == bytesOf(tree)));
  }
  REQUIRE(tree.size() > 3000);
}

TEST_CASE(
    "the bit image says what the tree says, also after the window has moved in all directions") {
  VoxelMap map(VoxelConfig{}, kSide);
  map.moveTo({-32, -32}, -32);
  std::mt19937_64 random(6);
  Eigen::Vector3d middle(0.0, 0.0, 0.0);
  for (const Eigen::Vector3i& step :
       {Eigen::Vector3i(8, 0, 0), Eigen::Vector3i(0, -8, 8), Eigen::Vector3i(-16, 8, -8),
        Eigen::Vector3i(0, 0, 32), Eigen::Vector3i(8, 8, 0), Eigen::Vector3i(56, 0, 0)}) {
    map.insert(randomRays(random, middle));
    requireSameAsTree(map);
    const CellIndex lower = map.columns().lower();
    map.moveTo({lower.x + step.x(), lower.y + step.y()}, map.lowerZ() + step.z());
    middle += 0.1 * step.cast<double>();
    requireSameAsTree(map);
  }
}

TEST_CASE("a window that moves far away starts with an empty tree and works on") {
  VoxelMap map(VoxelConfig{}, kSide);
  map.moveTo({-32, -32}, -32);
  std::mt19937_64 random(7);
  map.insert(randomRays(random, {0, 0, 0}));
  map.moveTo({1000, -2000}, 104);
  requireSameAsTree(map);
  REQUIRE(map.tree().size() == 0);
  map.insert(randomRays(random, {103.2, -196.8, 13.2}));
  requireSameAsTree(map);
  REQUIRE(map.tree().size() > 1000);
}

TEST_CASE("the columns told as changed are those whose known or occupied voxels changed") {
  VoxelMap map(VoxelConfig{}, kSide);
  map.moveTo({-32, -32}, -32);
  const std::vector<Ray> rays{{{0.05, 0.05, 0.05}, {1.05, 0.05, 0.05}, true}};
  map.insert(rays);
  REQUIRE(map.changed().size() == 11);
  map.insert(rays);
  REQUIRE(map.changed().empty());
  REQUIRE(map.touched().size() == 11);
  map.insert({{{0.05, 0.05, 0.05}, {2.05, 0.05, 0.05}, false}});
  REQUIRE(map.changed().size() == 9);  // except for the hit, which two hits and one miss keep
}
