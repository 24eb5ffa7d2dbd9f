// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Processes that run but hang.
#include <catch2/catch.hpp>

#include "tests/tools/robot/launch/launched.hpp"
#include "tools/robot/launch/host.hpp"

using namespace tread::testing;
using Catch::Contains;
using tread::launch::runCommand;

namespace {

std::string statusOf(const Launched& launched) {
  std::vector<std::string> words{std::string(TREAD_BIN_DIR) + "/tread-launch"};
  for (const std::string& word : launched.arguments({"--status"})) words.push_back(word);
  return runCommand(words, 30.0).output;
}

}  // namespace

TEST_CASE("a process that gives no sign of life any more is named, aborted and started again") {
  const Launched launched({"hangs watchdog: 1", "good"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  REQUIRE(launched.says("trial: all 3 processes run after"));
  const int first = launched.pidOf("p0.txt");
  const int other = launched.pidOf("p1.txt");
  CHECK(launched.says("trial: p0 hangs: no sign of life for 1.0 s; it is aborted\n"));
  CHECK(launched.says("trial: p0 ended (terminated by SIGABRT; not expected)"));
  CHECK(launched.says("trial: p0 runs again"));
  const int second = launched.pidOf("p0.txt");
  CHECK(second > 0);
  CHECK(second != first);
  CHECK(launched.pidOf("p1.txt") == other);
  CHECK_THAT(statusOf(launched), Contains("p0 hung ") && Contains(" since the start, last 20") &&
                                     Contains(": p0 hangs: no sign of life for 1.0 s") &&
                                     Contains("RUNNING"));
  launch.signal(SIGINT);
  CHECK(launch.waitFor(10));
  CHECK(launch.exitCode() == 0);
  CHECK(launched.pids().empty());
}

TEST_CASE("a hung process that an abort does not end is killed") {
  const Launched launched({"stubborn watchdog: 1"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  CHECK(launched.says("trial: p0 hangs: "));
  CHECK(launched.says("trial: p0 does not end and is killed"));
  CHECK(launched.says("trial: p0 ended (terminated by SIGKILL; not expected)"));
  launch.signal(SIGINT);
  CHECK(launch.waitFor(10));
}

TEST_CASE("a process that does not become ready in its start time is named and ended") {
  const Launched launched({"mute start_time: 1"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  CHECK(launched.says("trial: p0 has not become ready within 1.0 s; it is aborted"));
  CHECK(launched.says("trial: p0 ended (terminated by SIGABRT; not expected)"));
  launch.signal(SIGINT);
  CHECK(launch.waitFor(10));
}

TEST_CASE("a halted process is ended and comes back, unless the watchdog is off") {
  for (const bool watchdog : {true, false}) {
    const Launched launched({"good watchdog: 1"}, TREAD_STAND_IN);
    const std::vector<std::string> more =
        watchdog ? std::vector<std::string>{} : std::vector<std::string>{"--no-watchdog"};
    Process launch("tread-launch", launched.arguments(more), launched.output());
    REQUIRE(launched.says("processes run after"));
    const int first = launched.pidOf("p0.txt");
    kill(first, SIGSTOP);
    CHECK(launched.says("trial: p0 hangs", watchdog ? 20.0 : 2.5) == watchdog);
    if (watchdog) CHECK(launched.says("trial: p0 runs again"));
    CHECK((launched.pidOf("p0.txt") == first) != watchdog);
    kill(first, SIGCONT);
    launch.signal(SIGINT);
    CHECK(launch.waitFor(10));
  }
}

TEST_CASE("a tread-launch that was halted itself takes nobody for hung") {
  const Launched launched({"good watchdog: 1"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  REQUIRE(launched.says("processes run after"));
  const int first = launched.pidOf("p0.txt");
  launch.signal(SIGSTOP);
  CHECK_FALSE(launched.says("hangs", 3.0));
  launch.signal(SIGCONT);
  CHECK_FALSE(launched.says("hangs", 1.5));
  CHECK(launched.pidOf("p0.txt") == first);
  launch.signal(SIGINT);
  CHECK(launch.waitFor(10));
}

TEST_CASE("nobody is taken for hung while all are stopped") {
  const Launched launched({"slow watchdog: 1", "slow watchdog: 1"}, TREAD_STAND_IN);
  Process launch("tread-launch", launched.arguments(), launched.output());
  REQUIRE(launched.says("processes run after"));
  launch.signal(SIGINT);
  REQUIRE(launch.waitFor(10));
  CHECK(launch.exitCode() == 0);
  CHECK_THAT(launched.said(), !Contains("hangs") && !Contains("has not ended"));
}
