// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Whole missions in virtual time; only time and ground are simulated.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

#include <unistd.h>

#include "modules/simulator/emulators/nmea/nmea_ins_emulator.hpp"
#include "tests/helpers.hpp"
#include "tests/tools/lab/missions/shipped_robot.hpp"
#include "tools/lab/missions/referee.hpp"
#include "tools/lab/missions/report.hpp"
#include "tools/lab/missions/robot_system.hpp"

using namespace tread;
using namespace tread::missions;

namespace {

/// A mission that the test advances itself, with operator and referee.
struct Bench {
  explicit Bench(uint64_t seed, const FaultPlan& faults = {})
      : world(makeMissionWorld(seed, {0.65, 0.65, 0.34})),
        system(teodor(), world.description, world.T_map_start, seed, "collective", faults),
        watch(system, world),
        person(system.bus().outside(), world.T_map_goal) {
    system.bus().outside().subscribe<pattern_set_part_t>(
        kPatternSet, [this](const pattern_set_part_t& part) {
          if (part.set_version < version) version_went_back = true;
          version = std::max(version, part.set_version);
        });
    system.bus().outside().subscribe<motor_t>(kMotor,
                                              [this](const motor_t& message) { motor = message; });
  }

  /// Whether the motors get power now.
  bool turning() {
    const auto power = system.devices().motor().output(system.bus().now());
    return power[0] != 0.0 || power[1] != 0.0;
  }
  void run(double seconds) {
    const int64_t end = system.bus().now() + std::llround(seconds * 1e6);
    while (system.bus().now() < end && !watch.ended()) {
      system.bus().runUntil(system.bus().now() + 50'000);
      if (operator_there) person.step(system.bus().now());
      watch.step();
    }
  }
  void runToEnd() {
    while (!watch.ended()) run(1.0);
  }
  bool runUntilDriving(double at_most) {
    for (double t = 0.0; t < at_most; t += 0.05) {
      run(0.05);
      if (motor.bridge_state == motor_t::STATE_DRIVING && turning()) return true;
    }
    return false;
  }
  /// Seconds until the motors are at zero; negative if not within the limit.
  double secondsToZero(double limit) {
    const int64_t start = system.bus().now();
    while (turning()) {
      system.bus().runUntil(system.bus().now() + 1'000);
      if (static_cast<double>(system.bus().now() - start) * 1e-6 > limit) return -1.0;
    }
    return static_cast<double>(system.bus().now() - start) * 1e-6;
  }

  MissionWorld world;
  RobotSystem system;
  Referee watch;
  Operator person;
  bool operator_there = true;
  motor_t motor{};
  int64_t version = 0;
  bool version_went_back = false;
};

using tread::testing::contentOf;

std::string recordedMission(uint64_t seed, const FaultPlan& faults) {
  const std::string path = "test_missions_" + std::to_string(getpid()) + ".lcmlog";
  {
    LogWriter log(path);
    MissionOptions options;
    options.log = &log;
    options.faults = faults;
    runMission(teodor(), seed, options);
  }
  std::string bytes = contentOf(path);
  std::remove(path.c_str());
  return bytes;
}

FaultPlan lossyBus() {
  FaultPlan faults;
  MessageFault fault;
  fault.drop = 0.05;
  fault.duplicate = 0.03;
  fault.reorder = 0.05;
  fault.reorder_us = 60'000;
  fault.corrupt = 0.01;
  faults.messages.push_back(fault);
  return faults;
}

}  // namespace

TEST_CASE("a robot of another size drives by its configuration alone") {
  const RobotConfig small = readRobot(std::string(TREAD_SOURCE_DIR) + "/tests/data/robots/small");
  CHECK(small.planner.map.footprint.half_width == 0.31);
  CHECK(small.mapping.map.robot.rear == 0.3);
  MissionOptions options;
  options.shortest_line = 8.0;
  const MissionRun run = runMission(small, 8, options);
  CAPTURE(run.result.reason);
  CHECK(run.result.outcome == MissionOutcome::kArrived);
  CHECK(run.result.collisions() == 0);
}

TEST_CASE("robots with other instruments and controllers drive by their configuration alone") {
  MissionOptions options;
  options.shortest_line = 8.0;
  const std::vector<std::pair<std::string, std::vector<std::string>>> robots{
      {"skid4", {}},  // NovAtel; VESCs with speed control
      {"skid4", {"ins_driver.source=vectornav", "ins_driver.geoid_separation=47"}},
      {"skid4", {"ins_driver.source=xsens", "ins_driver.geoid_separation=47"}},
      {"car", {}},  // throttle and steering, which cannot turn on the spot
      {"small", {"motor_bridge.controller=sabertooth"}},
      {"small", {"motor_bridge.controller=vesc_can"}}};
  for (const auto& [name, overrides] : robots) {
    const RobotConfig robot =
        readRobot(std::string(TREAD_SOURCE_DIR) + "/tests/data/robots/" + name, overrides);
    const MissionRun run = runMission(robot, 8, options);
    CAPTURE(name, robot.ins_driver.source, robot.motor_bridge.controller, run.result.reason);
    CHECK(run.result.outcome == MissionOutcome::kArrived);
    CHECK(run.result.collisions() == 0);
  }
}

TEST_CASE("a mission drives from start to goal over changing ground without touching anything") {
  for (const uint64_t seed : {8u, 22u}) {
    CAPTURE(seed);
    const MissionRun run = runMission(teodor(), seed, {});
    CHECK(run.result.outcome == MissionOutcome::kArrived);
    CHECK(run.result.reason.empty());
    CHECK(run.result.collisions() == 0);
    CHECK(run.result.distance > run.result.straight_line - 1.5);
    CHECK(run.result.crossings.size() >= 1);
    CHECK(run.result.set_versions > 10);
    int measured = 0;
    for (const ScoredExecution& execution : run.result.executions)
      measured += execution.measured ? 1 : 0;
    CHECK(measured > 15);
    for (const Stop& stop : run.result.stops) CHECK_FALSE(stop.reason.empty());
    CHECK(run.result.driven > 20.0);
    CHECK(run.result.driven + run.result.begun < run.result.time + 0.1);
  }
}

TEST_CASE(
    "the same seed twice gives the same log, byte for byte, also with faults, another seed "
    "another") {
  const std::string first = recordedMission(22, lossyBus());
  REQUIRE(first.size() > 1'000'000);
  REQUIRE(first == recordedMission(22, lossyBus()));
  REQUIRE(first != recordedMission(8, lossyBus()));
}

TEST_CASE(
    "with dropped, doubled, reordered and corrupted messages a mission still ends well, and "
    "versions never go back") {
  Bench bench(22, lossyBus());
  bench.runToEnd();
  CAPTURE(bench.watch.result().reason);
  CHECK(bench.watch.result().outcome == MissionOutcome::kArrived);
  CHECK(bench.watch.result().collisions() == 0);
  CHECK_FALSE(bench.version_went_back);
}

TEST_CASE(
    "whichever node is killed while driving, the motors come to zero, and after a restart and "
    "arming it goes on") {
  // Limits from the kill: first the lease (200 ms) or the INS limit, then at most 250 ms.
  const std::map<std::string, double> limits{
      {"planner", 0.45}, {"ins_driver", 0.45}, {"motor_bridge", 0.27}};
  for (const std::string node :
       {"planner", "ins_driver", "motor_bridge", "learner", "mapping", "lidar_driver"}) {
    CAPTURE(node);
    Bench bench(8);
    REQUIRE(bench.runUntilDriving(20.0));
    bench.run(2.0);
    REQUIRE(bench.runUntilDriving(10.0));
    bench.system.bus().kill(node);
    if (limits.count(node) > 0) {
      const double zero = bench.secondsToZero(1.0);
      CHECK(zero >= 0.0);
      CHECK(zero <= limits.at(node));
    }
    bench.run(1.0);
    bench.system.bus().restart(node);
    bench.runToEnd();
    CAPTURE(bench.watch.result().reason);
    CHECK(bench.watch.result().outcome == MissionOutcome::kArrived);
    CHECK(bench.watch.result().collisions() == 0);
    CHECK_FALSE(bench.version_went_back);
  }
}

TEST_CASE(
    "a planner, an INS or a bridge that is gone needs explicit arming before anything moves "
    "again") {
  for (const std::string node : {"planner", "ins_driver", "motor_bridge"}) {
    CAPTURE(node);
    Bench bench(8);
    REQUIRE(bench.runUntilDriving(20.0));
    bench.operator_there = false;  // nobody arms any more
    bench.system.bus().kill(node);
    bench.run(1.0);
    bench.system.bus().restart(node);
    bench.run(5.0);
    CHECK_FALSE(bench.turning());
    CHECK(bench.motor.bridge_state != motor_t::STATE_DRIVING);
  }
}

TEST_CASE("without a learner the robot drives on for a while, then stands and says why") {
  Bench bench(8);
  REQUIRE(bench.runUntilDriving(20.0));
  std::string reason;
  bench.system.bus().outside().subscribe<plan_t>(kPlan, [&](const plan_t& plan) {
    if (plan.plan_status != plan_t::PLAN_DRIVING) reason = plan.reason;
  });
  bench.system.bus().kill("learner");
  bench.run(3.0);
  CHECK(bench.motor.bridge_state == motor_t::STATE_DRIVING);
  bench.run(8.0);
  CHECK_FALSE(bench.turning());
  CHECK(reason.find("the learner is lost") != std::string::npos);
}

TEST_CASE("a cut line to the motor controller stops the motors by the controller's own watchdog") {
  Bench bench(8);
  REQUIRE(bench.runUntilDriving(20.0));
  bench.system.connect("motor", false);
  const double zero = bench.secondsToZero(1.0);
  CHECK(zero >= 0.0);
  CHECK(zero <= 0.27);
  bench.run(2.0);
  bench.system.connect("motor", true);
  bench.runToEnd();
  CHECK(bench.watch.result().outcome == MissionOutcome::kArrived);
  CHECK(bench.person.rearmed() >= 1);
}

TEST_CASE(
    "garbage and silence of the INS stop the robot, and it goes on when the INS speaks again") {
  Bench bench(8);
  REQUIRE(bench.runUntilDriving(20.0));
  sim::NmeaInsFaults faults;
  SECTION("silence") {
    faults.silent = true;
  }
  SECTION("no fix") {
    faults.no_fix = true;
  }
  SECTION("every sentence corrupted") {
    faults.corrupt_share = 1.0;
  }
  auto& device = dynamic_cast<sim::NmeaInsEmulator&>(bench.system.devices().ins());
  device.setFaults(faults);
  const double zero = bench.secondsToZero(1.0);
  CHECK(zero >= 0.0);
  CHECK(zero <= 0.5);
  bench.run(2.0);
  device.setFaults({});
  bench.runToEnd();
  CHECK(bench.watch.result().outcome == MissionOutcome::kArrived);
}

TEST_CASE("a report says what happened, in text and in JSON") {
  MissionBatch batch;
  batch.seed = 8;
  batch.rule = "off";
  MissionOptions options;
  options.rule = "off";
  const MissionRun run = runMission(teodor(), 8, options);
  batch.virtual_time = run.virtual_time;
  batch.cpu_time = batch.wall_time = run.cpu_time;
  batch.results.push_back(run.result);
  // As after a corrupted message: not UTF-8.
  batch.results.back().reason = "bro\xff\xc0ken";
  CHECK(run.result.set_versions == 0);
  std::ostringstream text;
  printSummary(text, batch);
  CHECK(text.str().find("arrived      1  100.0 %") != std::string::npos);
  CHECK(text.str().find("per minute driven") != std::string::npos);
  CHECK(text.str().find("per mission, at most") != std::string::npos);
  const std::string crossings = crossingsOf(run.result);
  CHECK(std::count(crossings.begin(), crossings.end(), '\n') ==
        static_cast<std::ptrdiff_t>(run.result.crossings.size()));
  CHECK(crossings.find(run.result.crossings.at(0).to) != std::string::npos);
  const std::string path = "test_missions_" + std::to_string(getpid()) + ".json";
  writeJson(path, batch);
  const std::string json = contentOf(path);
  std::remove(path.c_str());
  for (const char* key : {"missions", "arrived", "refused", "idle", "stopped", "collisions",
                          "virtual_s", "wall_s", "seed", "runs", "result", "reason", "time_s",
                          "distance_m", "detour", "surface_changes", "crossings"})
    CHECK(json.find('"' + std::string(key) + "\":") != std::string::npos);
  for (const char* key : {"flips", "flips_per_min", "stops", "stops_per_mission", "stop_reasons",
                          "driven_s", "begun_s"})
    CHECK(json.find('"' + std::string(key) + "\":") != std::string::npos);
  CHECK_THROWS_WITH(writeJson("/nowhere/report.json", batch),
                    Catch::Contains("/nowhere/report.json"));
}

TEST_CASE("faults of every receiver are the robot's: the referee hears all as it was said") {
  FaultPlan faults;
  MessageFault fault;
  fault.channel = "LEARNING";  // no process of the robot subscribes to it
  fault.drop = 0.5;
  fault.corrupt = 0.5;
  faults.messages.push_back(fault);
  Bench clean(8), faulty(8, faults);
  clean.run(12.0);
  faulty.run(12.0);
  const auto expected = clean.watch.result().executions;
  const auto heard = faulty.watch.result().executions;
  REQUIRE(expected.size() >= 5);
  REQUIRE(heard.size() == expected.size());
  for (size_t i = 0; i < heard.size(); ++i) {
    CHECK(heard[i].time == expected[i].time);
    CHECK(heard[i].measured == expected[i].measured);
    if (heard[i].measured) CHECK(heard[i].error_position == expected[i].error_position);
  }
}

TEST_CASE("a mistyped fault file is one line with file and line") {
  const std::string path = "faults_" + std::to_string(getpid()) + ".yaml";
  std::ofstream(path) << "messages:\n  - channel: INS\n    dorp: 0.1\n";
  CHECK_THROWS_WITH(readFaultFile(path), Catch::Contains(path + ":3") && Catch::Contains("dorp"));
  std::ofstream(path) << "nodes:\n  - node: planer\n    kill_at_s: 10\n";
  CHECK_THROWS_WITH(readFaultFile(path),
                    Catch::Contains(path + ":2") && Catch::Contains("planner"));
  std::ofstream(path) << "messages:\n  - channel: INSS\n";
  CHECK_THROWS_WITH(readFaultFile(path), Catch::Contains(path + ":2") && Catch::Contains("SCAN"));
  std::ofstream(path) << "messages:\n  - channel: INS\n    receiver: planer\n";
  CHECK_THROWS_WITH(readFaultFile(path),
                    Catch::Contains(path + ":3") && Catch::Contains("planner"));
  std::remove(path.c_str());
}
