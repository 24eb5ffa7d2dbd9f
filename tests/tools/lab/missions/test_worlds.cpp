// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The kinds of world: what each one changes, and that the robot drives in it.
#include <catch2/catch.hpp>

#include <cstdio>

#include <unistd.h>

#include "tests/helpers.hpp"
#include "tests/tools/lab/missions/shipped_robot.hpp"
#include "tools/lab/missions/mission_runner.hpp"

using namespace tread;
using namespace tread::missions;

namespace {

RobotConfig robotIn(const std::string& kind) {
  RobotConfig robot = teodor();
  enterWorld(robot, kind);
  return robot;
}

MissionOptions shortMission() {
  MissionOptions options;
  options.shortest_line = 9.0;
  return options;
}

std::string recorded(const std::string& kind, uint64_t seed) {
  const std::string path = "test_worlds_" + std::to_string(getpid()) + ".lcmlog";
  {
    LogWriter log(path);
    MissionOptions options = shortMission();
    options.log = &log;
    runMission(robotIn(kind), seed, options);
  }
  std::string bytes = tread::testing::contentOf(path);
  std::remove(path.c_str());
  return bytes;
}

}  // namespace

TEST_CASE("the usual world changes nothing, and every kind has a name") {
  const RobotConfig usual = robotIn("usual");
  CHECK(usual.learner.shipped.checksum() == teodor().learner.shipped.checksum());
  CHECK(usual.simulated.vehicle.mass == teodor().simulated.vehicle.mass);
  CHECK_FALSE(usual.world.changesOnTheWay());
  CHECK(worldKinds() == std::vector<std::string>{"usual", "deep_sand", "dragging_track",
                                                 "dying_battery", "heavy_payload", "ice", "mud",
                                                 "other_machine", "rough"});
}

TEST_CASE("stretches of another ground lie on the borders, the rest of a seed's world stays") {
  const std::pair<const char*, const char*> kinds[] = {
      {"ice", "ice"}, {"mud", "mud"}, {"deep_sand", "sand"}};
  for (const auto& [name, surface] : kinds) {
    for (uint64_t seed = 1; seed <= 5; ++seed) {
      CAPTURE(name, seed);
      const FootprintSize& outline = teodor().simulated.vehicle.outline;
      const MissionWorld usual = makeMissionWorld(seed, outline);
      const MissionWorld world =
          makeMissionWorld(seed, outline, kShortestLine, robotIn(name).world);
      CHECK(world.T_map_goal.x == usual.T_map_goal.x);
      CHECK(world.description.obstacles.size() == usual.description.obstacles.size());
      REQUIRE_FALSE(sim::worldFault(world.description));
      const sim::World real(world.description);
      const auto at = [&](double share) {
        return real.surface((1.0 - share) * world.T_map_start.position() +
                            share * world.T_map_goal.position());
      };
      CHECK(at(0.0).name == usual.description.base_surface);
      int changes = 0;
      double stretches = 0.0;
      for (int i = 1; i <= 1000; ++i) {
        changes += at(i * 0.001).name == at((i - 1) * 0.001).name ? 0 : 1;
        stretches += at(i * 0.001).name == surface ? 0.001 : 0.0;
      }
      CHECK(changes == world.surface_changes);
      CHECK(stretches > 0.15);
      CHECK(stretches < 0.5);
    }
  }
}

TEST_CASE("in the other worlds the vehicle is another one, at once or on its way") {
  const sim::VehicleParameters& usual = teodor().simulated.vehicle;
  const RobotConfig payload = robotIn("heavy_payload");
  CHECK(payload.simulated.vehicle.mass == usual.mass + 120.0);
  CHECK(payload.simulated.vehicle.mass_ahead < 0.0);
  CHECK(vehicleOf(payload.world, usual) == nullptr);

  for (const std::string kind : {"dragging_track", "dying_battery"}) {
    CAPTURE(kind);
    const RobotConfig robot = robotIn(kind);
    CHECK(robot.world.changesOnTheWay());
    const auto vehicle = vehicleOf(robot.world, robot.simulated.vehicle);
    sim::TrackedVehicle as_ever(usual);
    const sim::Ground ground = sim::levelGround(sim::builtInSurfaces().front());
    double driven = 0.0;
    const auto drive = [&](double metres) {
      for (; driven < metres; driven += 1e-3 * vehicle->velocity().v_x) {
        vehicle->step({1.0, 1.0}, ground, 1e-3);
        as_ever.step({1.0, 1.0}, ground, 1e-3);
      }
    };
    drive(robot.world.after - 0.01);
    CHECK(vehicle->velocity().v_x == as_ever.velocity().v_x);
    drive(robot.world.after + 25.0);
    if (kind == "dragging_track") {
      CHECK(vehicle->velocity().omega > 0.1);
    } else {
      CHECK(vehicle->battery().voltage < as_ever.battery().voltage - 2.0);
      CHECK(vehicle->velocity().v_x < 0.95 * as_ever.velocity().v_x);
    }
  }
}

TEST_CASE("another machine's patterns go elsewhere under the same commands") {
  const PatternSet& own = teodor().learner.shipped;
  const PatternSet other = robotIn("other_machine").learner.shipped;
  REQUIRE(other.patterns().size() == own.patterns().size());
  for (size_t i = 0; i < own.patterns().size(); ++i) {
    CAPTURE(own.patterns()[i].name);
    CHECK(other.patterns()[i].name == own.patterns()[i].name);
    CHECK(other.patterns()[i].commands.size() == own.patterns()[i].commands.size());
  }
  CHECK(own.patterns()[0].trajectory.back().yaw == 0.0);
  CHECK(other.patterns()[0].trajectory.back().yaw < -0.1);
}

TEST_CASE("the robot arrives in every kind of world") {
  for (const std::string& kind : worldKinds()) {
    CAPTURE(kind);
    const MissionRun run = runMission(robotIn(kind), 5, shortMission());
    CAPTURE(run.result.reason);
    CHECK(run.result.outcome == MissionOutcome::kArrived);
    CHECK(run.result.collisions() == 0);
  }
}

TEST_CASE("the same seed gives the same bytes in a world that changes, others in another one") {
  const std::string first = recorded("dying_battery", 5);
  REQUIRE(first.size() > 300'000);
  CHECK(first == recorded("dying_battery", 5));
  CHECK(first != recorded("usual", 5));
}
