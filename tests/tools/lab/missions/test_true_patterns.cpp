// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The omniscient robot: how it gets the true patterns, and how others are compared with it.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

#include <unistd.h>

#include "modules/simulator/core/terrain.hpp"
#include "tests/helpers.hpp"
#include "tests/tools/lab/missions/shipped_robot.hpp"
#include "tools/lab/missions/comparison_report.hpp"
#include "tools/lab/missions/referee.hpp"
#include "tools/lab/missions/robot_system.hpp"

using namespace tread;
using namespace tread::missions;

namespace {

const TruePatterns& truePatterns() {
  static const TruePatterns patterns(teodor().learner.shipped, teodor().simulated.vehicle);
  return patterns;
}

/// Drives a mission on one level surface with a fixed set; returns its measured executions.
std::vector<ScoredExecution> driveOn(const std::string& surface, const PatternSet& set) {
  RobotConfig robot = teodor();
  robot.learner.shipped = set;
  MissionWorld world = makeMissionWorld(8, {0.65, 0.65, 0.34});
  world.description.base_surface = surface;
  world.description.regions.clear();
  world.description.terrain.waves.clear();
  RobotSystem system(robot, world.description, world.T_map_start, 8, "off", {});
  Operator person(system.bus().outside(), world.T_map_goal);
  Referee watch(system, world);
  while (!watch.ended()) {
    system.bus().runUntil(system.bus().now() + 50'000);
    person.step(system.bus().now());
    watch.step();
  }
  std::vector<ScoredExecution> measured;
  for (const ScoredExecution& execution : watch.result().executions)
    if (execution.measured) measured.push_back(execution);
  return measured;
}

double meanErrorOn(const std::string& surface, const PatternSet& set) {
  const std::vector<ScoredExecution> executions = driveOn(surface, set);
  REQUIRE(executions.size() > 15);
  double sum = 0.0;
  for (const ScoredExecution& execution : executions) sum += execution.error_position;
  return sum / static_cast<double>(executions.size());
}

MissionResult arrivedAfter(uint64_t seed, double seconds) {
  MissionResult result;
  result.seed = seed;
  result.outcome = MissionOutcome::kArrived;
  result.begun = 3.0;
  result.time = 3.0 + seconds;
  return result;
}

using tread::testing::contentOf;

}  // namespace

TEST_CASE("true patterns keep commands and classes of the shipped ones on every surface") {
  const PatternSet& shipped = teodor().learner.shipped;
  for (const sim::SurfaceParameters& surface : sim::builtInSurfaces()) {
    CAPTURE(surface.name);
    const PatternSet set = truePatterns().on(surface.name, 7);
    CHECK(set.version() == 7);
    REQUIRE(set.patterns().size() == shipped.patterns().size());
    for (size_t i = 0; i < set.patterns().size(); ++i) {
      const MotionPattern& pattern = set.patterns()[i];
      CHECK(pattern.commands == shipped.patterns()[i].commands);
      CHECK(pattern.entry_class == shipped.patterns()[i].entry_class);
      CHECK(pattern.end_covariance[0] >= 0.0);
      CHECK(pattern.end_covariance[5] >= 0.0);
    }
  }
  const auto turnOn = [](const char* surface) {
    return truePatterns().on(surface, 1).findByName("hard_left")->end().yaw;
  };
  // The calibrated yaw gains of the surfaces: 1.22 and 0.89.
  CHECK(turnOn("grass") / turnOn("cinder") == Approx(1.2230 / 0.8896).epsilon(0.05));
  CHECK_THROWS_AS(truePatterns().on("mud", 1), std::out_of_range);
}

TEST_CASE("what is driven errs less from the true patterns than from the shipped ones") {
  const double with_true = meanErrorOn("grass", truePatterns().on("grass", 1));
  const double with_shipped = meanErrorOn("grass", teodor().learner.shipped);
  CAPTURE(with_true, with_shipped);
  CHECK(with_true < 0.055);
  CHECK(with_true < 0.7 * with_shipped);
}

TEST_CASE("the omniscient robot gets another set where the ground becomes another one") {
  const uint64_t seed = 8;
  const MissionWorld world = makeMissionWorld(seed, {0.65, 0.65, 0.34});
  RobotSystem system(teodor(), world.description, world.T_map_start, seed, "", {},
                     {&truePatterns()});
  Operator person(system.bus().outside(), world.T_map_goal);
  Referee watch(system, world);
  PatternSetAssembler sets;
  std::optional<PatternSet> newest;
  system.bus().outside().subscribe<pattern_set_part_t>(kPatternSet,
                                                       [&](const pattern_set_part_t& part) {
                                                         if (auto set = sets.add(part))
                                                           newest = std::move(set);
                                                       });
  const Latest<plan_t> plan(system.bus().outside(), kPlan);
  std::string surface;
  int64_t since = 0;
  bool always_true = true, always_planned = true;
  while (!watch.ended()) {
    system.bus().runUntil(system.bus().now() + 50'000);
    person.step(system.bus().now());
    watch.step();
    const std::string& present = system.robot().truth().surface;
    if (present != surface) since = system.bus().now();
    surface = present;
    if (system.bus().now() - since < 100'000) continue;
    const PatternSet expected = truePatterns().on(surface, newest->version());
    always_true = always_true && newest && newest->checksum() == expected.checksum();
    if (system.bus().now() - since < 400'000 || plan.message().num_patterns == 0) continue;
    always_planned = always_planned && plan.message().set_version == newest->version();
  }
  CHECK(watch.result().outcome == MissionOutcome::kArrived);
  CHECK(watch.result().set_versions >= 2);
  CHECK(watch.result().executions.empty());  // there is no learner
  CHECK(always_true);
  CHECK(always_planned);
}

TEST_CASE("times are compared from the first motion, where both arrive") {
  OmniscientComparison comparison;
  for (uint64_t seed = 1; seed <= 11; ++seed) {
    comparison.learning.results.push_back(arrivedAfter(seed, 40.0 + static_cast<double>(seed)));
    comparison.omniscient.results.push_back(arrivedAfter(seed, 40.0));
  }
  comparison.omniscient.results[10].outcome = MissionOutcome::kRefused;
  const std::vector<TimeRatio> ratios = timeRatios(comparison);
  REQUIRE(ratios.size() == 10);
  CHECK(quantileOf(ratios, 0.5) == Approx(45.0 / 40.0));
  CHECK(quantileOf(ratios, 0.9) == Approx(49.0 / 40.0));
  CHECK(quantileOf(ratios, 1.0) == Approx(50.0 / 40.0));
  CHECK(ratios.back().seed == 10);
  CHECK(std::isnan(quantileOf({}, 0.5)));
  std::ostringstream text;
  printOmniscient(text, comparison);
  CHECK(text.str().find("both in 10") != std::string::npos);
  CHECK(text.str().find("median 1.125, p90 1.225, worst 1.250") != std::string::npos);
  const std::string path = "omniscient_" + std::to_string(getpid()) + ".json";
  writeOmniscient(path, comparison);
  const std::string json = contentOf(path);
  std::remove(path.c_str());
  for (const char* key : {"both_arrived", "time_ratio", "median", "p90", "learning", "omniscient"})
    CHECK(json.find('"' + std::string(key) + "\":") != std::string::npos);
}

TEST_CASE("what is set on the command line stands in the place of the robot's files") {
  const std::string folder = std::string(TREAD_SOURCE_DIR) + "/config/robots/teodor";
  const RobotConfig robot =
      readRobot(folder, {"planner.margins.growth=0", "learner.rule=collective"});
  CHECK(teodor().planner.map.margins.growth > 0.0);
  CHECK(robot.planner.map.margins.growth == 0.0);
  CHECK(robot.learner.rule.rule == "collective");
  CHECK_THROWS_WITH(readRobot(folder, {"planer.margins.growth=0"}),
                    Catch::Contains("--set planer.margins.growth=0") && Catch::Contains("planner"));
  CHECK_THROWS_WITH(readRobot(folder, {"planner"}), Catch::Contains("PROCESS.KEY=VALUE"));
  CHECK_THROWS_WITH(readRobot(folder, {"planner.margins.growth=-1"}), Catch::Contains("growth"));
  CHECK_THROWS_WITH(readRobot(folder, {"lidar_driver.device=carmen"}),
                    Catch::Contains("lidar_driver.yaml") &&
                        Catch::Contains("no range finder 'carmen' can be simulated"));
}
