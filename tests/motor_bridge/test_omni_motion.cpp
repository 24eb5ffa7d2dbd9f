// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The bridge's motion checks for a base with lateral commands.
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/core/fence_watch.hpp"
#include "modules/motor_bridge/core/motion_monitor.hpp"
#include "tests/motor_bridge/bridge_world.hpp"

using namespace tread;
using namespace tread::motor;
using Catch::Contains;

namespace {

OmniWheels threeWheels() {
  std::vector<OmniWheel> wheels;
  for (const double angle : {kPi / 3.0, kPi, 5.0 * kPi / 3.0})
    wheels.push_back({0.42 * std::cos(angle), 0.42 * std::sin(angle), angle + kPi / 2.0, 0.0});
  std::string why;
  return OmniWheels::make(wheels, why).value();
}

MotionLimits omniLimits() {
  MotionLimits limits;
  limits.wheels = threeWheels();
  limits.gauge = 0.84;
  limits.full_speed = 1.2 * limits.wheels.reach();
  limits.speed_per_command = 1.0;
  limits.dead_band = 0.05;
  return limits;
}

/// A holonomic base with a good INS at 50 Hz in front of a monitor.
struct OmniDrive {
  MotionLimits limits = omniLimits();
  MotionMonitor monitor{limits};
  Twist2 wanted;
  double slip = 0.85;
  /// share of its command that each wheel executes
  std::array<double, 3> wheel_share{1.0, 1.0, 1.0};
  bool encoders = true;
  Twist2 shove;

  std::string run(double seconds) {
    std::string verdict;
    for (int i = 0; i < static_cast<int>(50.0 * seconds + 0.5); ++i) {
      step();
      if (verdict.empty()) verdict = monitor.fault(utime_).words;
    }
    return verdict;
  }

 private:
  void step() {
    utime_ += 20'000;
    const Command command = limits.wheels.speeds(wanted);
    monitor.command(limits.motion(command), utime_ - 15'000);
    MotorTelemetry motors;
    Command turned;
    for (size_t i = 0; i < 3; ++i) {
      rims_[i] += (1.0 - std::exp(-0.02 / 0.2)) * (wheel_share[i] * command[i] - rims_[i]);
      turned[i] = rims_[i];
      if (encoders) motors.measured[i] = rims_[i];
    }
    monitor.receive(motors);
    const Twist2 ideal = limits.wheels.twist(turned);
    const Twist2 v{slip * ideal.v_x + shove.v_x, slip * ideal.v_y + shove.v_y,
                   slip * ideal.omega + shove.omega};
    truth_ = truth_ * integrate(v, 0.02);
    InsMotion ins;
    ins.utime = utime_;
    ins.x = truth_.x + 0.003 * normal_(random_);
    ins.y = truth_.y + 0.003 * normal_(random_);
    ins.yaw = wrapAngle(truth_.yaw + 0.001 * normal_(random_));
    ins.position_std = 0.02;
    ins.v_forward = v.v_x + 0.01 * normal_(random_);
    ins.v_left = v.v_y + 0.01 * normal_(random_);
    ins.yaw_rate = v.omega + 0.002 * normal_(random_);
    monitor.receive(ins);
  }

  std::mt19937_64 random_{7};
  std::normal_distribution<double> normal_;
  int64_t utime_ = 10'000'000;
  std::array<double, 3> rims_{};
  Pose2 truth_;
};

}  // namespace

TEST_CASE("motion: a holonomic base may drive in all directions, on good and on loose ground") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (const double slip : {0.6, 0.85, 1.0}) {
    OmniDrive drive;
    drive.slip = slip;
    for (int i = 0; i < 40; ++i) {
      drive.wanted = {0.6 * share(random), 0.6 * share(random), 0.6 * share(random)};
      if (i % 5 == 4) drive.wanted = {};
      const std::string verdict = drive.run(1.5);
      INFO(slip << " " << i << ": " << verdict);
      REQUIRE(verdict.empty());
    }
  }
}

TEST_CASE("motion: a holonomic base that is stuck on its way to the side is told") {
  OmniDrive drive;
  drive.encoders = false;
  drive.wanted = {0.0, 0.6, 0.0};
  CHECK(drive.run(3.0).empty());
  drive.slip = 0.0;
  CHECK_THAT(drive.run(3.0), Contains("stuck or pose frozen") && Contains("wheels make"));
}

TEST_CASE("motion: a holonomic base that goes to the wrong side, or slides, is told") {
  OmniDrive wrong;
  wrong.wanted = {0.0, 0.6, 0.0};
  CHECK(wrong.run(3.0).empty());
  wrong.slip = -0.85;
  CHECK_THAT(wrong.run(3.0), Contains("to the left") && Contains("commands explain"));
  OmniDrive slides;
  CHECK(slides.run(2.0).empty());
  slides.shove = {0.0, -0.4, 0.0};
  CHECK_THAT(slides.run(3.0), Contains("though zero is commanded"));
}

TEST_CASE("motion: a wheel of a holonomic base that stands against its command is told") {
  OmniDrive drive;
  drive.wanted = {0.0, 0.6, 0.0};
  CHECK(drive.run(3.0).empty());
  drive.wheel_share[1] = 0.0;
  CHECK_THAT(drive.run(3.0), Contains("wheel") && Contains("dead or blocked"));
}

TEST_CASE("a fence holds a holonomic base that drives to the side, with and without its velocity") {
  const Fence yard{"yard", false, {{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}};
  const MotionLimits limits = omniLimits();
  for (const bool measured : {true, false}) {
    FenceWatch fences({{yard}, {0.5, 0.5, 0.5}, 0.5}, limits);
    const Command left = limits.motion(limits.wheels.speeds({0.0, 0.6, 0.0}));
    InsMotion ins;
    ins.x = 0.0;
    ins.yaw = 0.0;
    ins.position_std = 0.02;
    double stopped_at = 99.0;
    int64_t now = 10'000'000;
    for (double y = 0.0; y < 5.0 && stopped_at > 50.0; y += 0.006) {
      now += 10'000;
      ins.utime = now;
      ins.y = y;
      if (measured) {
        ins.v_forward = 0.0;
        ins.v_left = 0.6;
        ins.yaw_rate = 0.0;
      }
      fences.receive(ins);
      fences.command(left, now);
      if (!fences.fault(now).empty()) stopped_at = y;
    }
    CAPTURE(measured, stopped_at);
    // The outline extends 0.5 m to the left, and the motion continues for 0.5 s.
    CHECK(stopped_at < 5.0 - 0.5 - 0.25);
    CHECK(stopped_at > 5.0 - 0.5 - (measured ? 0.6 : 1.5));
  }
}

namespace {

/// The base's bridge, with programs of so many channels.
std::string reasonFor(size_t channels) {
  BridgeConfig config;
  config.motion = omniLimits();
  config.gate.slot.channels = omniChannels(CommandKind::kTrackSpeed, 3);
  BridgeWorld world;
  world.bridge = Bridge(config);
  world.planner.slots = [channels](int64_t id) {
    ProgramSlot slot = makeSlot(id, 20);
    slot.kinds = kindsOf(omniChannels(CommandKind::kTrackSpeed, channels));
    Command command;
    for (size_t i = 0; i < channels; ++i) command[i] = 0.2;
    slot.series.assign(20, command);
    return slot;
  };
  world.drive();
  if (world.state() == BridgeState::kDriving)
    return "drives " + std::to_string(world.out.command[2]);
  for (const auto& [name, count] : world.bridge.counters())
    if (count > 0 && name.find("PROGRAM refused") == 0) return name;
  return world.reason();
}

}  // namespace

TEST_CASE("a program of another number of channels than the robot's wheels is refused") {
  CHECK_THAT(reasonFor(3), Contains("drives 0.2"));
  CHECK_THAT(reasonFor(2), Contains("command kind"));
  CHECK_THAT(reasonFor(4), Contains("command kind"));
}
