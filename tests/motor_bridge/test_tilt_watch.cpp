// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/geometry/se2.hpp"
#include "tests/motor_bridge/bridge_world.hpp"

using namespace tread;
using namespace tread::motor;
using Catch::Contains;

namespace {

constexpr double kDeg = kPi / 180.0;
const TiltLimits kLimits{30 * kDeg, 25 * kDeg, 60 * kDeg, 60 * kDeg};

BridgeConfig watched() {
  BridgeConfig config;
  config.tilt = kLimits;
  return config;
}

InsTilt level() {
  return {0, 0.0, 0.0, 0.0, 0.0};
}

/// A driving robot with a tilt set by the test.
struct TiltWorld : BridgeWorld {
  TiltWorld() {
    bridge = Bridge(watched());
    tilt = level();
    drive();
    REQUIRE(state() == BridgeState::kDriving);
  }
  /// Time until zero [us].
  int64_t timeToZero() {
    const int64_t from = now;
    while (!isZero(out.command) && now - from < 5'000'000) step();
    return now - from;
  }
};

}  // namespace

TEST_CASE(
    "rolled or pitched beyond its limit it is at zero within 250 ms, and the reason says it") {
  const struct {
    InsTilt tilt;
    std::string reason;
  } cases[] = {{{0, 31 * kDeg, 0, 0, 0}, "rolled 31 deg, limit 30"},
               {{0, -31 * kDeg, 0, 0, 0}, "rolled 31 deg, limit 30"},
               {{0, 0, -26 * kDeg, 0, 0}, "pitched 26 deg, limit 25"},
               {{0, 0, 26 * kDeg, 0, 0}, "pitched 26 deg, limit 25"},
               {{0, 0, 0, 61 * kDeg, 0}, "rolling 61 deg/s, limit 60"},
               {{0, 0, 0, 0, -61 * kDeg}, "pitching 61 deg/s, limit 60"}};
  for (const auto& [tilt, reason] : cases) {
    TiltWorld world;
    world.tilt = tilt;
    CHECK(world.timeToZero() <= 150'000);
    CHECK(world.state() == BridgeState::kDisarmed);
    CHECK(world.reason() == reason);
    CHECK(world.last().reason.words == reason);
  }
}

TEST_CASE("just below its limits it drives on, and a bump of 80 ms does not stop it") {
  TiltWorld world;
  world.tilt = {0, 29 * kDeg, -24 * kDeg, 59 * kDeg, 59 * kDeg};
  world.run(5'000'000);
  CHECK(world.state() == BridgeState::kDriving);
  world.tilt.roll = kLimits.roll;
  world.run(1'000'000);
  CHECK(world.state() == BridgeState::kDriving);
  for (int bump = 0; bump < 20; ++bump) {
    world.tilt.roll = 40 * kDeg;
    world.run(80'000);
    world.tilt.roll = 0.0;
    world.run(40'000);
  }
  CHECK(world.state() == BridgeState::kDriving);
}

TEST_CASE("a slow INS is waited for: two measurements are no proof, however far apart") {
  TiltWatch watch(kLimits);
  watch.receive({100'000, 40 * kDeg, 0, 0, 0}, 100'000);
  watch.receive({200'000, 40 * kDeg, 0, 0, 0}, 200'000);
  CHECK(watch.fault(200'000).empty());
  watch.receive({200'000, 40 * kDeg, 0, 0, 0}, 200'000);  // a repetition
  CHECK(watch.fault(200'000).empty());
  watch.receive({300'000, 40 * kDeg, 0, 0, 0}, 300'000);
  CHECK_FALSE(watch.fault(300'000).empty());
}

TEST_CASE(
    "still beyond the limit it can be armed by hand but takes no program, and says why, until it "
    "has been level for half a second") {
  TiltWorld world;
  world.tilt.roll = 35 * kDeg;
  world.run(3'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  world.arm();
  world.run(1'000'000);
  CHECK(world.state() == BridgeState::kArmed);
  CHECK(isZero(world.out.command));
  CHECK_THAT(world.reason(), Contains("programs refused: rolled 35 deg, limit 30"));
  world.tilt.roll = 28 * kDeg;  // below, but not by the margin
  world.run(2'000'000);
  CHECK(world.state() == BridgeState::kArmed);
  CHECK_THAT(world.reason(), Contains("programs refused: rolled 35 deg, limit 30"));
  world.tilt.roll = 26 * kDeg;
  world.run(400'000);
  CHECK(world.state() == BridgeState::kArmed);
  world.tilt.roll = 35 * kDeg;  // another swing restarts the half second
  world.run(40'000);
  world.tilt.roll = 26 * kDeg;
  world.run(400'000);
  CHECK(world.state() == BridgeState::kArmed);
  world.run(200'000);
  CHECK(world.state() == BridgeState::kDriving);
}

TEST_CASE("it does not arm while it has just tipped, and never by itself") {
  TiltWorld world;
  world.tilt.pitch = 35 * kDeg;
  world.timeToZero();
  // It is a fault for 1 s, and then inputs must have been good for 1 s.
  for (const int64_t wait : {300'000, 700'000, 700'000}) {
    world.run(wait);
    world.arm();
    world.run(100'000);
    CHECK(world.state() == BridgeState::kDisarmed);
  }
  world.tilt = level();
  world.run(10'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
}

TEST_CASE("attitude that is not measured stops a robot whose description has limits of tilt") {
  TiltWorld world;
  world.tilt = InsTilt{};
  CHECK(world.timeToZero() <= 250'000);
  CHECK(world.reason() == "INS measures no roll and pitch: their limits cannot be kept");
  for (double InsTilt::*one : {&InsTilt::roll, &InsTilt::pitch}) {
    TiltWorld half;
    half.tilt.*one = InsTilt::kUnknown;
    CHECK(half.timeToZero() <= 250'000);
  }
  TiltWatch unwatched(std::nullopt);
  for (int64_t t = 0; t < 1'000'000; t += 20'000) unwatched.receive({t, kPi, 0, 0, 0}, t);
  CHECK(unwatched.fault(1'000'000).empty());
}

TEST_CASE("rates that are not measured are passed over") {
  TiltWorld world;
  world.tilt.roll_rate = world.tilt.pitch_rate = InsTilt::kUnknown;
  world.run(2'000'000);
  CHECK(world.state() == BridgeState::kDriving);
}

TEST_CASE("what is told late stops for as long as what is told at once") {
  TiltWatch watch(kLimits);
  InsTilt tilted = level();
  tilted.roll = 0.9;
  // The INS driver hung for 1.2 s; its earlier measurements arrive now.
  const int64_t now = 5'000'000;
  for (int64_t utime = now - 1'200'000; utime < now - 900'000; utime += 20'000) {
    tilted.utime = utime;
    watch.receive(tilted, now);
  }
  CHECK_THAT(watch.fault(now).words, Contains("rolled"));
  CHECK_THAT(watch.fault(now + 900'000).words, Contains("rolled"));
  CHECK(watch.fault(now + 1'100'000).empty());
}

TEST_CASE("attitude that falls silent counts as beyond, for programs until it is back") {
  TiltWatch watch(kLimits);
  int64_t now = 1'000'000;
  const auto measure = [&](int64_t until) {
    for (; now < until; now += 20'000) {
      InsTilt tilt = level();
      tilt.utime = now;
      watch.receive(tilt, now);
      CHECK(watch.fault(now).empty());
    }
  };
  measure(2'000'000);
  CHECK(watch.fault(now + 250'000).empty());
  now += 320'000;
  CHECK_THAT(watch.fault(now).words, Contains("INS measures no roll and pitch"));
  CHECK(watch.fault(now + 1'100'000).empty());
  CHECK_FALSE(watch.beyond().empty());
  now += 1'200'000;
  measure(now + 600'000);
  CHECK(watch.beyond().empty());
}

TEST_CASE("each time of the tilt watch is kept to the microsecond") {
  const auto tilted = [](int64_t utime, double roll) { return InsTilt{utime, roll, 0, 0, 0}; };
  TiltWatch watch(kLimits);
  for (const int64_t t : {0, 50'000, 99'999}) watch.receive(tilted(t, 0.9), t);
  CHECK(watch.fault(99'999).empty());
  watch.receive(tilted(100'000, 0.9), 100'000);
  CHECK_FALSE(watch.fault(100'000).empty());
  // It stands for 1 s.
  watch.receive(tilted(1'100'000, 0.9), 1'100'000);
  CHECK_FALSE(watch.fault(1'100'000).empty());
  CHECK(watch.fault(1'100'001).empty());
  CHECK_FALSE(watch.beyond().empty());
  // Level for .5 s.
  watch.receive(tilted(1'200'000, 0.0), 1'200'000);
  watch.receive(tilted(1'699'999, 0.0), 1'699'999);
  CHECK_FALSE(watch.beyond().empty());
  watch.receive(tilted(1'700'000, 0.0), 1'700'000);
  CHECK(watch.beyond().empty());
  // Silent for 300 ms.
  CHECK(watch.fault(2'000'000).empty());
  CHECK_FALSE(watch.fault(2'000'001).empty());
}

TEST_CASE("silence begins the half second of level measurements anew") {
  TiltWatch watch(kLimits);
  for (int64_t t = 0; t <= 200'000; t += 20'000) watch.receive({t, 0.9, 0, 0, 0}, t);
  CHECK_FALSE(watch.fault(200'000).empty());
  watch.receive({300'000, 0, 0, 0, 0}, 300'000);
  watch.fault(700'000);
  watch.receive({900'000, 0, 0, 0, 0}, 900'000);
  CHECK_FALSE(watch.beyond().empty());
  watch.receive({1'399'000, 0, 0, 0, 0}, 1'399'000);
  CHECK_FALSE(watch.beyond().empty());
  watch.receive({1'400'000, 0, 0, 0, 0}, 1'400'000);
  CHECK(watch.beyond().empty());
}

TEST_CASE("a robot that tips on says how far") {
  TiltWatch watch(kLimits);
  for (int64_t t = 0; t <= 200'000; t += 20'000) watch.receive({t, 35 * kDeg, 0, 0, 0}, t);
  CHECK_THAT(watch.beyond().words, Contains("rolled 35 deg"));
  watch.receive({220'000, 50 * kDeg, 0, 0, 0}, 220'000);
  CHECK_THAT(watch.beyond().words, Contains("rolled 50 deg"));
}
