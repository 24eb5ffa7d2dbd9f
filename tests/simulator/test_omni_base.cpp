// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "modules/simulator/core/car.hpp"
#include "modules/simulator/core/omni_base.hpp"
#include "modules/simulator/core/speed_loop.hpp"
#include "modules/simulator/simulator_files.hpp"

namespace tread::sim {
namespace {

VehicleParameters omniOfTests() {
  return readSimulatedRobot(TREAD_SOURCE_DIR "/tests/data/robots/omni3").vehicle;
}

SurfaceParameters groundOf(const char* name) {
  return *builtInSurface(name);
}

/// Rim speeds of the test's base, by its equation.
std::array<double, 3> rims(const Twist2& v_body) {
  std::array<double, 3> speeds{};
  for (size_t i = 0; i < 3; ++i) {
    const double a = (60.0 + 120.0 * static_cast<double>(i)) * kPi / 180.0;
    speeds[i] = -std::sin(a) * v_body.v_x + std::cos(a) * v_body.v_y + 0.42 * v_body.omega;
  }
  return speeds;
}

/// The base with controllers that hold the speeds of its wheels.
struct Held {
  OmniBase base{omniOfTests()};
  std::vector<SpeedLoop> loops{3, SpeedLoop(1.3)};
  Pose2 T_start_body;

  void drive(const Twist2& wanted, const Ground& ground, double seconds) {
    const std::array<double, 3> speeds = rims(wanted);
    T_start_body = {};
    for (int i = 0; i < static_cast<int>(std::lround(1000.0 * seconds)); ++i) {
      MotorValues power{};
      for (size_t k = 0; k < 3; ++k) power[k] = loops[k].step(speeds[k], base.motor(k).speed, 1e-3);
      base.step(MotorPower::of(power), ground, 1e-3);
      T_start_body = T_start_body * integrate(base.velocity(), 1e-3);
    }
  }
};

}  // namespace

TEST_CASE("a holonomic base goes where its wheels push it: ahead, aside, askew and about itself") {
  const SurfaceParameters tarmac = groundOf("tarmac");
  for (const Twist2& wanted :
       {Twist2{0.6, 0.0, 0.0}, Twist2{0.0, 0.6, 0.0}, Twist2{0.0, -0.6, 0.0},
        Twist2{-0.4, 0.4, 0.0}, Twist2{0.0, 0.0, 0.8}, Twist2{0.3, 0.3, 0.5}}) {
    Held held;
    held.drive(wanted, levelGround(tarmac), 3.0);
    const Twist2 v = held.base.velocity();
    CAPTURE(wanted.v_x, wanted.v_y, wanted.omega, v.v_x, v.v_y, v.omega);
    const double speed = std::hypot(wanted.v_x, wanted.v_y);
    const double along = speed > 0.0 ? (v.v_x * wanted.v_x + v.v_y * wanted.v_y) / speed : 0.0;
    CHECK(along <= 1.02 * speed);
    CHECK(along >= 0.7 * speed);
    if (speed > 0.0) CHECK(std::abs(v.v_x * wanted.v_y - v.v_y * wanted.v_x) / speed < 0.1 * speed);
    CHECK(std::abs(v.omega - wanted.omega) < 0.25 * std::abs(wanted.omega) + 0.05);
  }
}

TEST_CASE("on loose ground less of a holonomic base's commands arrives, sideways as well") {
  for (const Twist2& wanted : {Twist2{0.6, 0.0, 0.0}, Twist2{0.0, 0.6, 0.0}}) {
    double arrived[2];
    size_t i = 0;
    for (const char* name : {"tarmac", "sand"}) {
      const SurfaceParameters surface = groundOf(name);
      Held held;
      held.drive(wanted, levelGround(surface), 3.0);
      arrived[i++] = std::hypot(held.base.velocity().v_x, held.base.velocity().v_y);
    }
    CAPTURE(arrived[0], arrived[1]);
    CHECK(arrived[1] < 0.9 * arrived[0]);
    CHECK(arrived[1] > 0.1 * arrived[0]);
  }
}

TEST_CASE("a holonomic base with a wheel on other ground goes askew") {
  const SurfaceParameters tarmac = groundOf("tarmac"), ice = groundOf("ice");
  Ground ground = levelGround(tarmac);
  Held even;
  even.drive({0.6, 0.0, 0.0}, ground, 2.0);
  ground.wheels[0] = &ice;
  Held uneven;
  uneven.drive({0.6, 0.0, 0.0}, ground, 2.0);
  CAPTURE(even.T_start_body.y, even.T_start_body.yaw, uneven.T_start_body.y,
          uneven.T_start_body.yaw);
  CHECK(std::abs(uneven.T_start_body.yaw) > std::abs(even.T_start_body.yaw) + 0.05);
}

TEST_CASE("a holonomic base without power stays, and rolls down where its rollers let it") {
  const SurfaceParameters grass = groundOf("grass");
  Held level;
  level.drive({0.6, 0.0, 0.0}, levelGround(grass), 1.0);
  level.drive({}, levelGround(grass), 3.0);
  const Pose2 stood = level.T_start_body;
  level.drive({}, levelGround(grass), 5.0);
  CAPTURE(stood.x, level.T_start_body.x, level.T_start_body.y);
  CHECK(std::hypot(level.T_start_body.x, level.T_start_body.y) < 0.02);
  // Three braked wheels hold it on a slope: no direction is free for all rollers.
  Ground slope = levelGround(grass);
  slope.slope_along = 0.1;
  Held braked;
  braked.drive({}, slope, 5.0);
  CHECK(std::hypot(braked.T_start_body.x, braked.T_start_body.y) < 0.1);
}

TEST_CASE("the battery of a holonomic base feeds all its motors") {
  const SurfaceParameters sand = groundOf("sand");
  Held held;
  const double before = held.base.battery().current;
  held.drive({0.8, 0.0, 0.3}, levelGround(sand), 2.0);
  CHECK(held.base.motors() == 3);
  CHECK(held.base.battery().current > before + 1.0);
  CHECK(makeVehicle(omniOfTests())->motors() == 3);
}

}  // namespace tread::sim
