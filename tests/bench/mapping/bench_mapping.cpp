// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Time to insert a scan into the tree, alternating with OctoMap's own insertion of the same scan:
// each from another place, with a comparison of both trees byte by byte after each scan.
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>

#include "modules/mapping/core/voxel_map.hpp"
#include "tests/mapping/cloud_insertion.hpp"

namespace {

using namespace tread::mapping;
using octomap::OcTree;
using octomap::point3d;
using octomap::Pointcloud;

constexpr double kResolution = 0.1;  // [m]
constexpr double kMaxRange = 10.0;   // [m]

/// Processor time of this thread, independent of others.
template <class Action>
double milliseconds(const Action& action) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  };
  const double start = now();
  action();
  return now() - start;
}

/// Points of a text file, three numbers per line; empty if there is none.
Pointcloud readCloud(const std::string& path) {
  Pointcloud cloud;
  std::ifstream file(path);
  float x = 0.0F;
  float y = 0.0F;
  float z = 0.0F;
  while (file >> x >> y >> z) cloud.push_back(x, y, z);
  return cloud;
}

/// The cloud from a place further on, with some rotation.
Pointcloud moved(const Pointcloud& cloud, const octomap::pose6d& T_map_sensor) {
  Pointcloud moved(cloud);
  moved.transform(T_map_sensor);
  return moved;
}

/// Reports the times of both methods and their ratio; stops the benchmark if the trees differ.
class Comparison {
 public:
  explicit Comparison(benchmark::State& state) : state_(state) {}
  ~Comparison() {
    const auto scans = static_cast<double>(scans_);
    state_.counters["ours_ms"] = ours_ / scans;
    state_.counters["most_ms"] = most_;
    state_.counters["octomap_ms"] = theirs_ / scans;
    state_.counters["ratio"] = theirs_ / ours_;
  }
  Comparison(const Comparison&) = delete;
  Comparison& operator=(const Comparison&) = delete;

  template <class Ours, class Theirs>
  void add(const Ours& ours, const Theirs& theirs) {
    const double time = milliseconds(ours);
    ours_ += time;
    most_ = std::max(most_, time);
    theirs_ += milliseconds(theirs);
    ++scans_;
    state_.SetIterationTime(1e-3 * time);
  }
  void compare(const OcTree& ours, const OcTree& theirs) {
    if (bytesOf(ours) != bytesOf(theirs)) state_.SkipWithError("the trees differ");
  }

 private:
  benchmark::State& state_;
  int scans_ = 0;
  double ours_ = 0.0;
  double most_ = 0.0;
  double theirs_ = 0.0;
};

/// A complete cloud: $TREAD_SCAN, three numbers per line.
Pointcloud scanOf(benchmark::State& state) {
  const char* const path = std::getenv("TREAD_SCAN");
  Pointcloud scan = readCloud(path == nullptr ? "" : path);
  if (scan.size() == 0) state.SkipWithError("no points: set TREAD_SCAN to a file of them");
  return scan;
}

octomap::pose6d poseAfter(double way) {
  return {static_cast<float>(0.3 * way), static_cast<float>(0.1 * way), 0.0F, 0.0, 0.0, 0.07 * way};
}

void cloud(benchmark::State& state) {
  const Pointcloud scan = scanOf(state);
  Comparison comparison(state);
  OcTree ours(kResolution);
  OcTree theirs(kResolution);
  CloudInsertion insertion(kResolution, kMaxRange);
  double way = 0.0;
  for (auto _ : state) {
    if (scan.size() == 0) break;
    const octomap::pose6d T = poseAfter(way);
    const Pointcloud cloud = moved(scan, T);
    comparison.add([&] { insertion.insert(ours, cloud, T.trans()); },
                   [&] { theirs.insertPointCloud(cloud, T.trans(), kMaxRange, false, true); });
    comparison.compare(ours, theirs);
    way += 1.0;
  }
}
BENCHMARK(cloud)->UseManualTime()->Iterations(25)->Unit(benchmark::kMillisecond);

/// The same in isolation, without OctoMap in the same process.
void cloudAlone(benchmark::State& state) {
  const Pointcloud scan = scanOf(state);
  OcTree tree(kResolution);
  CloudInsertion insertion(kResolution, kMaxRange);
  double way = 0.0;
  for (auto _ : state) {
    if (scan.size() == 0) break;
    const octomap::pose6d T = poseAfter(way);
    const Pointcloud cloud = moved(scan, T);
    state.SetIterationTime(1e-3 * milliseconds([&] { insertion.insert(tree, cloud, T.trans()); }));
    way += 1.0;
  }
}
BENCHMARK(cloudAlone)->UseManualTime()->Iterations(100)->Unit(benchmark::kMillisecond);

/// 1081 beams in a hall with pillars, into a persistent map.
void planeScan(benchmark::State& state) {
  VoxelMap map(VoxelConfig{}, 256);
  map.moveTo({-128, -128}, -32);
  OcTree theirs(kResolution);
  const VoxelConfig config;
  theirs.setProbHit(config.hit);
  theirs.setProbMiss(config.miss);
  theirs.setClampingThresMin(config.clamp_min);
  theirs.setClampingThresMax(config.clamp_max);
  Comparison comparison(state);
  int scan = 0;
  for (auto _ : state) {
    const Eigen::Vector3d from(0.02 * scan, 0.01 * scan, 0.5);
    std::vector<Ray> rays;
    Pointcloud cloud;
    for (int i = 0; i < 1081; ++i) {
      const double angle = 0.25 * M_PI / 180.0 * (i - 540) + 0.01 * scan;
      const double range = 6.0 + 3.5 * std::sin(9.0 * angle);
      const Eigen::Vector3d to =
          from + range * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.02 * std::sin(angle));
      rays.push_back({from, to, true});
      const Eigen::Vector3f point = to.cast<float>();
      cloud.push_back(point.x(), point.y(), point.z());
    }
    const Eigen::Vector3f p = from.cast<float>();
    comparison.add(
        [&] { map.insert(rays); },
        [&] { theirs.insertPointCloud(cloud, point3d(p.x(), p.y(), p.z()), -1.0, false, false); });
    comparison.compare(map.tree(), theirs);
    ++scan;
  }
}
BENCHMARK(planeScan)->UseManualTime()->Iterations(100)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
