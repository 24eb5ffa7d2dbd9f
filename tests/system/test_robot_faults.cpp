// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <csignal>
#include <filesystem>

#include <catch2/catch.hpp>

#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"

namespace tread::testing {
namespace {

constexpr int64_t kHold = 1'000'000;  // [us] for which the motors must stay at zero

/// Starts the robot and brings it to a steady drive over the field.
void driveOff(RobotRun& run) {
  run.startAll();
  run.setGoal(30.0, 0.0);
  REQUIRE(run.arm(20.0));
  REQUIRE(
      run.until(20.0, [&] { return run.driving() && run.motor().message().command_left > 0.3; }));
  run.wait(1.0);
  REQUIRE(run.driving());
}

/// Waits until the motors stand and says how long after `from` they did [s]; -1 = never.
double standsAfter(RobotRun& run, int64_t from, double seconds) {
  std::optional<int64_t> zero;
  run.until(seconds, [&] {
    run.wait(0.2);
    zero = zeroAfter(run.truth(), from, kHold);
    return zero.has_value();
  });
  return zero ? static_cast<double>(*zero - from) * 1e-6 : -1.0;
}

/// Nothing moves for some seconds although the goal still comes; after arming it drives again.
void needsArming(RobotRun& run) {
  const int64_t from = run.now();
  run.wait(3.0);
  for (const sim::TruthRow& row : run.truth()) {
    if (row.utime > from) REQUIRE(row.motorsAtZero());
  }
  REQUIRE(run.arm(20.0));
  CHECK(run.until(20.0, [&] { return run.driving(); }));
}

}  // namespace

TEST_CASE("a killed or frozen planner: the motors stand within the lease and 250 ms") {
  for (const int how : {SIGKILL, SIGSTOP}) {
    RobotRun run(kField, "[-20, 0, 0]");
    driveOff(run);
    const int64_t set = run.newestSet();
    run.signal("planner", how);
    const int64_t last_program = run.program().message().utime;
    const double stands = standsAfter(run, last_program, 5.0);
    INFO("signal " << how << ": " << stands << " s after the last PROGRAM");
    CHECK(stands >= 0.0);
    CHECK(stands <= 0.45);
    if (how == SIGKILL)
      run.start("planner");
    else
      run.signal("planner", SIGCONT);
    needsArming(run);
    CHECK(run.newestSet() >= set);
  }
}

TEST_CASE("a killed or frozen motor bridge: the controller's own watchdog stops the motors") {
  for (const int how : {SIGKILL, SIGSTOP}) {
    RobotRun run(kField, "[-20, 0, 0]");
    driveOff(run);
    const int64_t killed = run.now();
    run.signal("motor_bridge", how);
    const double stands = standsAfter(run, killed, 5.0);
    INFO("signal " << how << ": " << stands << " s");
    CHECK(stands >= 0.0);
    CHECK(stands <= 0.30);
    if (how == SIGKILL)
      run.start("motor_bridge");
    else
      run.signal("motor_bridge", SIGCONT);
    needsArming(run);
  }
}

TEST_CASE("a killed INS driver: the motors stand at once, and arming is needed") {
  RobotRun run(kField, "[-20, 0, 0]");
  driveOff(run);
  const int64_t last_ins = run.ins().message().utime;
  run.signal("ins_driver", SIGKILL);
  const double stands = standsAfter(run, last_ins, 5.0);
  INFO(stands << " s after the last INS");
  CHECK(stands >= 0.0);
  CHECK(stands <= 0.45);
  run.start("ins_driver");
  needsArming(run);
}

TEST_CASE("a killed or frozen learner: the robot drives on for seconds, then stops and says why") {
  for (const int how : {SIGKILL, SIGSTOP}) {
    RobotRun run(kField, "[-20, 0, 0]");
    driveOff(run);
    const int64_t set = run.newestSet();
    run.signal("learner", how);
    run.wait(2.0);
    CHECK(run.driving());
    CHECK(run.until(15.0, [&] { return !run.driving(); }));
    CHECK_THAT(run.plan().message().reason, Catch::Contains("the learner is lost"));
    if (how == SIGKILL)
      run.start("learner");
    else
      run.signal("learner", SIGCONT);
    // It was no failsafe: the permission stays, and with a living learner it drives on.
    CHECK(run.until(20.0, [&] { return run.driving() && run.newestSet() > set; }));
    for (const auto& [name, health] : run.health()) {
      INFO(name << ": " << health.health_reason);
      CHECK(run.running(name));
    }
  }
}

TEST_CASE("all lines to the devices closed and opened again: stop, come back, drive after arming") {
  RobotRun run(kField, "[-20, 0, 0]");
  driveOff(run);
  run.signal("simulator", SIGKILL);
  CHECK(run.until(5.0, [&] { return !run.driving(); }));
  run.wait(2.0);
  CHECK(run.motor().message().bridge_state != motor_t::STATE_DRIVING);
  run.start("simulator");
  run.wait(3.0);
  for (const sim::TruthRow& row : run.truth()) REQUIRE(row.motorsAtZero());
  REQUIRE(run.arm(30.0));
  CHECK(run.until(30.0, [&] { return run.driving(); }));
  INFO(run.plan().message().reason << "; " << run.motor().message().state_reason);
  for (const std::string& name : RobotRun::names()) {
    INFO(name << ": " << run.output(name));
    CHECK(run.running(name));
  }
}

TEST_CASE("a full disk stops neither the robot nor its learning, and is told; room again is used") {
  // A disk of its own for the learner's state, in a mount namespace.
  const std::vector<std::string> isolate =
      ::getuid() == 0
          ? std::vector<std::string>{"/usr/bin/unshare", "--mount"}
          : std::vector<std::string>{"/usr/bin/unshare", "--user", "--map-root-user", "--mount"};
  {
    std::vector<std::string> words(isolate.begin() + 1, isolate.end());
    words.push_back("true");
    Process attempt(isolate.front(), words);
    if (!attempt.waitFor(5.0) || attempt.exitCode() != 0) {
      WARN("skipped: no mount namespace is allowed here");
      return;
    }
  }
  RobotRun run(kField, "[-20, 0, 0]");
  const std::string disk = run.folder() + "/state";
  std::filesystem::create_directories(disk);
  std::vector<std::string> wrapper = isolate;
  wrapper.insert(
      wrapper.end(),
      {"/bin/sh", "-c", "mount -t tmpfs -o size=256k tread " + disk + " && exec \"$@\"", "sh"});
  for (const std::string& name : RobotRun::names()) {
    if (name == "learner")
      run.startBehind(wrapper, name);
    else
      run.start(name);
  }
  run.setGoal(30.0, 0.0);
  REQUIRE(run.arm(20.0));
  const auto learnsOn = [&run] {
    const int64_t set = run.newestSet();
    return run.until(20.0, [&] { return run.newestSet() > set; });
  };
  REQUIRE(learnsOn());
  const auto onDisk = [&](const std::string& command) {
    std::vector<std::string> words{"--target", std::to_string(run.pid("learner")), "--mount"};
    if (::getuid() != 0) words.insert(words.end(), {"--user", "--preserve-credentials"});
    words.insert(words.end(), {"/bin/sh", "-c", command});
    Process inside("/usr/bin/nsenter", words);
    return inside.waitFor(5.0) && inside.exitCode() == 0;
  };
  REQUIRE(onDisk("head -c 1M /dev/zero > " + disk + "/filler || true"));
  CHECK(learnsOn());
  CHECK(learnsOn());
  const auto state = [&run] { return run.health().at("learner"); };
  CHECK(run.until(5.0, [&] { return state().health_state != health_t::HEALTH_OK; }));
  CHECK_THAT(state().health_reason, Catch::Contains("No space left"));
  CHECK(run.driving());
  REQUIRE(onDisk("rm " + disk + "/filler"));
  CHECK(learnsOn());
  CHECK(run.until(10.0, [&] { return state().health_state == health_t::HEALTH_OK; }));
}

}  // namespace tread::testing
