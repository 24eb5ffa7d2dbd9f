// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tools/robot/launch/liveness.hpp"

using namespace tread::launch;

namespace {

LaunchProcess named(const std::string& name) {
  LaunchProcess process;
  process.name = name;
  return process;
}

constexpr const char* kBeat = "WATCHDOG=1";

/// Messages while the time passes, in steps of 0.1 s.
std::vector<std::string> told(Liveness& liveness, double seconds) {
  std::vector<std::string> lines;
  for (int i = 0; i < static_cast<int>(10.0 * seconds + 0.5); ++i)
    for (const Liveness::Hung& hung : liveness.pass(0.1)) lines.push_back(hung.line);
  return lines;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE(
    "a process that has beaten is aborted after its watchdog, killed 1 s later, then watched "
    "anew") {
  Liveness liveness({named("planner"), named("logger")});
  liveness.started("planner", 7);
  liveness.hear(7, "READY=1\nWATCHDOG=1");
  CHECK(told(liveness, 1.5).empty());
  liveness.hear(7, kBeat);
  liveness.hear(8, kBeat);  // another process
  CHECK(told(liveness, 1.8).empty());
  CHECK(told(liveness, 0.4) == Lines{"planner hangs: no sign of life for 2.0 s; it is aborted"});
  CHECK(told(liveness, 0.7).empty());
  CHECK(told(liveness, 0.4) == Lines{"planner does not end and is killed"});
  liveness.ended("planner");
  CHECK(told(liveness, 100.0).empty());
  liveness.started("planner", 9);
  liveness.hear(9, kBeat);
  CHECK(told(liveness, 1.8).empty());
  CHECK(told(liveness, 0.4).size() == 1);
}

TEST_CASE("at its start a process has its start time, at its end its stop time") {
  Liveness liveness({named("planner")});
  liveness.started("planner", 7);
  liveness.hear(7, "STATUS=OK");
  CHECK(told(liveness, 29.5).empty());
  CHECK(told(liveness, 1.0) == Lines{"planner has not become ready within 30.0 s; it is aborted"});
  liveness.started("planner", 8);
  liveness.hear(8, kBeat);
  liveness.hear(8, "STOPPING=1");
  CHECK(told(liveness, 4.5).empty());
  CHECK(told(liveness, 1.0) == Lines{"planner has not ended within 5.0 s; it is aborted"});
}

TEST_CASE("who is not watched, and what is not ours, may be silent for ever") {
  LaunchProcess unwatched = named("unwatched");
  unwatched.watchdog = 0.0;
  LaunchProcess external = named("external");
  external.external = true;
  Liveness liveness({unwatched, external});
  liveness.started("unwatched", 7);
  liveness.started("external", 8);
  liveness.hear(7, kBeat);
  CHECK(told(liveness, 1000.0).empty());
}
