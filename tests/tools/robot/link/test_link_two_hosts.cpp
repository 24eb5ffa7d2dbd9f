// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The robot on its own bus, tread-link beside it, the operator on another host.
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

/// One of our programs at the station, on the link's bus.
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

/// Messages a second of a channel, as tread-top says; 0 where it is not there.
double rateOf(const std::string& seen, const std::string& channel) {
  std::smatch found;
  return std::regex_search(seen, found, std::regex("\n" + channel + " +([0-9.]+) "))
             ? std::stod(found[1].str())
             : 0.0;
}

}  // namespace

TEST_CASE("over the link crosses what is chosen, and a robot whose operator is cut off stops") {
  std::unique_ptr<TwoHosts> hosts;
  try {
    hosts = std::make_unique<TwoHosts>();
  } catch (const std::runtime_error& error) {
    WARN("skipped: " << error.what());
    return;
  }
  const samples::OwnFolder folder;
  RobotRun run(kField, "[-20, 0, 0]");
  run.startAll();
  Process link("tread-link",
               {"--config", std::string(TREAD_SOURCE_DIR) + "/config/robots/teodor/link.yaml",
                "--set", "station_url=" + hosts->url(), "--lcm-url", run.url()},
               folder.path("link.txt"));
  REQUIRE(run.until(20.0, [&] { return run.plan().any() && run.ins().any(); }));
  REQUIRE(atStation(*hosts, "tread-top", {"--once", "2.5"}, folder.path("top.txt"))->waitFor(20.0));
  const std::string seen = contentOf(folder.path("top.txt"));
  CAPTURE(seen, contentOf(folder.path("link.txt")));
  // The robot's INS comes at 50 Hz, and the range finder's scans are not for the station.
  CHECK(rateOf(seen, "INS") > 6.0);
  CHECK(rateOf(seen, "INS") < 13.0);
  CHECK(rateOf(seen, "MOTOR") > 12.0);
  CHECK(rateOf(seen, "SCAN") == 0.0);
  CHECK(rateOf(seen, "MAP") > 0.0);
  CHECK(rateOf(seen, "HEALTH") > 3.0);

  // The operator's programs are at the station: what they say crosses, and what they see.
  run.leaveTo(30.0, 0.0, {"/usr/bin/env", "true"});
  const auto arm = atStation(*hosts, "tread-arm", {"--operator", "station", "--timeout", "20"},
                             folder.path("arm.txt"));
  run.until(20.0, [&] { return !arm->running(); });
  CAPTURE(contentOf(folder.path("arm.txt")));
  REQUIRE(arm->exitCode() == 0);
  const auto goal = atStation(*hosts, "tread-goal", {"30", "0", "--quiet", "--operator", "station"},
                              folder.path("goal.txt"));
  CHECK(run.until(15.0, [&] { return run.driving() && run.motor().message().command[0] > 0.3; }));
  CAPTURE(contentOf(folder.path("goal.txt")));
  hosts->plug(false);
  CHECK(run.until(2.5, [&] {
    return run.motor().message().command[0] == 0.0F && run.motor().message().command[1] == 0.0F;
  }));
  CHECK_FALSE(run.until(1.5, [&] { return run.motor().message().command[0] != 0.0F; }));
  hosts->plug(true);
  CHECK_FALSE(run.until(2.0, [&] { return run.motor().message().command[0] != 0.0F; }));
  link.signal(SIGINT);
  CHECK(link.waitFor(5.0));
  CHECK(link.exitCode() == 0);
}
