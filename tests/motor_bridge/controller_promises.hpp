// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Promises that every kind of controller keeps, with any protocol.
#pragma once

#include <random>
#include <string>

#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "tests/motor_bridge/emulated_rig.hpp"

namespace tread::motor {

/// Drives until the commands reach the motors.
template <class Rig>
void requireDriving(Rig& rig) {
  rig.drive();
  REQUIRE(rig.state() == BridgeState::kDriving);
  REQUIRE(rig.turning());
}

/// Nothing moves for a time; then an ARM makes it drive again.
template <class Rig>
void standsUntilArmed(Rig& rig, int64_t us) {
  rig.last_motion = 0;
  rig.run(us);
  CHECK(rig.last_motion == 0);
  requireDriving(rig);
}

/// The end of planner or bridge, and an unplugged line, bring the motors to zero in time [us].
template <class Make>
void stopsInTime(Make make, int64_t watchdog_us) {
  {
    auto rig = make();
    rig.planner.commands = 200;
    requireDriving(rig);
    rig.planner_alive = false;
    CHECK(rig.lastMotionWithin(2'000'000) <= 230'000);
  }
  {
    auto rig = make();
    requireDriving(rig);
    rig.bridge_alive = false;
    CHECK(rig.lastMotionWithin(3'000'000) <= watchdog_us + 15'000);
  }
  auto rig = make();
  requireDriving(rig);
  rig.unplug();
  CHECK(rig.lastMotionWithin(2'000'000) <= watchdog_us + 15'000);
  rig.plugIn();
  standsUntilArmed(rig, 3'000'000);
  CHECK(rig.count("start-ups") == 2);
}

/// Random bytes and mutated output of the device, `count` in all: no crash, no growth, and a
/// command before start-up has no effect. `talk` is the device's output during start-up.
template <class Connection, class Config>
void bearsRandomBytes(const Config& config, const std::string& talk, int64_t count) {
  std::mt19937_64 random(11);
  const int64_t wanted = testing::effort(static_cast<int>(count));
  int64_t now = 0;
  for (int64_t fed = 0; fed < wanted;) {
    Connection connection{config};
    connection.open();
    for (int i = 0; i < 500; ++i) {
      now += 10'000;
      std::string bytes;
      if (i % 2 == 0) {
        const size_t from = random() % (talk.size() + 1);
        bytes = talk.substr(from, 1 + random() % 80);
        if (!bytes.empty()) bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
      } else {
        for (size_t n = random() % 80; n > 0; --n) bytes += static_cast<char>(random());
      }
      fed += static_cast<int64_t>(bytes.size());
      connection.receive(bytes, now);
      connection.command({0.5, -0.5}, now);
      const bool ready = connection.ready();
      const std::string sent = connection.poll(now);
      REQUIRE(sent.size() < 2000);
      // Between two times without completed start-up a command leaves no trace.
      if (!ready && !connection.ready()) {
        connection.command({0.5, -0.5}, now);
        REQUIRE(connection.poll(now).empty());
      }
      connection.report(now);
      connection.telemetry();
    }
    REQUIRE(connection.counters().size() < 40);
  }
}

}  // namespace tread::motor
