// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The robot on its own bus with tread-link, the operator on another host.
#include <catch2/catch.hpp>

#include <filesystem>
#include <regex>

#include "tests/helpers.hpp"
#include "tests/system/robot_run.hpp"
#include "tests/system/two_hosts.hpp"
#include "tests/system/worlds.hpp"
#include "tests/tools/called_program.hpp"

using namespace tread;
using namespace tread::testing;

namespace {

/// A program at the station, on the link's bus.
std::unique_ptr<Process> atStation(const TwoHosts& hosts, const std::string& name,
                                   const std::vector<std::string>& arguments,
                                   const std::string& output) {
  std::vector<std::string> words = hosts.atStation();
  const std::string program = words.front();
  words.erase(words.begin());
  words.push_back(std::string(TREAD_BIN_DIR) + "/" + name);
  words.insert(words.end(), arguments.begin(), arguments.end());
  words.insert(words.end(), {"--lcm-url", hosts.url()});
  return std::make_unique<Process>(program, words, output);
}

/// Messages per second of a channel, from tread-top; 0 if absent.
double rateOf(const std::string& seen, const std::string& channel) {
  std::smatch found;
  return std::regex_search(seen, found, std::regex("\n" + channel + " +([0-9.]+) "))
             ? std::stod(found[1].str())
             : 0.0;
}

}  // namespace

namespace {

/// The robot with tread-link, and its operator's programs at the station.
struct LinkedRobot {
  explicit LinkedRobot(TwoHosts& two_hosts)
      : hosts(two_hosts),
        link("tread-link",
             {"--config", std::string(TREAD_SOURCE_DIR) + "/config/robots/teodor/link.yaml",
              "--set", "station_url=" + hosts.url(), "--lcm-url", run.url()},
             folder.path("link.txt")) {
    run.startAll();
    REQUIRE(run.until(20.0, [&] { return run.plan().any() && run.ins().any(); }));
  }
  bool moves() const {
    return run.motor().message().command[0] != 0.0F || run.motor().message().command[1] != 0.0F;
  }
  /// Arms and sends a goal from the station; returns whether the robot drives then. A stall of a
  /// busy machine may disarm it; it is then repeated once.
  bool drive() {
    for (int i = 0; i < 4; ++i) {
      goal.reset();
      run.leaveTo(30.0, 0.0, {"/usr/bin/env", "true"});
      const auto arm = atStation(hosts, "tread-arm", {"--operator", "station", "--timeout", "20"},
                                 folder.path("arm.txt"));
      run.until(20.0, [&] { return !arm->running(); });
      if (arm->exitCode() != 0) continue;
      goal = atStation(hosts, "tread-goal", {"30", "0", "--quiet", "--operator", "station"},
                       folder.path("goal.txt"));
      if (run.until(10.0, [&] { return run.driving() && run.motor().message().command[0] > 0.3; }))
        return true;
    }
    return false;
  }

  const samples::OwnFolder folder;
  TwoHosts& hosts;
  RobotRun run{kField, "[-20, 0, 0]"};
  Process link;
  std::unique_ptr<Process> goal;
};

std::unique_ptr<TwoHosts> hostsOrSkip(const CableFaults& faults) {
  try {
    return std::make_unique<TwoHosts>(faults);
  } catch (const std::runtime_error& error) {
    WARN("skipped: " << error.what());
    return nullptr;
  }
}

}  // namespace

TEST_CASE("over the link crosses what is chosen, and a robot whose operator is cut off stops") {
  const auto hosts = hostsOrSkip({});
  if (!hosts) return;
  LinkedRobot robot(*hosts);
  REQUIRE(atStation(*hosts, "tread-top", {"--once", "2.5"}, robot.folder.path("top.txt"))
              ->waitFor(20.0));
  const std::string seen = contentOf(robot.folder.path("top.txt"));
  CAPTURE(seen, contentOf(robot.folder.path("link.txt")));
  // The robot's INS comes at 50 Hz, and the range finder's scans do not cross.
  CHECK(rateOf(seen, "INS") > 6.0);
  CHECK(rateOf(seen, "INS") < 13.0);
  CHECK(rateOf(seen, "MOTOR") > 12.0);
  CHECK(rateOf(seen, "SCAN") == 0.0);
  CHECK(rateOf(seen, "MAP") > 0.0);
  CHECK(rateOf(seen, "HEALTH") > 3.0);
  CHECK(robot.drive());
  hosts->plug(false);
  CHECK(robot.run.until(2.5, [&] { return !robot.moves(); }));
  CHECK_FALSE(robot.run.until(1.5, [&] { return robot.moves(); }));
  hosts->plug(true);
  CHECK_FALSE(robot.run.until(2.0, [&] { return robot.moves(); }));
  robot.link.signal(SIGINT);
  CHECK(robot.link.waitFor(5.0));
  CHECK(robot.link.exitCode() == 0);
}

TEST_CASE(
    "a link that is late and loses frames is driven over, and stops the robot when it is gone") {
  // Like a radio at the end of its range: 60 to 100 ms, one frame in ten lost.
  const auto hosts = hostsOrSkip({0.06, 0.04, 0.1});
  if (!hosts) return;
  LinkedRobot robot(*hosts);
  // At times it stands between two patterns.
  int moving = 0;
  for (int trial = 0; trial < 3 && moving <= 25; ++trial) {
    REQUIRE(robot.drive());
    moving = 0;
    for (int i = 0; i < 40; ++i) {
      robot.run.wait(0.1);
      moving += robot.moves() ? 1 : 0;
    }
  }
  CAPTURE(contentOf(robot.folder.path("goal.txt")));
  CHECK(moving > 25);
  hosts->plug(false);
  CHECK(robot.run.until(2.5, [&] { return !robot.moves(); }));
  CHECK_FALSE(robot.run.until(1.5, [&] { return robot.moves(); }));
}
