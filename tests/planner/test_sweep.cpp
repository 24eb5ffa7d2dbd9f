// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cstdio>
#include <cstdlib>

#include "tests/planner/kit/closed_loop.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

TEST_CASE("sweep", "[.sweep]") {
  const char* first = std::getenv("FIRST");
  const char* count = std::getenv("COUNT");
  const int from = first ? std::atoi(first) : 1;
  const int n = count ? std::atoi(count) : 20;
  int arrived = 0, collided = 0;
  double cpu = 0, virt = 0;
  for (int seed = from; seed < from + n; ++seed) {
    DriveOptions options;
    options.seed = static_cast<uint64_t>(seed);
    const DriveOutcome o = driveMission(randomMission(options.seed), samplePatterns(), options);
    arrived += o.status == PlanStatus::kArrived;
    collided += o.collisions > 0;
    cpu += o.planner_seconds;
    virt += o.time;
    std::printf("%4d status %d t %.1f d %.1f clr %.3f coll %d pat %d cpu/s %.1f ms worst %.1f ms  %s |", seed,
                int(o.status), o.time, o.distance, o.least_clearance, o.collisions, o.patterns,
                1e3 * o.planner_seconds / o.time, 1e3 * o.worst_step, o.reason.c_str());
    for (auto& [k, v] : o.counters) if (k != "patterns joined") std::printf(" %s=%ld;", k.c_str(), long(v));
    std::printf("\n");
    std::fflush(stdout);
  }
  std::printf("arrived %d/%d collided %d cpu %.1f ms per virtual s\n", arrived, n, collided, 1e3 * cpu / virt);
}
