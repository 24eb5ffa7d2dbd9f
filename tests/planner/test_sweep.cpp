// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cstdio>
#include <cstdlib>

#include "common/pattern/pattern_file.hpp"
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
    const bool shipped = std::getenv("SHIPPED") != nullptr;
    if (shipped) options.vehicle = {1.0845, 0.6055, 0.15};
    const PatternSet set = shipped
                               ? readPatternFile(TREAD_SOURCE_DIR "/config/patterns/teodor.yaml")
                               : samplePatterns();
    const auto env = [](const char* k, double& v) {
      if (const char* e = std::getenv(k)) v = std::atof(e);
    };
    SearchConfig& sc = options.config.search;
    Margins& mg = options.config.world.margins;
    FieldConfig& fc = options.config.world.field;
    double bins = sc.heading_bins, budget = 3000, standing = 15000;
    env("CELL", sc.cell);
    env("BINS", bins);
    env("BUDGET", budget);
    env("STANDING", standing);
    env("WEIGHT", sc.bound_weight);
    env("TURN", sc.turn_weight);
    env("MPLAN", mg.plan);
    env("MCHECK", mg.check);
    env("MLARGE", mg.largest);
    env("GROW", mg.growth);
    env("NEAR", sc.near_penalty);
    env("SWITCH", sc.switch_penalty);
    env("HORIZON", sc.horizon);
    env("TIGHT", fc.tight_weight);
    env("ETURN", options.errors.turn);
    env("EGAIN", options.errors.gain);
    env("EDRIFT", options.errors.drift);
    env("BIAS", options.errors.turn_bias);
    env("NEARD", sc.near_distance);
    env("FRONTIER", sc.frontier);
    sc.heading_bins = int(bins);
    options.config.policy.driving_expansions = int(budget);
    options.config.policy.standing_expansions = int(standing);
    double last = -10, cl = 9;
    const Mission m = randomMission(options.seed);
    if (std::getenv("DRAW")) {
      for (double y = 10; y > -10; y -= 0.25) {
        for (double x = -5; x < 36; x += 0.2)
          std::putchar(m.ground.isObstacle({x, y})
                           ? '#'
                           : (std::hypot(x - m.goal.T_map_goal.x, y - m.goal.T_map_goal.y) < 0.5
                                  ? 'G'
                              : std::hypot(x, y) < 0.4 ? 'S'
                                                       : '.'));
        std::printf("  %.2f\n", y);
      }
    }
    if (std::getenv("TRACE")) {
      options.on_decision = [&](double t, const Decision& d) {
        if (!d.planned) return;
        std::printf("   %.2f st %d exp %d ttg %.1f steps %zu ids", t, int(d.report.status),
                    d.report.expansions, d.report.time_to_go, d.report.steps.size());
        for (auto& s : d.report.steps) std::printf(" %s", set.find(s.pattern_id)->name.c_str());
        std::printf("  %s\n", d.report.reason.c_str());
      };
      options.on_step = [&](double t, const Pose2& p, Supervisor& sup, Playground& g) {
        const double c = g.clearance({}, p);
        if (t - last > 0.9 || c < 0.07) {
          last = t;
          std::printf(" %.2f pose %.2f %.2f %.2f clr %.3f way %.1f\n", t, p.x, p.y, p.yaw, c,
                      sup.costToGo().empty() ? -1 : sup.costToGo().length(p.position()));
        }
        (void)cl;
      };
    }
    const DriveOutcome o = driveMission(randomMission(options.seed), set, options);
    arrived += o.status == PlanStatus::kArrived;
    collided += o.collisions > 0;
    cpu += o.planner_seconds;
    virt += o.time;
    std::printf(
        "%4d status %d t %.1f d %.1f clr %.3f coll %d pat %d cpu/s %.1f ms worst %.1f ms  %s |",
        seed, int(o.status), o.time, o.distance, o.least_clearance, o.collisions, o.patterns,
        1e3 * o.planner_seconds / o.time, 1e3 * o.worst_step, o.reason.c_str());
    for (auto& [k, v] : o.counters)
      if (k != "patterns joined") std::printf(" %s=%ld;", k.c_str(), long(v));
    std::printf("\n");
    std::fflush(stdout);
  }
  std::printf("arrived %d/%d collided %d cpu %.1f ms per virtual s\n", arrived, n, collided,
              1e3 * cpu / virt);
}
