// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "common/bus/virtual_bus.hpp"
#include "modules/planner/planner_node.hpp"
#include "tests/planner/kit/vehicle.hpp"
#include "tests/planner/kit/yard.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

TEST_CASE(
    "Armed and given a goal the node drives the robot there, joining patterns without a gap") {
  Yard yard;
  yard.run(1.5);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(3.0);
  CHECK(yard.plan.plan_status == plan_t::PLAN_DRIVING);
  CHECK(yard.robot().speed() > 0.8);
  yard.run(20.0);
  CHECK(yard.plan.plan_status == plan_t::PLAN_ARRIVED);
  CHECK(std::abs(yard.robot().pose().x - 10.0) < 0.5);
  CHECK(yard.robot().aborted() == 0);
  const auto& records = yard.robot().records();
  REQUIRE(records.size() > 5);
  for (size_t i = 1; i < records.size(); ++i) {
    CHECK(records[i].record_execution_id > records[i - 1].record_execution_id);
    if (i < records.size() / 2) CHECK(records[i].started == records[i - 1].ended);
  }
}

TEST_CASE("PROGRAM comes at 20 Hz whatever happens, PLAN at 5 Hz, PLAN_TREE with the plan") {
  Yard yard;
  yard.run(5.0);
  CHECK(yard.programs >= 98);
  CHECK(yard.programs <= 101);
  CHECK(yard.plans >= 24);
  CHECK(yard.plan.plan_status == plan_t::PLAN_IDLE);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(4.0);
  CHECK(yard.longest_silence <= 60'000 + yard.start);
  REQUIRE(yard.tree.num_nodes > 3);
  CHECK(yard.tree.parent[0] == -1);
  REQUIRE(yard.tree.num_best > 1);
  REQUIRE(yard.plan.num_patterns > 2);
  CHECK(yard.plan.set_version == 1);
  CHECK(yard.health.health_state == health_t::HEALTH_OK);
}

TEST_CASE("The node comes up disarmed: a permission from before its start counts for nothing") {
  Yard yard;
  yard.run(1.0);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(3.0);
  REQUIRE(yard.robot().speed() > 0.5);
  const int64_t old_run = yard.run_id;
  yard.bus.restart("planner");
  yard.sendGoal(10.0);
  yard.run(4.0);
  CHECK(std::abs(yard.robot().speed()) < 0.01);
  CHECK(yard.plan.plan_status == plan_t::PLAN_WAITING);
  CHECK(yard.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK(yard.health.health_reason == "not armed since the planner's start");
  // The toy bridge remembers ids of the old run: here only the new run's id matters.
  yard.armAndGo();
  yard.run(0.3);
  CHECK(yard.run_id > old_run);
}

TEST_CASE("A goal between an ARM that the bridge refuses and one that it takes moves nothing") {
  Yard yard;
  yard.run(1.0);
  yard.robot().takes_arm = false;
  yard.arm();
  yard.run(0.5);
  yard.sendGoal(10.0);
  yard.run(0.3);
  yard.robot().takes_arm = true;
  yard.arm();
  yard.run(3.0);
  CHECK(yard.robot().program().running.execution_id == 0);
  CHECK(yard.plan.reason == "the goal was given before the arming: give it again");
  yard.renewGoal();
  yard.sendGoal(10.0);
  yard.run(1.0);
  CHECK(yard.robot().program().running.execution_id != 0);
}

TEST_CASE("Whom the bridge has armed for holds the robot, whoever was heard first") {
  Yard yard;
  OperatorBeacon first(yard.bus.outside(), "another");
  yard.operator_there = false;
  const auto run = [&](double seconds) {
    for (double t = 0.0; t < seconds; t += 0.05) {
      first.step(yard.bus.now());
      yard.run(0.05);
    }
  };
  run(1.0);  // the planner takes this operator as the holder
  yard.operator_there = true;
  run(1.0);
  yard.arm(true, "a test (test)");
  run(0.2);
  yard.renewGoal();
  yard.sendGoal(10.0);
  run(2.0);
  CHECK(yard.robot().program().running.execution_id != 0);
  first.standFor(777);
  yard.beacon.standFor(1);
  yard.goal_id = 777;
  yard.sendGoal(-10.0);
  run(2.0);
  CHECK(yard.plan.goal_id != 777);
}

TEST_CASE("When the time jumps, as at the start of a real process, an earlier permission is void") {
  // The time of a passive process starts near zero.
  DrivingPermission permission(300'000);
  arm_t arm{};
  arm.armed = true;
  arm.utime = 1'000'000'000;
  permission.take(arm, arm.utime + 100'000);
  REQUIRE(permission.armed());
  permission.restart(arm.utime + 150'000);
  CHECK_FALSE(permission.armed());
  permission.take(arm, arm.utime + 200'000);
  CHECK_FALSE(permission.armed());
  arm.utime += 200'000;
  permission.take(arm, arm.utime);
  CHECK(permission.armed());
}

TEST_CASE("PROGRAM says what the planner had heard, a broken message does not count") {
  VirtualBus bus(1);
  bus.addNode("planner",
              [](Bus& end) { return std::make_unique<PlannerNode>(usualPlanner(), end); });
  const Latest<program_t> program(bus.outside(), kProgram);
  const auto run = [&bus] { bus.runUntil(bus.now() + 100'000); };
  run();
  CHECK(program.message().inputs_heard == 0);
  CHECK(program.message().newest_input.empty());
  CHECK(program.message().newest_input_seq == -1);
  arm_t arm{};
  arm.utime = bus.now();
  bus.outside().publish(kArm, arm);
  goal_t goal{};
  goal.utime = bus.now() - 7;
  goal.seq = 41;
  bus.outside().publish(kGoal, goal);
  const uint8_t broken = 1;
  bus.inject(kMotor.name, &broken, 1);
  run();
  CHECK(program.message().inputs_heard == 2);
  CHECK(program.message().newest_input == "GOAL");
  CHECK(program.message().newest_input_utime == goal.utime);
  CHECK(program.message().newest_input_seq == 41);
  bus.node("planner")->shutdown(bus.now());
  run();
  CHECK(program.message().inputs_heard == 2);
  bus.restart("planner");
  run();
  CHECK(program.message().inputs_heard == 0);
  CHECK(program.message().newest_input.empty());
}

TEST_CASE("Disarming and an emergency stop empty the program in the next step") {
  for (const bool estop : {true, false}) {
    Yard yard;
    yard.run(1.0);
    yard.sendGoal(10.0);
    yard.armAndGo();
    yard.run(3.0);
    REQUIRE(yard.robot().program().running.execution_id != 0);
    if (estop)
      yard.estop(true);
    else
      yard.arm(false);
    yard.run(0.1);
    CHECK(yard.robot().program().running.execution_id == 0);
    CHECK(yard.robot().program().next.execution_id == 0);
    yard.run(1.0);
    CHECK(yard.robot().program().running.execution_id == 0);
    if (estop) {
      CHECK(yard.plan.plan_status == plan_t::PLAN_STOPPED);
      yard.estop(false);
      yard.run(1.0);
      CHECK(yard.robot().program().running.execution_id == 0);
    }
    yard.arm();
    yard.run(2.0);
    // Arming alone moves nothing: the goal is older.
    CHECK(yard.robot().program().running.execution_id == 0);
    CHECK_THAT(yard.plan.reason, Catch::Contains("then give the goal again"));
    yard.renewGoal();
    yard.sendGoal(10.0);
    yard.run(2.0);
    CHECK(yard.robot().program().running.execution_id != 0);
  }
}

TEST_CASE("Without INS the node empties the program and says how old it is") {
  Yard yard;
  yard.run(1.0);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(3.0);
  yard.robot().ins_alive = false;
  yard.run(0.3);
  CHECK(yard.robot().program().running.execution_id == 0);
  CHECK(yard.plan.reason.find("stopped: INS is") == 0);
}

TEST_CASE("Blind for half a second: the program is emptied, and the view's return moves nothing") {
  Yard yard;
  yard.run(1.0);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(3.0);
  REQUIRE(yard.robot().speed() > 0.5);
  yard.robot().map_alive = false;
  yard.run(0.65);
  CHECK(yard.robot().program().running.execution_id == 0);
  CHECK(yard.plan.reason.find("stopped: MAP is ") == 0);
  yard.robot().map_alive = true;
  yard.run(5.0);
  CHECK(std::abs(yard.robot().speed()) < 0.01);
  yard.renewGoal();
  yard.sendGoal(10.0);
  yard.run(1.0);
  CHECK(yard.robot().speed() > 0.3);
}

TEST_CASE("A range finder that mapping does not believe: zero at once, disarmed, a new goal") {
  Yard yard;
  std::optional<arm_t> disarmed;
  yard.bus.outside().subscribe<arm_t>(kArm, [&](const arm_t& message) {
    if (message.armed == 0) disarmed = message;
  });
  yard.run(1.0);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(3.0);
  REQUIRE(yard.robot().speed() > 0.5);
  health_t health{};
  health.process = "mapping";
  health.health_state = health_t::HEALTH_DEGRADED;
  yard.bus.outside().publish(kHealth, health);
  health.process = "learner";
  health.health_state = health_t::HEALTH_FAILED;
  yard.bus.outside().publish(kHealth, health);
  yard.run(0.2);
  REQUIRE(yard.robot().program().running.execution_id != 0);
  health.process = "mapping";
  health.health_reason = "range finder: it is frozen";
  yard.bus.outside().publish(kHealth, health);
  yard.run(0.1);
  CHECK(yard.robot().program().running.execution_id == 0);
  CHECK_THAT(yard.plan.reason, Catch::Contains("stopped: mapping: range finder: it is frozen"));
  REQUIRE(disarmed);
  CHECK(disarmed->armed_by == "planner");
  CHECK(disarmed->arm_reason == "mapping: range finder: it is frozen");
  yard.run(1.0);
  // Meanwhile the robot must not drive blindly.
  yard.armAndGo();
  yard.sendGoal(10.0);
  yard.run(1.0);
  CHECK(yard.robot().program().running.execution_id == 0);
  health.health_state = health_t::HEALTH_OK;
  yard.bus.outside().publish(kHealth, health);
  yard.run(3.0);
  yard.renewGoal();
  yard.sendGoal(10.0);
  yard.run(1.0);
  CHECK(yard.robot().speed() > 0.3);
}

TEST_CASE("A tile of another cell size does not empty the map in use") {
  Yard yard;
  yard.run(1.0);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(2.0);
  map_tile_t tile{};
  tile.tile_cells = 8;
  tile.num_cells = 64;
  tile.cells.assign(64, kFree);
  tile.cell_size = 0.31;
  for (int i = 0; i < 20; ++i) {
    tile.utime = yard.bus.now();
    yard.bus.outside().publish(kMap, tile);
    yard.run(0.1);
    REQUIRE(yard.robot().speed() > 0.3);
  }
  yard.run(1.0);
  int64_t refused = 0;
  for (const counter_t& counter : yard.health.counters)
    if (counter.counter_name.find("another cell size") != std::string::npos)
      refused = counter.counted;
  CHECK(refused == 20);
}

TEST_CASE(
    "With a third of MOTOR, EXECUTION and INS lost it still arrives, and nothing is aborted") {
  FaultPlan faults;
  for (const char* channel : {"MOTOR", "EXECUTION", "INS", "MAP", "PATTERN_SET"}) {
    MessageFault fault;
    fault.channel = channel;
    fault.drop = 0.33;
    faults.messages.push_back(fault);
  }
  Yard yard(faults);
  yard.run(4.0);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(30.0);
  CHECK(yard.plan.plan_status == plan_t::PLAN_ARRIVED);
  CHECK(yard.robot().aborted() == 0);
}

TEST_CASE("Messages that make no sense are counted and change nothing") {
  Yard yard;
  yard.run(1.5);
  yard.sendGoal(std::numeric_limits<double>::quiet_NaN());
  yard.sendGoal(10.0, -1.0);
  map_tile_t tile{};
  tile.utime = yard.bus.now();
  tile.tile_cells = 32;
  tile.num_cells = 32 * 32;
  tile.cells.assign(32 * 32, kObstacle);
  // With a cell of 1.1 mm one tile once occupied the planner for 50 s.
  for (const double size : {std::numeric_limits<double>::quiet_NaN(), 0.0011, 0.51}) {
    tile.cell_size = size;
    yard.bus.outside().publish(kMap, tile);
  }
  tile.utime += 60'000'000;
  yard.bus.outside().publish(kMap, tile);
  yard.run(2.0);
  CHECK(yard.plan.plan_status == plan_t::PLAN_IDLE);
  std::map<std::string, int64_t> counters;
  for (const counter_t& counter : yard.health.counters)
    counters[counter.counter_name] = counter.counted;
  CHECK(counters["GOAL refused: invalid pose or tolerances"] == 2);
  CHECK(counters["MAP refused: invalid sizes"] == 3);
  CHECK(counters["MAP refused: from the future"] == 1);
}

TEST_CASE("A time before all clocks is refused: no age overflows, and nothing is allowed by it") {
  VirtualBus bus(7);
  bus.addNode("planner",
              [](Bus& end) { return std::make_unique<PlannerNode>(usualPlanner(), end); });
  plan_t plan{};
  std::map<std::string, int64_t> counters;
  bus.outside().subscribe<plan_t>(kPlan, [&](const plan_t& message) { plan = message; });
  bus.outside().subscribe<health_t>(kHealth, [&](const health_t& message) {
    for (const counter_t& counter : message.counters)
      counters[counter.counter_name] = counter.counted;
  });
  const auto send = [&bus](const auto& channel, auto message, int64_t utime) {
    message.utime = utime;
    bus.outside().publish(channel, message);
  };
  ins_t ins{};
  ins.orientation[0] = 1.0;
  arm_t arm{};
  arm.armed = true;
  goal_t goal{};
  goal.goal_id = 1;
  goal.position_tolerance = 0.5;
  goal.yaw_tolerance = 4.0;
  for (const int64_t utime : {std::numeric_limits<int64_t>::min(), int64_t{-1}, int64_t{0}}) {
    send(kIns, ins, utime);
    send(kMotor, motor_t{}, utime);
    send(kExecution, execution_t{}, utime);
    send(kArm, arm, utime);
    send(kGoal, goal, bus.now());
    operator_t person{};
    person.operator_name = "test";
    person.allowed = operator_t::ALLOW_DRIVING;
    person.stands_for = goal.goal_id;
    person.seen_utime = bus.now();
    send(kOperator, person, bus.now());
    bus.runUntil(bus.now() + 1'000'000);
    CHECK(plan.plan_status == plan_t::PLAN_WAITING);
    CHECK(plan.reason == "no usable INS yet");
  }
  bus.runUntil(bus.now() + 1'000'000);
  CHECK(counters["INS refused: no such time"] == 3);
  CHECK(counters["MOTOR refused: no such time"] == 3);
  CHECK(counters["EXECUTION refused: no such time"] == 3);
}

TEST_CASE("The sender of a goal is killed: the goal ends with its lease, and stays dead") {
  Yard yard;
  yard.run(1.0);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(3.0);
  REQUIRE(yard.robot().speed() > 0.5);
  // Another program of the same name still holds the robot.
  OperatorBeacon other(yard.bus.outside(), "test");
  yard.operator_there = false;
  const auto run = [&](double seconds) {
    for (double t = 0.0; t < seconds; t += 0.05) {
      other.step(yard.bus.now());
      yard.run(0.05);
    }
  };
  run(1.3);
  CHECK(yard.robot().program().running.execution_id == 0);
  CHECK(yard.plan.reason == "the operator who gave the goal is gone: give it again");
  // After thawing an ended goal must not continue by itself.
  yard.operator_there = true;
  yard.sendGoal(10.0);
  run(3.0);
  CHECK(yard.robot().program().running.execution_id == 0);
  yard.renewGoal();
  yard.sendGoal(10.0);
  run(1.0);
  CHECK(yard.robot().program().running.execution_id != 0);
}

TEST_CASE(
    "`go_back`: with its operator lost the robot returns, and obeys when the operator is back") {
  PlannerConfig config = usualPlanner();
  config.operators.lost = OperatorLost::kGoBack;
  Yard yard({}, config);
  yard.run(3.0);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(6.0);
  REQUIRE(yard.robot().speed() > 0.5);
  yard.operator_there = false;
  yard.run(1.3);
  CHECK(yard.robot().program().running.execution_id == 0);
  yard.run(1.5);
  const double lost_at = yard.robot().pose().x;
  yard.run(2.0);
  CHECK(yard.plan.goal_id < 0);
  CHECK(yard.plan.reason.rfind("the operator is lost: returning to where the link was good", 0) ==
        0);
  CHECK(yard.health.health_state == health_t::HEALTH_DEGRADED);
  yard.run(10.0);
  CHECK(yard.robot().pose().x < lost_at - 2.0);
  yard.operator_there = true;
  yard.renewGoal();
  yard.sendGoal(10.0);
  yard.run(1.0);
  CHECK(yard.plan.goal_id == yard.goal_id);
  yard.run(3.0);
  const double turned_at = yard.robot().pose().x;
  yard.run(3.0);
  CHECK(yard.robot().pose().x > turned_at);
}

TEST_CASE("A fence from anybody closes the way, and opens it again for who holds the robot") {
  Yard yard;
  const auto fence = [&](const std::string& by, bool removes) {
    const Fence yard_of_6_m{"yard", false, {{-6, -6}, {6, -6}, {6, 6}, {-6, 6}}};
    yard.bus.outside().publish(kFence, toMessage(FenceRequest{by, removes, yard_of_6_m}));
    yard.run(1.2);
    const std::vector<Fence> kept = fencesFrom(yard.fences);
    return std::count(kept.begin(), kept.end(), yard_of_6_m);
  };
  yard.run(1.5);
  yard.sendGoal(10.0);
  yard.armAndGo();
  CHECK(fence("stranger", false) == 1);
  yard.run(10.0);
  CHECK(yard.robot().pose().x < 5.0);
  CHECK(yard.plan.plan_status == plan_t::PLAN_UNREACHABLE);
  CHECK(yard.plan.reason == "the goal lies outside of what fence yard allows");
  CHECK(fence("stranger", true) == 1);
  CHECK(fence("test", true) == 0);
  yard.run(25.0);
  CHECK(yard.plan.plan_status == plan_t::PLAN_ARRIVED);
}

TEST_CASE("Operators' fences are kept over a restart of the planner, and removed ones are gone") {
  Yard yard;
  const auto send = [&](const std::string& name, bool removes) {
    const Fence fence{name, true, {{4, -60}, {5, -60}, {5, 60}, {4, 60}}};
    yard.bus.outside().publish(kFence, toMessage(FenceRequest{"test", removes, fence}));
    yard.run(1.2);
  };
  yard.run(1.5);
  send("first", false);
  send("second", false);
  send("first", true);
  yard.bus.kill("planner");
  yard.bus.restart("planner");
  yard.run(1.5);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(5.0);
  CHECK(yard.robot().pose().x < 3.5);
  const auto inForce = [&yard](const std::string& name) {
    const std::vector<Fence> kept = fencesFrom(yard.fences);
    return std::any_of(kept.begin(), kept.end(),
                       [&name](const Fence& fence) { return fence.name == name; });
  };
  CHECK(inForce("second"));
  CHECK_FALSE(inForce("first"));
  yard.store.failWith("disk full");
  send("third", false);
  CHECK(yard.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK(yard.health.health_reason == "fences not kept for the next start: disk full");
  yard.store.failWith("");
  yard.run(1.5);
  yard.bus.kill("planner");
  yard.bus.restart("planner");
  yard.run(1.5);
  CHECK(inForce("third"));
}

TEST_CASE(
    "Kept fences that are missing, empty or damaged: nothing drives before a person has looked") {
  Yard yard;
  const auto say = [&](bool removes, const Fence& fence) {
    yard.bus.outside().publish(kFence, toMessage(FenceRequest{"test", removes, fence}));
    yard.run(1.2);
  };
  const Fence pond{"pond", true, {{4, -60}, {5, -60}, {5, 60}, {4, 60}}};
  yard.run(1.5);
  say(false, pond);
  const std::string entry = "fences_of_holders", text = *yard.store.read(entry);
  yard.bus.kill("planner");
  SECTION("missing") {
    yard.store.remove(entry);
  }
  SECTION("empty") {
    yard.store.write(entry, "");
  }
  SECTION("truncated") {
    yard.store.write(entry, text.substr(0, text.size() - 4));
  }
  SECTION("a digit is another one") {
    std::string other = text;
    other[text.find("60")] = '5';
    yard.store.write(entry, other);
  }
  yard.bus.restart("planner");
  const std::string line =
      "kept fences are lost: set them anew, then tread-fence lost_fences --remove";
  for (int restarts = 0; restarts < 2; ++restarts) {
    yard.run(1.5);
    yard.sendGoal(2.0);
    yard.armAndGo();
    yard.run(4.0);
    CHECK(std::abs(yard.robot().pose().x) < 0.01);
    CHECK(yard.plan.reason == line);
    CHECK(yard.health.health_state == health_t::HEALTH_DEGRADED);
    CHECK(yard.health.health_reason == line);
    // Not all of them: a new fence does not imply that the others exist.
    say(false, pond);
    yard.bus.kill("planner");
    yard.bus.restart("planner");
  }
  yard.run(1.5);
  say(true, lostFences());
  yard.bus.kill("planner");
  yard.bus.restart("planner");
  yard.run(1.5);
  yard.sendGoal(2.0);
  yard.armAndGo();
  yard.run(6.0);
  CHECK(yard.robot().pose().x > 1.4);
  CHECK(yard.health.health_state == health_t::HEALTH_OK);
}

TEST_CASE("A goal out of a log moves nothing, and takes nothing from the goal of today") {
  Yard yard;
  yard.run(1.0);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(3.0);
  const int64_t goal = yard.plan.goal_id;
  REQUIRE(yard.robot().speed() > 0.5);
  // An hour old, and, from before a reboot, with accidentally matching times.
  for (const int64_t age : {3'600'000'000LL, 0LL}) {
    goal_t old{};
    old.utime = yard.bus.now() - age;
    old.goal_id = 4711;
    old.goal_pose[1] = 5.0;
    old.position_tolerance = 0.5;
    old.yaw_tolerance = 4.0;
    operator_t person{};
    person.station = 99;
    person.operator_name = "yesterday";
    person.allowed = operator_t::ALLOW_DRIVING;
    person.utime = person.seen_utime = old.utime;
    person.stands_for = old.goal_id;
    for (int i = 0; i < 20; ++i) {
      yard.bus.outside().publish(kOperator, person);
      yard.bus.outside().publish(kGoal, old);
      yard.run(0.05);
    }
    CHECK(yard.plan.goal_id == goal);
    CHECK(yard.robot().aborted() == 0);
  }
}

TEST_CASE("A version that no learner can have come to is refused, and the learner's goes on") {
  Yard yard;
  const auto forge = [&](int64_t version, int times) {
    for (int i = 0; i < times; ++i, yard.run(0.05))
      for (pattern_set_part_t& part : toMessages(samplePatterns(version)))
        yard.bus.outside().publish(kPatternSet, part);
  };
  const int64_t version = GENERATE(1'000'000'000'000'000, 1'000'000'000'001, 500'000'000'000,
                                   1'000'000, std::numeric_limits<int64_t>::max());
  yard.run(0.01);
  // Before the learner is received only the general range of versions is known.
  if (version > PatternSet::kHighestVersion) forge(version, 3);
  yard.run(1.5);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(1.0);
  CHECK(yard.plan.set_version == 1);
  forge(version, 60);
  CHECK(yard.plan.set_version == 1);
  CHECK(yard.robot().speed() > 0.3);
  CHECK(yard.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK_THAT(yard.health.health_reason,
             Catch::Contains(std::to_string(version) + " is published beside 1, which is in use"));
  yard.run(8.0);
  CHECK(yard.health.health_state == health_t::HEALTH_OK);
  CHECK(yard.plan.set_version == 1);
}

TEST_CASE(
    "A learner that has lost its state and begins far above is followed once it goes on alone") {
  Yard yard;
  const auto tell = [&](int64_t version, double seconds) {
    for (double t = 0.0; t < seconds; t += 0.5, yard.run(0.5))
      for (pattern_set_part_t& part : toMessages(samplePatterns(version)))
        yard.bus.outside().publish(kPatternSet, part);
  };
  yard.robot().learner_alive = false;
  tell(7, 2.0);
  CHECK(yard.plan.set_version == 7);
  tell(7 + 100'000, 0.5);  // its reserve
  CHECK(yard.plan.set_version == 7 + 100'000);
  tell(90'000'000'000, 3.0);
  CHECK(yard.plan.set_version == 7 + 100'000);
  tell(90'000'000'000, 4.0);
  CHECK(yard.plan.set_version == 90'000'000'000);
  tell(1'000'000'100'000, 4.0);
  CHECK(yard.plan.set_version == 90'000'000'000);
  tell(1'000'000'100'000, 4.0);  // above the highest acceptable value
  CHECK(yard.plan.set_version == 1'000'000'100'000);
  yard.run(6.0);
  tell(1'000'000'200'001, 0.5);
  CHECK(yard.plan.set_version == 1'000'000'100'000);
}

TEST_CASE("A second learner is told: its older versions are ignored, and the planner drives on") {
  Yard yard;
  yard.run(1.5);
  yard.sendGoal(10.0);
  yard.armAndGo();
  yard.run(2.0);
  for (pattern_set_part_t& part : toMessages(samplePatterns(101)))
    yard.bus.outside().publish(kPatternSet, part);
  yard.run(5.0);
  CHECK(yard.plan.set_version == 101);
  CHECK(yard.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK_THAT(yard.health.health_reason, Catch::Contains("does a second learner run?"));
  CHECK(yard.robot().speed() > 0.3);
}

TEST_CASE("GRIP that no ground can have is refused, and one that nobody felt lifts no limit") {
  Yard yard;
  yard.run(1.5);
  const auto say = [&](double deceleration, bool gave_way, int signs) {
    grip_t message{};
    message.utime = yard.bus.now();
    message.seq = yard.seq++;
    message.deceleration = deceleration;
    message.gave_way = static_cast<int8_t>(gave_way);
    message.grip_signs = signs;
    yard.bus.outside().publish(kGrip, message);
    yard.run(0.1);
  };
  for (const double impossible : {0.0, -1.0, 100.0, std::numeric_limits<double>::quiet_NaN()})
    say(impossible, true, 1);
  yard.run(1.1);
  int64_t refused = 0;
  for (const counter_t& counter : yard.health.counters)
    if (counter.counter_name == "GRIP refused: no such deceleration") refused = counter.counted;
  CHECK(refused == 4);
  say(0.4, true, 3);
  say(1.0, false, 0);
  const auto* node = dynamic_cast<PlannerNode*>(yard.bus.node("planner"));
  REQUIRE(node != nullptr);
  CHECK(node->supervisor().grip().gave_way);
  CHECK(node->supervisor().grip().deceleration == 0.4);
  say(2.0, false, 5);
  CHECK(node->supervisor().grip().deceleration == 2.0);
  CHECK(node->supervisor().grip().signs == 5);
}
