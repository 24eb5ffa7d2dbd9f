// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/helpers.hpp"
#include "tests/planner/kit/policy_rig.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

int64_t keptBy(Rig& rig) {
  const auto& counters = rig.supervisor().counters();
  const auto found = counters.find("kept to its next pattern");
  return found == counters.end() ? 0 : found->second;
}

/// Id of the pattern that was sent to follow the running one; 0 = none.
int nextOf(Rig& rig) {
  const ExecutionTracker& tracker = rig.supervisor().program();
  return tracker.next().empty() ? 0 : tracker.next().pattern_id;
}

/// A door across the path with 6 cm of space on each side: enough for the running pattern, too
/// little for a new plan.
Playground doorAt(double x) {
  Playground ground;
  for (const double side : {-1.0, 1.0})
    ground.addWall({x + 0.1, side * 0.5}, {x + 0.1, side * 9.0});
  return ground;
}

/// Observations while a vehicle at full speed approached a new door.
struct Approach {
  int kept = 0;          ///< steps in which the next pattern was kept
  int kept_to_it = 0;    ///< steps after which it was still the next one, or had begun
  double closest = 1e9;  ///< [m] to the door
};

Approach approach(double ahead) {
  Approach seen;
  Rig rig;
  rig.inputs().goal->T_map_goal.x = 14.0;
  rig.run(3.5);
  const Playground ground = doorAt(rig.pose().x + kVehicle.front + ahead);
  rig.paint(ground);
  for (int i = 0; i < 50; ++i) {
    const int wanted = nextOf(rig);
    const int64_t count = keptBy(rig);
    rig.run(0.05);
    seen.closest = std::min(seen.closest, ground.clearance(kVehicle, rig.pose()));
    if (keptBy(rig) == count) continue;
    ++seen.kept;
    const bool begun = !rig.supervisor().program().running().empty() && rig.running().id == wanted;
    seen.kept_to_it += begun || nextOf(rig) == wanted ? 1 : 0;
  }
  return seen;
}

}  // namespace

TEST_CASE("Where only the margin for a new plan is missing the queued pattern continues") {
  int kept = 0;
  const int step = testing::effort(10) == 10 ? 1 : 3;
  for (int k = 8; k < 40; k += step) {
    const Approach seen = approach(0.1 * k);
    CAPTURE(k);
    CHECK(seen.kept_to_it == seen.kept);
    CHECK(seen.closest > 0.0);
    kept += seen.kept;
  }
  CHECK(step * kept > 5);
}

TEST_CASE("Standing boxed in there is no next pattern to keep to, not even one of the id 0") {
  PatternSetContent content = samplePatterns(2).content();
  content.patterns.front().id = 0;
  std::string why;
  const std::optional<PatternSet> set = PatternSet::make(std::move(content), why);
  REQUIRE(set.has_value());
  Playground ground;
  for (const double side : {-1.0, 1.0}) {
    ground.addWall({-1.0, side * 0.7}, {1.0, side * 0.7}, 0.1);
    ground.addWall({side, -0.7}, {side, 0.7}, 0.1);
  }
  Rig rig(ground);
  rig.supervisor().takeSet(*set);
  const Decision decision = rig.run(3.0);
  CHECK(decision.report.status != PlanStatus::kDriving);
  CHECK(!decision.report.reason.empty());
  CHECK(keptBy(rig) == 0);
}

namespace {

/// In front of a dead end: searches while driving are cut off before they find the way out.
Rig inDeadEnd() {
  Playground ground;
  ground.addWall({2.2, -2.0}, {2.2, 2.0});
  ground.addWall({-2.0, 2.0}, {2.2, 2.0});
  ground.addWall({-2.0, -2.0}, {2.2, -2.0});
  PlannerConfig config = usualPlanner();
  config.policy.driving_expansions = 64;
  config.policy.standing_expansions = 100'000;
  return Rig(ground, config);
}

bool arrives(Rig& rig, double seconds) {
  for (double t = 0.0; t < seconds; t += 0.5)
    if (rig.run(0.5).report.status == PlanStatus::kArrived) return true;
  return false;
}

}  // namespace

TEST_CASE("A plan that leads out of a dead end is kept where the next search is cut off") {
  Rig rig = inDeadEnd();
  CHECK(arrives(rig, 60.0));
  CHECK(rig.supervisor().counters().count("kept to its plan") == 1);
}

TEST_CASE("A plan is not kept where what runs already ends in the goal") {
  Rig rig = inDeadEnd();
  const auto plans_on_from_rest = [&] {
    const ExecutionTracker& program = rig.supervisor().program();
    return !program.running().empty() && !program.next().empty() &&
           program.running().pattern().exit_class == "rest";
  };
  for (int i = 0; i < 600 && !plans_on_from_rest(); ++i) rig.run(0.05);
  REQUIRE(plans_on_from_rest());
  rig.inputs().goal = Goal{2, rig.pose(), 3.0, 4.0};
  CHECK(arrives(rig, 10.0));
}
