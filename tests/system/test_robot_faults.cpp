// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <csignal>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>

#include "common/messages/blank.hpp"
#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"
#include "tools/robot/launch/stall_watch.hpp"

namespace tread::testing {
namespace {

constexpr int64_t kHold = 1'000'000;  // [us] the motors must stay at zero
constexpr double kWorstStall = 0.05;  // [s] of the machine in a valid measurement
constexpr int kTrials = 4;

/// Starts the robot if necessary, and brings it to steady driving over the field, at whose end it
/// turns around: one robot is used for several faults.
void driveOff(RobotRun& run) {
  if (!run.running("planner")) run.startAll();
  const bool back = run.ins().any() && run.ins().message().position[0] > 5.0;
  run.setGoal(back ? -30.0 : 30.0, 0.0);
  if (!run.armed()) REQUIRE(run.arm(20.0));
  const auto drives = [&] { return run.driving() && run.motor().message().command[0] > 0.3; };
  REQUIRE(run.untilDriving(20.0, drives));
  run.wait(1.0);
  REQUIRE(run.untilDriving(20.0, drives));
}

/// Waits until the motors stand; returns the time since `from` [s], -1 = never.
double standsAfter(RobotRun& run, int64_t from, double seconds) {
  std::optional<int64_t> zero;
  run.until(seconds, [&] {
    run.wait(0.2);
    zero = zeroAfter(run.truth(), from, kHold);
    return zero.has_value();
  });
  return zero ? static_cast<double>(*zero - from) * 1e-6 : -1.0;
}

void mustObeyEstop(RobotRun& run) {
  auto stop = blank<estop_t>();
  stop.utime = run.now();
  stop.engaged = true;
  const int64_t stopped = run.now();
  run.bus().publish(kEstop, stop);
  const double stands = standsAfter(run, stopped, 5.0);
  CHECK(stands >= 0.0);
  CHECK(stands <= 0.25);
}

/// Nothing moves for some seconds although the goal is repeated; after arming it drives again.
void needsArming(RobotRun& run) {
  const int64_t from = run.now();
  run.wait(3.0);
  for (const sim::TruthRow& row : run.truth()) {
    if (row.utime > from) REQUIRE(row.motorsAtZero());
  }
  REQUIRE(run.arm(20.0));
  CHECK(run.untilDriving(20.0, [&] { return run.driving(); }));
}

/// The end of the process's last permission, from messages that the test received [us].
using Reference = std::function<int64_t(RobotRun& run, int64_t killed)>;

/// Kills or freezes a process of the driving robot: the motors must stand within a limit [s] after
/// the reference, until it is armed again. Learned data are kept. It then drives on.
void mustStop(RobotRun& run, const std::string& process, int how, double limit,
              const Reference& reference) {
  for (int trial = 1; trial <= kTrials; ++trial) {
    driveOff(run);
    const int64_t set = run.lastSet();
    double stands = -1.0;
    double stall = 0.0;
    {
      const launch::StallWatch watch;
      run.signal(process, how);
      const int64_t killed = run.now();
      run.wait(0.05);  // receive its earlier messages now
      stands = standsAfter(run, reference(run, killed), 5.0);
      stall = watch.longest();
    }
    // If the machine itself stalled, the time is not the robot's.
    const bool counts = stall <= kWorstStall || trial == kTrials;
    INFO(process << " by signal " << how << ": " << stands << " s, machine's stall " << stall);
    CHECK(stands >= 0.0);
    if (counts) CHECK(stands <= limit);
    run.forgetSet();
    if (how == SIGKILL)
      run.start(process);
    else
      run.signal(process, SIGCONT);
    needsArming(run);
    REQUIRE(run.untilDriving(10.0, [&] { return run.lastSet() != 0; }));
    CHECK(run.lastSet() >= set);
    if (counts) return;
  }
}

/// Kills the simulator, which closes all device lines; then starts it again.
void mustOutliveItsLines(RobotRun& run) {
  driveOff(run);
  run.signal("simulator", SIGKILL);
  CHECK(run.until(5.0, [&] { return !run.driving(); }));
  run.wait(2.0);
  CHECK(run.motor().message().bridge_state != motor_t::STATE_DRIVING);
  run.start("simulator");
  run.wait(3.0);
  for (const sim::TruthRow& row : run.truth()) REQUIRE(row.motorsAtZero());
  REQUIRE(run.arm(30.0));
  CHECK(run.untilDriving(30.0, [&] { return run.driving(); }));
  INFO(run.plan().message().reason << "; " << run.motor().message().state_reason);
  for (const std::string& name : RobotRun::names()) {
    INFO(name << ": " << run.output(name));
    CHECK(run.running(name));
  }
}

/// tread-goal operates, and is killed or frozen; after thawing it must not continue by itself.
void mustStopWithoutOperator(RobotRun& run, int how) {
  for (int trial = 1; trial <= kTrials; ++trial) {
    driveOff(run);
    run.leaveTo(run.ins().message().position[0] > 5.0 ? -30.0 : 30.0, 1.0);
    run.wait(1.5);
    const bool drove = run.driving();
    const launch::StallWatch watch;
    const int64_t killed = run.now();
    run.signal("operator", how);
    const double stands = standsAfter(run, killed, 5.0);
    const bool counts = (drove && watch.longest() <= kWorstStall) || trial == kTrials;
    INFO("by signal " << how << ": " << stands << " s, machine's stall " << watch.longest());
    if (counts) {
      CHECK(stands > 0.5);
      CHECK(stands <= 1.25);
      CHECK_THAT(run.motor().message().state_reason, Catch::Contains("the operator is lost: test"));
    }
    run.signal("operator", SIGCONT);
    const int64_t from = run.now();
    run.wait(3.0);
    for (const sim::TruthRow& row : run.truth())
      if (row.utime > from) REQUIRE(row.motorsAtZero());
    run.takeBack();
    REQUIRE(run.arm(20.0));
    run.wait(2.0);
    CHECK_FALSE(run.driving());
    run.setGoal(30.0, 0.0);
    CHECK(run.untilDriving(20.0, [&] { return run.driving(); }));
    if (counts) return;
  }
}

}  // namespace

TEST_CASE("a killed or frozen operator's program: the motors stand within its lease and 250 ms") {
  RobotRun run(kField, "[-20, 0, 0]");
  for (const int how : {SIGKILL, SIGSTOP}) mustStopWithoutOperator(run, how);
}

TEST_CASE(
    "a killed or frozen planner, motor bridge, INS driver, and all lines closed: it stands "
    "in time, needs arming, and drives on") {
  RobotRun run(kField, "[-20, 0, 0]");
  for (const int how : {SIGKILL, SIGSTOP}) {
    // Within the planner's lease plus 250 ms.
    mustStop(run, "planner", how, 0.45,
             [](RobotRun& robot, int64_t) { return robot.program().message().utime; });
    // By the controller's own watchdog.
    mustStop(run, "motor_bridge", how, 0.25, [](RobotRun&, int64_t killed) { return killed; });
  }
  // At once.
  mustStop(run, "ins_driver", SIGKILL, 0.25,
           [](RobotRun& robot, int64_t) { return robot.ins().message().utime; });
  mustOutliveItsLines(run);
}

TEST_CASE("a killed or frozen learner: the robot drives on for seconds, then stops and says why") {
  RobotRun run(kField, "[-20, 0, 0]");
  for (const int how : {SIGKILL, SIGSTOP}) {
    driveOff(run);
    const int64_t set = run.lastSet();
    std::string reason;
    // A stall of the machine may stop the robot for another reason; it is then armed again.
    const auto lost = [&] {
      if (run.plan().message().reason.find("the learner is lost") != std::string::npos)
        reason = run.plan().message().reason;
      return !reason.empty() && !run.driving();
    };
    const int64_t killed = run.now();
    run.signal("learner", how);
    CHECK(run.untilDriving(20.0, lost));
    INFO(reason);
    CHECK(run.now() - killed > 4'000'000);
    CHECK(run.armed());  // it was no failsafe
    run.forgetSet();
    if (how == SIGKILL)
      run.start("learner");
    else
      run.signal("learner", SIGCONT);
    CHECK(run.until(20.0, [&] { return run.lastSet() != 0; }));
    CHECK(run.lastSet() >= set);
    const int64_t back = run.lastSet();
    // With a running learner it drives on and learns.
    CHECK(run.untilDriving(20.0, [&] { return run.driving() && run.lastSet() > back; }));
    for (const auto& [name, health] : run.health()) {
      INFO(name << ": " << health.health_reason);
      CHECK(run.running(name));
    }
  }
}

TEST_CASE(
    "the host's date jumps by an hour and back by two, then no descriptors are left: it drives on "
    "and is stopped as ever") {
  RobotRun run(kField, "[-20, 0, 0]");
  const std::string file = run.folder() + "/clock";
  std::ofstream(file) << std::string(sizeof(int), '\0');
  const auto jumpTo = [&file](int seconds) {
    // In place: the processes have mapped the file.
    std::fstream clock(file, std::ios::binary | std::ios::in | std::ios::out);
    clock.write(reinterpret_cast<const char*>(&seconds), sizeof seconds);
    REQUIRE(clock.flush());
  };
  const std::vector<std::string> jumping{"/usr/bin/env", "LD_PRELOAD=" JUMPING_CLOCK,
                                         "JUMPING_CLOCK=" + file};
  for (const std::string& name : RobotRun::names()) run.startBehind(jumping, name);
  driveOff(run);
  for (const int seconds : {3600, -3600}) {
    const double from = run.ins().message().position[0];
    const int armed_again = run.armedAgain();
    jumpTo(seconds);
    Process date("/usr/bin/env", {jumping[1], jumping[2], "/bin/date", "+%s"}, file + ".log");
    REQUIRE(date.waitFor(5.0));
    CHECK(run.untilDriving(20.0, [&] { return run.ins().message().position[0] > from + 3.0; }));
    CHECK(run.armed());
    CHECK(run.armedAgain() == armed_again);
    for (const std::string& name : RobotRun::names()) CHECK(run.running(name));
  }
  int64_t ahead = 0;
  int64_t behind = 0;
  std::ifstream(file + ".log") >> ahead >> behind;
  CHECK(ahead - behind > 7000);
  for (const std::string& name : RobotRun::names()) {
    Process limit("/usr/bin/prlimit", {"--pid", std::to_string(run.pid(name)), "--nofile=3:3"});
    REQUIRE(limit.waitFor(5.0));
    REQUIRE(limit.exitCode() == 0);
  }
  const double from = run.ins().message().position[0];
  CHECK(run.untilDriving(20.0, [&] { return run.ins().message().position[0] > from + 5.0; }));
  for (const std::string& name : RobotRun::names()) CHECK(run.running(name));
  mustObeyEstop(run);
}

TEST_CASE("a full disk stops neither the robot nor its learning, and is told, room again is used") {
  // A separate disk for the learner's state, in a mount namespace.
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
    const int64_t set = run.lastSet();
    return run.untilDriving(20.0, [&] { return run.lastSet() > set; });
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
  CHECK(run.untilDriving(5.0, [&] { return run.driving(); }));
  REQUIRE(onDisk("rm " + disk + "/filler"));
  CHECK(learnsOn());
  CHECK(run.until(10.0, [&] { return state().health_state == health_t::HEALTH_OK; }));
}

}  // namespace tread::testing
