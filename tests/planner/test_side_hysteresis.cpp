// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/motion_planner.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <stdexcept>

#include "tests/planner/kit/closed_loop.hpp"
#include "tests/planner/kit/search_bench.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

/// Plans by their patterns' names; the ends of their steps do not matter here.
class Names {
 public:
  std::vector<int> ids(const std::vector<std::string>& names) const {
    std::vector<int> ids;
    for (const std::string& name : names) ids.push_back(id(name));
    return ids;
  }
  std::vector<PlanStep> plan(const std::vector<std::string>& names) const {
    std::vector<PlanStep> plan(names.size());
    for (size_t i = 0; i < names.size(); ++i) plan[i].pattern_id = id(names[i]);
    return plan;
  }
  int id(const std::string& name) const {
    for (const MotionPattern& pattern : set.patterns())
      if (pattern.name == name) return pattern.id;
    throw std::logic_error("no pattern " + name);
  }

  PatternSet set = samplePatterns();
  PatternTable table{set, usualSweep(), {}};
};

/// Committed to a plan from the start.
struct Committed : Names {
  explicit Committed(const std::vector<std::string>& names) {
    side_hysteresis.take(plan(names), table);
  }
  std::vector<int> opposedBy(const std::vector<std::string>& names) const {
    return side_hysteresis.opposedBy(plan(names), table);
  }

  SideHysteresis side_hysteresis{SideHysteresisConfig{}};
};

SearchResult resultOf(SearchEnd end, double cost, double expected) {
  SearchResult result;
  result.end = end;
  result.cost = cost;
  result.expected = expected;
  return result;
}

/// A boulder on the straight line, with slightly more space to its left or right.
Grid boulder(double aside) {
  Playground ground;
  ground.add({{5.0, aside, 0.0}, 0.6, 0.6});
  return ground.paint(0.1, {-4.0, -8.0}, {16.0, 8.0});
}

/// Number of plans that changed the side of a boulder during a drive.
struct SideChanges {
  int count = 0;
  DriveOutcome outcome;
};

/// Drives towards a boulder with very noisy poses, for which either side may be shorter.
SideChanges driveAtBoulder(double gain, uint64_t seed) {
  SideChanges changes;
  const PatternSet set = samplePatterns();
  Mission mission;
  mission.ground.add({{9.0, 0.0, 0.0}, 0.5, 0.5});
  mission.goal = {1, {18.0, 0.0, 0.0}, 0.5, 4.0};
  DriveOptions options;
  options.seed = seed;
  options.errors.pose_noise = 0.06;
  options.config.side_hysteresis.gain = gain;
  options.config.search.switch_penalty = 0.0;
  options.config.search.horizon = 9.0;  // so far ahead that plans pass the boulder
  double side = 0.0;
  options.on_decision = [&](double, const Decision& decision) {
    // Side on which the plan passes the boulder.
    for (const PlanStep& step : decision.report.steps) {
      const Pose2& end = step.T_map_end;
      if (end.x < 8.0 || end.x > 10.0 || std::abs(end.y) < 0.5) continue;
      if (side * end.y < 0.0) ++changes.count;
      side = end.y;
      break;
    }
  };
  changes.outcome = driveMission(mission, set, options);
  return changes;
}

}  // namespace

TEST_CASE("A plan opposes the committed one only if it turns to the other side") {
  const Committed committed({"straight", "left", "right"});
  CHECK(committed.opposedBy({"right", "left"}) == committed.ids({"straight", "left"}));
  CHECK(committed.opposedBy({"stop", "turn_right"}) == committed.ids({"straight", "left"}));
  CHECK(committed.opposedBy({"hard_left", "hard_right"}).empty());
  CHECK(committed.opposedBy({"straight", "straight"}).empty());
  CHECK(committed.opposedBy({}).empty());
}

TEST_CASE("Who is committed to nothing, or to straight on, may turn to any side") {
  CHECK(Committed({}).opposedBy({"right"}).empty());
  CHECK(Committed({"straight", "straight"}).opposedBy({"right"}).empty());
}

TEST_CASE("What turns only after the time looked ahead gives a plan no side") {
  CHECK(Committed({"straight", "straight", "straight", "straight", "left"})
            .opposedBy({"right"})
            .empty());
  const Committed soon({"straight", "straight", "left"});
  CHECK(soon.opposedBy({"right"}).size() == 3);
  CHECK(soon.opposedBy({"straight", "straight", "straight", "straight", "right"}).empty());
}

TEST_CASE("Patterns that begin as planned leave the side_hysteresis, and what follows them stays") {
  Committed committed({"straight", "left", "straight", "hard_right"});
  committed.side_hysteresis.begun(committed.id("straight"));
  CHECK(committed.opposedBy({"right"}) == committed.ids({"left"}));
  committed.side_hysteresis.begun(committed.id("left"));
  CHECK(committed.opposedBy({"left"}) == committed.ids({"straight", "hard_right"}));
}

TEST_CASE("Another pattern than planned ends the side_hysteresis, and so does forgetting it") {
  Committed committed({"straight", "left"});
  committed.side_hysteresis.begun(committed.id("straight_short"));
  CHECK(committed.opposedBy({"right"}).empty());
  Committed forgotten({"left"});
  forgotten.side_hysteresis.forget();
  CHECK(forgotten.opposedBy({"right"}).empty());
}

TEST_CASE("Left, straight on and right is a change of mind, too") {
  Committed committed({"straight", "left"});
  committed.side_hysteresis.take(committed.plan({"straight", "straight"}), committed.table);
  CHECK(committed.opposedBy({"right"}) == committed.ids({"straight", "left"}));
  committed.side_hysteresis.take(committed.plan({"right"}), committed.table);
  CHECK(committed.opposedBy({"left"}) == committed.ids({"right"}));
}

TEST_CASE("A pattern that the newest set does not know commits to nothing") {
  Committed committed({"left"});
  PatternSetContent content = committed.set.content();
  const int left = committed.id("left");
  content.patterns.erase(
      std::remove_if(content.patterns.begin(), content.patterns.end(),
                     [&](const MotionPattern& pattern) { return pattern.id == left; }),
      content.patterns.end());
  std::string why;
  const PatternTable table(*PatternSet::make(content, why), usualSweep(), {});
  CHECK(committed.side_hysteresis.opposedBy(committed.plan({"right"}), table).empty());
}

TEST_CASE("The other side must be better by the gain, whatever part of it is still ahead") {
  SideHysteresisConfig config;
  config.gain = 2.0;
  const SideHysteresis side_hysteresis(config);
  const SearchResult kept = resultOf(SearchEnd::kHorizon, 9.0, 20.0);
  CHECK(!side_hysteresis.isWorth(resultOf(SearchEnd::kHorizon, 8.0, 19.1), kept));
  CHECK(side_hysteresis.isWorth(resultOf(SearchEnd::kHorizon, 8.0, 18.9), kept));
  CHECK(side_hysteresis.isWorth(resultOf(SearchEnd::kGoal, 26.9, 0.0), kept));
  CHECK(!side_hysteresis.isWorth(resultOf(SearchEnd::kGoal, 27.1, 0.0), kept));
}

TEST_CASE("Plans that lead somewhere are worth a change where the committed one was cut off") {
  const SideHysteresis side_hysteresis{SideHysteresisConfig{}};
  const SearchResult whole = resultOf(SearchEnd::kHorizon, 9.0, 20.0);
  const SearchResult cut_off = resultOf(SearchEnd::kProgress, 1.0, 21.0);
  CHECK(side_hysteresis.isWorth(whole, cut_off));
  CHECK(!side_hysteresis.isWorth(cut_off, whole));
  CHECK(!side_hysteresis.isWorth(resultOf(SearchEnd::kProgress, 0.1, 20.5), cut_off));
  CHECK(side_hysteresis.isWorth(resultOf(SearchEnd::kProgress, 30.0, 5.0), cut_off));
  CHECK(side_hysteresis.isWorth(cut_off, SearchResult{}));
}

TEST_CASE("A search along a branch begins with it, also past the worse side of a boulder") {
  const Names names;
  const SearchBench bench(boulder(0.4), names.set, {1, {12.0, 0.0, 0.0}, 0.5, 4.0});
  PatternSearch search{SearchConfig{}};
  SearchProblem problem = bench.problem({0.0, 0.0, 0.0}, "cruise");
  const SearchResult free_choice = search.run(problem, after(5000));
  problem.branch = names.ids({"straight", "hard_left"});
  const SearchResult along = search.run(problem, after(5000));
  REQUIRE(along.steps.size() > 2);
  CHECK(along.steps[0].pattern_id == names.id("straight"));
  CHECK(along.steps[1].pattern_id == names.id("hard_left"));
  REQUIRE(free_choice.end != SearchEnd::kNothing);
  CHECK(along.end == free_choice.end);
  CHECK(free_choice.steps[1].pattern_id != names.id("hard_left"));
}

TEST_CASE("Along a branch that is not free, or cannot be joined, there is no plan") {
  const Names names;
  const SearchBench bench(boulder(0.0), names.set, {1, {12.0, 0.0, 0.0}, 0.5, 4.0});
  PatternSearch search{SearchConfig{}};
  SearchProblem problem = bench.problem({0.0, 0.0, 0.0}, "cruise");
  problem.branch = names.ids({"straight", "straight", "straight", "straight"});
  CHECK(search.run(problem, after(5000)).end == SearchEnd::kNothing);
  problem.branch = names.ids({"turn_left"});
  CHECK(search.run(problem, after(5000)).end == SearchEnd::kNothing);
}

TEST_CASE("For what was planned before the margin for checking is enough") {
  Playground ground;
  // 4 cm are left at the vehicle's side: less than a new plan needs.
  const FootprintSize size = kVehicle;
  ground.addWall({-3.0, size.half_width + 0.14}, {2.2, size.half_width + 0.14}, 0.2);
  Margins margins;
  margins.check = 0.01;
  margins.plan = margins.largest = 0.08;
  const Names names;
  const SearchBench bench(ground.paint(0.02, {-4.0, -4.0}, {12.0, 4.0}), names.set,
                          {1, {9.0, 0.0, 0.0}, 0.5, 4.0}, margins);
  REQUIRE(bench.collision_checker.freeLevel({}, CollisionChecker::kPlan) >=
          CollisionChecker::kCheck);
  REQUIRE(!bench.collision_checker.isFree(Pose2{}, CollisionChecker::kPlan));
  PatternSearch search{SearchConfig{}};
  SearchProblem problem = bench.problem({}, "cruise");
  const SearchResult fresh = search.run(problem, after(5000));
  CHECK((fresh.steps.empty() || fresh.steps[0].pattern_id != names.id("straight")));
  problem.branch = names.ids({"straight"});
  const SearchResult along = search.run(problem, after(5000));
  REQUIRE(!along.steps.empty());
  CHECK(along.steps[0].pattern_id == names.id("straight"));
}

TEST_CASE("Towards a boulder dead ahead noisy poses change the side once, not again and again",
          "[statistics]") {
  int free_changes = 0;
  int committed_changes = 0;
  for (uint64_t seed = 1; seed <= 2; ++seed) {
    const SideChanges committed = driveAtBoulder(SideHysteresisConfig{}.gain, seed);
    CHECK(committed.outcome.status == PlanStatus::kArrived);
    CHECK(committed.outcome.collisions == 0);
    CHECK(committed.count <= 1);
    committed_changes += committed.count;
    free_changes += driveAtBoulder(0.0, seed).count;
  }
  CHECK(committed_changes < free_changes);
}
