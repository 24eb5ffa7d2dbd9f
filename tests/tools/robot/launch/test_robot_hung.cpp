// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The simulated robot under tread-launch; its processes hang one after another while it drives.
#include <catch2/catch.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"
#include "tests/tools/robot/launch/launched.hpp"

using namespace tread;
using namespace tread::testing;

namespace {

/// A robot started by tread-launch, and `run`, which operates it.
class LaunchedRobot {
 public:
  LaunchedRobot()
      : folder_("/tmp/tread_hung_" + std::to_string(getpid())),
        url_(launchedLcmUrl() + "&recv_buf_size=2097152"),
        launch_("tread-launch",
                {TREAD_SOURCE_DIR "/config/launch/simulated.yaml", "--run", folder(), "--lcm-url",
                 url_, "--set", "laser_port=" + std::to_string(30000 + (getpid() * 7) % 20000),
                 "--set", "record=" + folder_ + "/truth.csv"},
                output()) {
    const bool all_run = within(30.0, [this] {
      return contentOf(output()).find("all 8 processes run after") != std::string::npos;
    });
    INFO(contentOf(output()));
    REQUIRE(all_run);
    // it starts no processes itself
    run = std::make_unique<RobotRun>(kYard, "[0, 0, 0]", "", url_);
  }
  ~LaunchedRobot() {
    launch_.signal(SIGINT);
    launch_.waitFor(20.0);
    std::filesystem::remove_all(folder_);
  }
  LaunchedRobot(const LaunchedRobot&) = delete;
  LaunchedRobot& operator=(const LaunchedRobot&) = delete;

  bool says(const std::string& text, double seconds) {
    return run->until(seconds, [&] { return contentOf(output()).find(text) != std::string::npos; });
  }
  /// From the supervisor's log: the last one started under this name.
  int pidOf(const std::string& process) const {
    const std::string log = contentOf(folder() + "/log/supervisor.log");
    const std::string mark = "spawned: '" + process + "' with pid ";
    const size_t at = log.rfind(mark);
    return at == std::string::npos ? 0 : std::stoi(log.substr(at + mark.size()));
  }
  std::vector<sim::TruthRow> truth() const { return sim::readTruthRecord(folder_ + "/truth.csv"); }

  std::unique_ptr<RobotRun> run;

 private:
  std::string folder() const { return folder_ + "/run"; }
  std::string output() const {
    std::filesystem::create_directories(folder_);
    return folder_ + "/launch.txt";
  }

  std::string folder_;
  std::string url_;
  Process launch_;
};

double seconds(int64_t from, int64_t to) {
  return 1e-6 * static_cast<double>(to - from);
}

}  // namespace

TEST_CASE(
    "a process that hangs while the robot drives is named, ended and back, and nothing moves "
    "unasked") {
  LaunchedRobot robot;
  RobotRun& run = *robot.run;
  const std::set<std::string> needed{"planner", "mapping", "ins-driver", "motor-bridge"};
  double x = 3.0;
  for (const std::string process :
       {"planner", "learner", "mapping", "logger", "ins-driver", "motor-bridge"}) {
    INFO(process);
    x = 15.0 - x;
    run.setGoal(x, 3.0);
    REQUIRE(run.arm(20.0));
    REQUIRE(run.untilDriving(30.0, [&] { return run.driving(); }));
    const int first = robot.pidOf(process);
    REQUIRE(first > 0);
    const int64_t halted = run.now();
    kill(first, SIGSTOP);
    CHECK(robot.says(process + " hangs: no sign of life for ", 15.0));
    const int64_t named = run.now();
    CHECK(run.until(10.0, [&] { return robot.pidOf(process) != first; }));
    const int64_t back = run.now();
    std::printf("%s: named after %.2f s, started again after %.2f s", process.c_str(),
                seconds(halted, named), seconds(halted, back));
    CHECK(seconds(halted, back) < (process == "logger" ? 13.0 : 5.0));
    run.wait(2.0);
    const auto zero = zeroAfter(robot.truth(), halted, 1'000'000);
    // Without learner or logger it drives on to its goal.
    if (needed.count(process) > 0) {
      REQUIRE(zero.has_value());
      std::printf(", motors at zero after %.2f s", seconds(halted, *zero));
      CHECK(seconds(halted, *zero) < 1.0);
      for (const sim::TruthRow& row : robot.truth())
        CHECK((row.utime < *zero || row.motorsAtZero()));
      // A process that only observes returns without a person, but needs another goal. A stall of
      // the machine that delays the INS is a different stop.
      const std::string& why = run.motor().message().state_reason;
      INFO(why);
      if (process == "mapping") {
        CHECK((run.armed() || why.rfind("INS is stale", 0) == 0));
      } else {
        CHECK_FALSE(run.armed());
      }
    }
    std::printf("\n");
  }
}
