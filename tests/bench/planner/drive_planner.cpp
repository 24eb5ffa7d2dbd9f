// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Drives random missions in a closed loop (kinematic vehicle, toy mapping and bridge, the real
// supervisor) and prints the final distance, the duration and the planner's computing time:
//   bench-planner-drive [FIRST_SEED [COUNT [TURN_BIAS [PATTERN_FILE]]]]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "common/pattern/pattern_file.hpp"
#include "tests/planner/kit/closed_loop.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

/// Totals over all missions.
struct Summary {
  int arrived = 0;
  int touched = 0;
  double virtual_time = 0.0;
  double processor_time = 0.0;
  std::vector<double> clearances;
  std::vector<double> worst_steps;

  void add(const DriveOutcome& outcome) {
    arrived += outcome.status == PlanStatus::kArrived ? 1 : 0;
    touched += outcome.collisions > 0 ? 1 : 0;
    virtual_time += outcome.time;
    processor_time += outcome.planner_seconds;
    clearances.push_back(outcome.least_clearance);
    worst_steps.push_back(outcome.worst_step);
  }
  void print() {
    std::sort(clearances.begin(), clearances.end());
    std::sort(worst_steps.begin(), worst_steps.end());
    const size_t middle = clearances.size() / 2;
    std::printf(
        "arrived %d of %zu, touched %d; least clearance %.3f m, median of the least %.3f m\n",
        arrived, clearances.size(), touched, clearances.front(), clearances[middle]);
    std::printf(
        "planner %.1f ms per virtual second; worst step: median %.1f ms, greatest %.1f ms\n",
        1e3 * processor_time / virtual_time, 1e3 * worst_steps[middle], 1e3 * worst_steps.back());
  }
};

void print(uint64_t seed, const DriveOutcome& outcome) {
  std::printf("seed %llu status %d %6.1f s %5.1f m clearance %.3f m patterns %d  %s\n",
              static_cast<unsigned long long>(seed), static_cast<int>(outcome.status), outcome.time,
              outcome.distance, outcome.least_clearance, outcome.patterns, outcome.reason.c_str());
  for (const auto& [name, count] : outcome.counters)
    std::printf("    %s: %lld\n", name.c_str(), static_cast<long long>(count));
}

}  // namespace

int main(int argc, char** argv) {
  const uint64_t first = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const uint64_t count = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 10;
  DriveOptions options;
  if (argc > 3) options.errors.turn_bias = std::atof(argv[3]);
  // The shipped set is predicted for tarmac: top speed and gauge of that model.
  if (argc > 4) options.vehicle = {1.0845, 0.6055, 0.15};
  const PatternSet set = argc > 4 ? readPatternFile(argv[4]) : samplePatterns();
  Summary summary;
  for (uint64_t seed = first; seed < first + std::max<uint64_t>(1, count); ++seed) {
    options.seed = seed;
    const DriveOutcome outcome = driveMission(randomMission(seed), set, options);
    print(seed, outcome);
    summary.add(outcome);
  }
  summary.print();
  return 0;
}
