// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "common/execution/stopping_time.hpp"

using namespace tread;

namespace {

/// A robot that drives straight and stops with a delay and a time constant.
struct Driver {
  StoppingTime stopping{0.5};
  int64_t now = 1'000'000;
  Pose2 pose;
  double speed = 0.0;

  void move(double wanted, double seconds, double lag) {
    const int64_t end = now + static_cast<int64_t>(seconds * 1e6);
    for (; now < end; now += 20'000) {
      speed += (wanted - speed) * (1.0 - std::exp(-0.02 / lag));
      pose.x += 0.02 * speed;
      stopping.measure(now, pose, speed);
    }
  }
  /// Drives and stops within lag [s] at its speed, after a delay.
  void stop(double lag, double fast = 1.0) {
    stopping.command(false, now);
    move(fast, 3.0, 0.2);
    stopping.command(true, now);
    move(fast, 0.1, 0.2);
    move(0.0, 5.0 * lag + 1.0, lag);
  }
};

}  // namespace

TEST_CASE("stopping takes what the file says until five stops have shown that it takes less") {
  Driver driver;
  CHECK(driver.stopping.seconds() == 0.5);
  for (int i = 0; i < 4; ++i) driver.stop(0.2);
  CHECK(driver.stopping.seconds() == 0.5);
  driver.stop(0.2);
  CHECK(driver.stopping.count() == 5);
  CHECK(driver.stopping.seconds() == Approx(1.3 * 0.3).margin(0.04));
  // At least half of the file's value.
  for (int i = 0; i < 5; ++i) driver.stop(0.02);
  CHECK(driver.stopping.seconds() == 0.25);
}

TEST_CASE("one stop on ground that holds worse counts at once, whatever the speed") {
  for (const double fast : {0.4, 1.0, -1.0}) {
    Driver driver;
    driver.stop(0.8, fast);
    CHECK(driver.stopping.seconds() == Approx(1.3 * 0.9).margin(0.12));
    // It is forgotten after five better ones.
    for (int i = 0; i < 4; ++i) driver.stop(0.2);
    CHECK(driver.stopping.seconds() > 1.0);
    driver.stop(0.2);
    CHECK(driver.stopping.seconds() < 0.5);
  }
}

TEST_CASE("slow stops, unmeasured speeds and gaps tell nothing") {
  Driver driver;
  for (int i = 0; i < 9; ++i) driver.stop(0.8, 0.2);
  CHECK(driver.stopping.count() == 0);
  driver.stopping.command(false, driver.now);
  driver.move(1.0, 3.0, 0.2);
  driver.stopping.command(true, driver.now);
  driver.move(1.0, 0.1, 0.2);
  driver.now += 500'000;
  driver.move(0.0, 2.0, 0.2);
  CHECK(driver.stopping.count() == 0);
  for (int i = 0; i < 100; ++i)
    driver.stopping.measure(driver.now += 20'000, driver.pose, std::nan(""));
  CHECK(driver.stopping.seconds() == 0.5);
}

TEST_CASE("a stop that is cut short counts only if it was longer already than what was known") {
  Driver driver;
  for (const double rolled : {0.2, 1.5}) {
    driver.stopping.command(false, driver.now);
    driver.move(1.0, 3.0, 0.2);
    driver.stopping.command(true, driver.now);
    driver.move(1.0, rolled, 0.2);
  }
  driver.stopping.command(false, driver.now);
  CHECK(driver.stopping.count() == 1);
  CHECK(driver.stopping.seconds() == Approx(1.3 * 1.5).margin(0.1));
}
