// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// What each real program tells systemd, or whoever else started it.
#include <csignal>
#include <filesystem>

#include <catch2/catch.hpp>

#include "tests/system/robot_run.hpp"
#include "tests/system/starter.hpp"
#include "tests/system/worlds.hpp"

namespace tread::testing {
namespace {

/// One program's life; `pass50ms` lets 50 ms pass.
void checkLife(Starter& starter, Process& process, const std::function<void()>& pass50ms) {
  const int pid = process.pid();
  const auto pass = [&](double seconds) {
    for (double passed = 0.0; passed < seconds; passed += 0.05) {
      pass50ms();
      starter.count(pid, "");  // its queue holds ten
    }
  };
  const auto beats = [&] { return starter.count(pid, "WATCHDOG=1"); };
  for (int i = 0; i < 200 && starter.count(pid, "READY=1") == 0; ++i) pass(0.05);
  REQUIRE(starter.count(pid, "READY=1") == 1);
  pass(2.0);
  CHECK(beats() >= 4);
  CHECK(beats() <= 12);
  CHECK(starter.count(pid, "READY=1") == 1);
  CHECK(starter.count(pid, "STATUS=") >= 1);
  CHECK(starter.longestSilence(pid) < 1.0);
  process.signal(SIGSTOP);
  pass(0.2);
  const int before = beats();
  pass(1.0);
  CHECK(beats() == before);
  process.signal(SIGCONT);
  pass(0.7);
  CHECK(beats() > before);
  CHECK(starter.count(pid, "STOPPING=1") == 0);
  process.signal(SIGINT);
  CHECK(process.waitFor(5.0));
  CHECK(process.exitCode() == 0);
  CHECK(starter.count(pid, "STOPPING=1") == 1);
}

}  // namespace

TEST_CASE(
    "each process tells its starter when it is ready, that it lives, how it is, and its end") {
  for (const std::string& name : RobotRun::names()) {
    INFO(name);
    Starter starter;
    RobotRun run(kYard, "[-6, 0, 0]");
    run.start(name);
    checkLife(starter, run.process(name), [&] { run.wait(0.05); });
  }
}

TEST_CASE("the logger tells its starter the same") {
  Starter starter;
  const std::string folder = "/tmp/tread_life_" + std::to_string(getpid());
  Process logger("tread-logger", {folder + "/x.lcmlog", "--lcm-url", ownLcmUrl()});
  checkLife(starter, logger, [] { std::this_thread::sleep_for(std::chrono::milliseconds(50)); });
  std::filesystem::remove_all(folder);
}

TEST_CASE("a process that cannot start never says that it is ready") {
  Starter starter;
  Process bridge("tread-motor-bridge", {"--lcm-url", "tcpq://127.0.0.1:9"});
  REQUIRE(bridge.waitFor(10.0));
  CHECK(bridge.exitCode() == 1);
  CHECK(starter.count(bridge.pid(), "") == 0);
}

}  // namespace tread::testing
