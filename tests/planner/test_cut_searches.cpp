// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Of a step cut by its deadline a replay knows only the number of expanded nodes.
#include <catch2/catch.hpp>

#include <vector>

#include "tests/planner/kit/policy_rig.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

/// A boulder straight ahead, and noise that makes either side the shorter one.
struct Drive {
  Drive() : rig(boulder(), thorough()) {}

  /// Searches that take long enough to be cut.
  static PlannerConfig thorough() {
    PlannerConfig config = usualPlanner();
    config.search.heuristic_weight = 1.2;
    config.search.turn_weight = 0.4;
    config.search.horizon = 9.0;
    return config;
  }

  static Playground boulder() {
    Playground ground;
    ground.add({{9.0, 0.0, 0.0}, 0.5, 0.5});
    return ground;
  }

  Decision step(int number) {
    const double off = 0.05 * (number % 3 - 1);
    return rig.run(0.05, [&](PlannerInputs& seen) {
      seen.pose->T_map_body.y += off;
      seen.pose->T_map_body.yaw += off;
    });
  }

  Rig rig;
};

struct Seen {
  std::vector<int> patterns;
  int expansions = 0;
  bool cut = false;
};

Seen seenIn(const Decision& decision) {
  Seen seen;
  for (const PlanStep& step : decision.report.steps) seen.patterns.push_back(step.pattern_id);
  seen.expansions = decision.report.expansions;
  return seen;
}

}  // namespace

TEST_CASE("Searches that a clock cut come out the same when their count of expansions cuts them",
          "[statistics]") {
  const int asked = GENERATE(1, 2, 3);
  Drive live;
  std::vector<Seen> log;
  int calls = 0;
  live.rig.stop = [&](int) { return ++calls >= asked; };
  int cuts = 0;
  for (int i = 0; i < 160; ++i) {
    calls = 0;
    log.push_back(seenIn(live.step(i)));
    log.back().cut = calls >= asked;
    cuts += log.back().cut ? 1 : 0;
  }
  CHECK(cuts > 5);
  CHECK(live.rig.supervisor().counters().count("kept to its side") == 1);
  Drive replay;
  int limit = 0;
  replay.rig.stop = [&](int count) { return limit > 0 && count >= limit; };
  for (size_t i = 0; i < log.size(); ++i) {
    limit = log[i].cut ? log[i].expansions : 0;
    const Seen seen = seenIn(replay.step(static_cast<int>(i)));
    CAPTURE(asked, i, log[i].cut);
    REQUIRE(seen.expansions == log[i].expansions);
    REQUIRE(seen.patterns == log[i].patterns);
  }
}
