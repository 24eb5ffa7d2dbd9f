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

/// [1/m] of the circle that the rear axle drives.
double curvatureOn(const SurfaceParameters& surface, double throttle) {
  Car car{carOfTests()};
  driveCar(car, {throttle, 1.0}, levelGround(surface), 4.0);
  return car.velocity().omega / car.velocity().v_x;
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
  const double slow = curvatureOn(surfaceOf("tarmac"), 0.3);
  CAPTURE(slow, geometric);
  CHECK(slow > 0.85 * geometric);
  CHECK(slow < 1.05 * geometric);
  Car car{carOfTests()};
  const Pose2 moved = driveCar(car, {0.0, -1.0}, levelGround(surfaceOf("tarmac")), 3.0);
  CHECK(std::abs(moved.yaw) < 0.02);
}

TEST_CASE("the less friction, the wider a fast car goes") {
  SurfaceParameters ice = surfaceOf("tarmac");
  ice.friction = 0.03;
  CHECK(curvatureOn(ice, 1.0) < 0.8 * curvatureOn(surfaceOf("tarmac"), 1.0));
}

TEST_CASE("the servo takes its time") {
  Car car{carOfTests()};
  driveCar(car, {0.0, 1.0}, levelGround(surfaceOf("tarmac")), 0.1);
  CHECK(car.steering() == Approx(0.15).epsilon(0.02));
}

}  // namespace tread::sim
