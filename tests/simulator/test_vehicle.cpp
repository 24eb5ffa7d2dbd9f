// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <array>
#include <cmath>

#include <catch2/catch.hpp>

#include "modules/simulator/core/speed_loop.hpp"
#include "modules/simulator/core/vehicle.hpp"
#include "tests/simulator/shipped_robot.hpp"

namespace tread::sim {
namespace {

constexpr double kVehicleStep = 1e-3;

Pose2 drive(TrackedVehicle& vehicle, const MotorPower& power, const Ground& ground, double time) {
  Pose2 T_start_body;
  for (int i = 0; i < static_cast<int>(std::lround(time / kVehicleStep)); ++i) {
    vehicle.step(power, ground, kVehicleStep);
    T_start_body = T_start_body * integrate(vehicle.velocity(), kVehicleStep);
  }
  return T_start_body;
}

/// Rounding of cancelling sums is no motion.
constexpr double kRest = 1e-9;

}  // namespace

TEST_CASE("without power on level ground the vehicle does not move at all") {
  for (const SurfaceParameters& surface : builtInSurfaces()) {
    TrackedVehicle vehicle{shippedVehicle()};
    const Pose2 moved = drive(vehicle, {0.0, 0.0}, levelGround(surface), 60.0);
    CHECK(moved.x == 0.0);
    CHECK(moved.y == 0.0);
    CHECK(moved.yaw == 0.0);
  }
}

TEST_CASE("a controller that holds track speeds holds them on every ground") {
  for (const SurfaceParameters& surface : builtInSurfaces()) {
    TrackedVehicle vehicle{shippedVehicle()};
    std::array<SpeedLoop, 2> loops{SpeedLoop(1.1), SpeedLoop(1.1)};
    const std::array<double, 2> wanted{0.5, 0.3};
    double fastest = 0.0;
    for (int i = 0; i < 4000; ++i) {
      vehicle.step({loops[0].step(wanted[0], vehicle.left().speed, kVehicleStep),
                    loops[1].step(wanted[1], vehicle.right().speed, kVehicleStep)},
                   levelGround(surface), kVehicleStep);
      fastest = std::max(fastest, vehicle.left().speed);
    }
    CAPTURE(surface.name, vehicle.left().speed, vehicle.right().speed, fastest);
    CHECK(vehicle.left().speed == Approx(wanted[0]).margin(0.01));
    CHECK(vehicle.right().speed == Approx(wanted[1]).margin(0.01));
    CHECK(fastest < 1.25 * wanted[0]);
  }
}

TEST_CASE("a speed that cannot be reached winds nothing up") {
  SpeedLoop loop(1.0);
  for (int i = 0; i < 10000; ++i) loop.step(5.0, 1.0, kVehicleStep);
  CHECK(loop.step(0.5, 1.0, kVehicleStep) < 0.1);
}

TEST_CASE("after driving the vehicle comes to rest within a second and stays there") {
  for (const SurfaceParameters& surface : builtInSurfaces()) {
    if (surface.name == "ice") continue;
    const Ground ground = levelGround(surface);
    TrackedVehicle vehicle{shippedVehicle()};
    drive(vehicle, {1.0, 0.6}, ground, 3.0);
    const Pose2 stopping = drive(vehicle, {0.0, 0.0}, ground, 1.0);
    INFO(surface.name);
    CHECK(std::hypot(stopping.x, stopping.y) < 0.3);
    CHECK(std::abs(vehicle.velocity().v_x) < 0.02);
    drive(vehicle, {0.0, 0.0}, ground, 5.0);
    const Pose2 resting = drive(vehicle, {0.0, 0.0}, ground, 20.0);
    CHECK(std::abs(resting.x) < 1e-5);
    CHECK(std::abs(resting.y) < 1e-5);
    CHECK(std::abs(resting.yaw) < 1e-5);
  }
}

TEST_CASE("the parking brake holds on a slope of ten degrees in any direction") {
  const double slope = std::tan(10.0 * kPi / 180.0);
  for (const char* name : {"cinder", "tarmac", "grass", "gravel"}) {
    for (double direction = 0.0; direction < 6.2; direction += 0.7) {
      const SurfaceParameters surface = *builtInSurface(name);
      Ground ground = levelGround(surface);
      ground.slope_along = slope * std::cos(direction);
      ground.slope_across = slope * std::sin(direction);
      TrackedVehicle vehicle{shippedVehicle()};
      const Pose2 settling = drive(vehicle, {0.0, 0.0}, ground, 10.0);
      const Pose2 creeping = drive(vehicle, {0.0, 0.0}, ground, 60.0);
      INFO(name << " direction " << direction);
      CHECK(std::hypot(settling.x, settling.y) < 0.05);
      CHECK(std::hypot(creeping.x, creeping.y) < 1e-4);
      CHECK(std::abs(creeping.yaw) < 1e-4);
    }
  }
}

TEST_CASE("on ice the same slope cannot be held") {
  const SurfaceParameters ice = *builtInSurface("ice");
  Ground ground = levelGround(ice);
  ground.slope_along = std::tan(10.0 * kPi / 180.0);
  TrackedVehicle vehicle{shippedVehicle()};
  CHECK(drive(vehicle, {0.0, 0.0}, ground, 5.0).x < -1.0);
}

TEST_CASE("driving uphill is slower and takes more current than downhill") {
  const SurfaceParameters grass = *builtInSurface("grass");
  Ground up = levelGround(grass);
  up.slope_along = 0.1;
  Ground down = levelGround(grass);
  down.slope_along = -0.1;
  TrackedVehicle climbing{shippedVehicle()};
  TrackedVehicle descending{shippedVehicle()};
  const double climbed = drive(climbing, {1.0, 1.0}, up, 5.0).x;
  const double descended = drive(descending, {1.0, 1.0}, down, 5.0).x;
  CHECK(climbed < descended - 0.2);
  CHECK(climbing.left().current > descending.left().current + 10.0);
  CHECK(climbing.battery().voltage < descending.battery().voltage);
}

TEST_CASE("left and right are mirror images") {
  const SurfaceParameters gravel = *builtInSurface("gravel");
  const Ground ground = levelGround(gravel);
  TrackedVehicle to_left{shippedVehicle()};
  TrackedVehicle to_right{shippedVehicle()};
  const Pose2 left = drive(to_left, {0.3, 0.9}, ground, 3.0);
  const Pose2 right = drive(to_right, {0.9, 0.3}, ground, 3.0);
  CHECK(left.x == Approx(right.x).margin(kRest));
  CHECK(left.y == Approx(-right.y).margin(kRest));
  CHECK(left.yaw == Approx(-right.yaw).margin(kRest));
}

TEST_CASE("opposite powers turn in place, equal negative powers reverse") {
  const SurfaceParameters tarmac = *builtInSurface("tarmac");
  const Ground ground = levelGround(tarmac);
  TrackedVehicle spinning{shippedVehicle()};
  const Pose2 spun = drive(spinning, {-0.5, 0.5}, ground, 3.0);
  CHECK(spun.yaw > 3.0);
  CHECK(std::hypot(spun.x, spun.y) < 0.3);
  TrackedVehicle reversing{shippedVehicle()};
  CHECK(drive(reversing, {-1.0, -1.0}, ground, 3.0).x < -2.5);
}

TEST_CASE("the battery pays for what the tracks do and slowly runs down") {
  const SurfaceParameters cinder = *builtInSurface("cinder");
  const Ground ground = levelGround(cinder);
  TrackedVehicle vehicle{shippedVehicle()};
  const VehicleParameters parameters = shippedVehicle();
  drive(vehicle, {1.0, 1.0}, ground, 5.0);
  const Battery& battery = vehicle.battery();
  // Rolling resistance times speed is the output power; the rest is heat.
  const double resistance =
      parameters.mass * 9.81 *
      (cinder.resistance_constant + cinder.resistance_viscous * vehicle.velocity().v_x);
  const double drawn = battery.voltage * battery.current;
  CHECK(drawn > resistance * vehicle.velocity().v_x);
  CHECK(drawn < 3.0 * resistance * vehicle.velocity().v_x);
  CHECK(battery.charge < 1.0);
  CHECK(battery.charge > 0.99);
  CHECK(battery.voltage < parameters.drive.full_voltage - 0.3);

  const double fast = vehicle.velocity().v_x;
  vehicle.setCharge(0.1);
  drive(vehicle, {1.0, 1.0}, ground, 5.0);
  CHECK(vehicle.velocity().v_x < 0.95 * fast);
}

TEST_CASE("a step of two milliseconds gives the same motion as one of half a millisecond") {
  for (const char* name : {"cinder", "grass"}) {
    const SurfaceParameters surface = *builtInSurface(name);
    const Ground ground = levelGround(surface);
    const auto drivenWith = [&](double step) {
      TrackedVehicle vehicle{shippedVehicle()};
      Pose2 pose;
      for (int i = 0; i < static_cast<int>(std::lround(4.0 / step)); ++i) {
        vehicle.step({1.0, i * step < 2.0 ? 1.0 : 0.5}, ground, step);
        pose = pose * integrate(vehicle.velocity(), step);
      }
      return pose;
    };
    const Pose2 coarse = drivenWith(2e-3);
    const Pose2 fine = drivenWith(5e-4);
    CHECK(coarse.x == Approx(fine.x).margin(0.02));
    CHECK(coarse.y == Approx(fine.y).margin(0.02));
    CHECK(coarse.yaw == Approx(fine.yaw).margin(0.02));
  }
}

}  // namespace tread::sim
