// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// After SIGKILL, which prevents any cleanup, no process may remain.
#include <catch2/catch.hpp>

#include "tests/tools/robot/launch/launched.hpp"
#include "tools/robot/launch/host.hpp"
#include "tools/robot/launch/supervision.hpp"

using namespace tread::testing;
using Catch::Contains;
using tread::launch::RunLock;

TEST_CASE("a killed supervisor leaves no process behind, not even one that does not listen") {
  const Launched launched({"good", "deaf"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  REQUIRE(launched.says("processes run after"));
  kill(launched.supervisor(), SIGKILL);
  REQUIRE(launch.waitFor(6));
  CHECK(launch.exitCode() == 1);
  CHECK(launched.pids().empty());
  CHECK(launched.says("trial: the supervisor was killed by signal 9, so everything is stopped"));
  CHECK_THAT(contentOf(launched.run() / "log/supervisor.log"), !Contains("stopped:"));
}

TEST_CASE("a killed tread-launch takes its supervisor and all processes with it") {
  const Launched launched({"good", "good"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  REQUIRE(launched.says("processes run after"));
  launch.signal(SIGKILL);
  REQUIRE(launch.waitFor(5));
  CHECK(within(20, [&] { return launched.pids().empty(); }));
  // The next start is refused until the supervisor has ended, then it works.
  CHECK(within(20, [&] { return !RunLock::isHeld(launched.run() / "lock"); }));
  std::filesystem::remove(launched.output());
  Process again("tread-launch", launched.arguments(), launched.output());
  CHECK(launched.says("trial: all 3 processes run after"));
  again.signal(SIGINT);
  CHECK(again.waitFor(10));
}

TEST_CASE("with tread-launch and supervisor killed at once, each process sees that alone") {
  const Launched launched({"good", "good"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  REQUIRE(launched.says("processes run after"));
  const int supervisor = launched.supervisor();
  launch.signal(SIGSTOP);  // it could help otherwise
  kill(supervisor, SIGKILL);
  launch.signal(SIGKILL);
  CHECK(within(10, [&] { return launched.pids().empty(); }));
}

TEST_CASE("a process that does not stop is killed after its stop time") {
  const Launched launched({"deaf"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  REQUIRE(launched.says("processes run after"));
  launch.signal(SIGINT);
  REQUIRE(launch.waitFor(10));
  CHECK(launch.exitCode() == 0);
  CHECK(launched.says("trial: p0 did not stop in time and is killed"));
  CHECK(launched.pids().empty());
}
