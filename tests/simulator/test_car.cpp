// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "modules/simulator/core/car.hpp"
#include "modules/simulator/simulator_files.hpp"

namespace tread::sim {
namespace {

VehicleParameters carOfTests() {
  return readSimulatedRobot(TREAD_SOURCE_DIR "/tests/data/robots/car").vehicle;
}

SurfaceParameters surfaceOf(const char* name) {
  return *builtInSurface(name);
}

Pose2 driveCar(Car& car, const MotorPower& power, const Ground& ground, double seconds) {
  Pose2 T_start_body;
  for (int i = 0; i < static_cast<int>(std::lround(1000.0 * seconds)); ++i) {
    car.step(power, ground, 1e-3);
    T_start_body = T_start_body * integrate(car.velocity(), 1e-3);
  }
  return T_start_body;
}

}  // namespace

TEST_CASE("a car without power stays, on level ground and on a slope, however it is steered") {
  const SurfaceParameters tarmac = surfaceOf("tarmac"), grass = surfaceOf("grass");
  Ground slope = levelGround(tarmac);
  slope.slope_along = 0.15;
  for (const Ground& ground : {levelGround(grass), slope}) {
    Car car{carOfTests()};
    const Pose2 moved = driveCar(car, {0.0, 1.0}, ground, 20.0);
    CHECK(std::hypot(moved.x, moved.y) < 0.05);
    CHECK(std::abs(moved.yaw) < 0.05);
    CHECK(car.steering() == Approx(0.5));
  }
}

TEST_CASE("a car turns about its rear axle nearly as Ackermann says, and never on the spot") {
  const double geometric = std::tan(0.5) / 0.9;
  const SurfaceParameters tarmac = surfaceOf("tarmac");
  Car circling{carOfTests()};
  driveCar(circling, {0.3, 1.0}, levelGround(tarmac), 4.0);
  const Twist2 v = circling.velocity();
  CAPTURE(v.v_x, v.omega, geometric);
  CHECK(v.v_x > 0.2);
  CHECK(v.omega / v.v_x > 0.85 * geometric);
  CHECK(v.omega / v.v_x < 1.05 * geometric);
  Car car{carOfTests()};
  const Pose2 moved = driveCar(car, {0.0, -1.0}, levelGround(tarmac), 3.0);
  CHECK(std::abs(moved.yaw) < 0.02);
}

TEST_CASE("in a bend friction holds a fast car, and on ice it goes wide") {
  const SurfaceParameters tarmac = surfaceOf("tarmac");
  SurfaceParameters ice = tarmac;
  ice.friction = 0.05;
  ice.scrub_resistance = 0.0;
  double turned[2];
  for (const bool on_ice : {false, true}) {
    Car car{carOfTests()};
    driveCar(car, {1.0, 0.0}, levelGround(tarmac), 3.0);
    REQUIRE(car.velocity().v_x > 1.1);
    turned[on_ice] = driveCar(car, {1.0, 1.0}, levelGround(on_ice ? ice : tarmac), 1.2).yaw;
    const Twist2 v = car.velocity();
    CAPTURE(on_ice, v.v_x, v.v_y, v.omega, turned[on_ice]);
    CHECK(v.v_x > 0.8);  // it slides on instead of stopping
    const double across = std::hypot(v.v_x, v.v_y) * v.omega;
    if (on_ice) CHECK(across < 1.1 * ice.friction * 9.81);
    if (!on_ice) CHECK(across > 1.1 * ice.friction * 9.81);
  }
  CHECK(turned[1] > 0.0);
  CHECK(turned[1] < 0.7 * turned[0]);
}

TEST_CASE("the servo takes its time") {
  Car car{carOfTests()};
  driveCar(car, {0.0, 1.0}, levelGround(surfaceOf("tarmac")), 0.1);
  CHECK(car.steering() == Approx(0.15).epsilon(0.02));
}

}  // namespace tread::sim
