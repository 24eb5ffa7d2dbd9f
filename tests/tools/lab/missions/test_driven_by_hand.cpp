// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The whole robot in virtual time, with phases of manual control.
#include <catch2/catch.hpp>

#include <cstdio>
#include <fstream>
#include <optional>
#include <random>

#include <unistd.h>

#include "modules/simulator/simulator_files.hpp"
#include "tests/tools/lab/missions/shipped_robot.hpp"
#include "tools/robot/drive/drive_call.hpp"
#include "tools/robot/drive/pad.hpp"
#include "tools/robot/report/drive_report.hpp"

using namespace tread;
using namespace tread::missions;

namespace {

/// A person with a stick: mostly full ahead, with curves, turns and pauses.
struct Person {
  Person(Bus& person_bus, uint64_t seed)
      : bus(person_bus), motor(person_bus, kMotor), random(seed) {
    message.station = 4242;
    message.operator_name = "mission operator";
  }
  double draw(double from, double to) { return std::uniform_real_distribution(from, to)(random); }
  void choose(int64_t utime) {
    const double what = draw(0.0, 1.0);
    double left = 1.0;
    double right = 1.0;
    if (what > 0.5) (draw(0.0, 1.0) < 0.5 ? left : right) = draw(0.1, 0.9);  // a curve
    if (what > 0.75) left = -(right = draw(0.0, 1.0) < 0.5 ? 0.4 : -0.4);    // on the spot
    if (what > 0.85) left = right = draw(0.2, 0.8);                          // slowly
    if (what > 0.93) left = right = 0.0;
    message.hand_left = static_cast<float>(left);
    message.hand_right = static_cast<float>(right);
    until = utime + static_cast<int64_t>(draw(0.7, 5.0) * 1e6);
  }
  void step(int64_t utime, bool give_back) {
    if (until == 0) until = utime + 300'000;  // stick at rest
    if (utime >= until) choose(utime);
    message.utime = utime;
    message.seen_utime = motor.message().utime;
    message.hold = !give_back;
    message.give_back = give_back;
    ++message.seq;
    bus.publish(kManual, message);
  }

  Bus& bus;
  Latest<motor_t> motor;
  std::mt19937_64 random;
  manual_t message{};
  int64_t until = 0;
};

struct HandDriven {
  int taught = 0;
  int fair = 0;
  bool arrived = false;
  std::string report;
};

/// Manual driving from second 8 to 68 on a meadow, then given back. Without `max_command`: as
/// shipped.
HandDriven driveByHand(std::optional<double> max_command, uint64_t seed) {
  HandDriven result;
  RobotConfig robot = teodor();
  if (max_command) robot.motor_bridge.bridge.manual.max_command = *max_command;
  const std::string path = "test_driven_by_hand_" + std::to_string(getpid()) + ".lcmlog";
  {
    LogWriter log(path);
    RobotSystem system(robot,
                       sim::readWorld(std::string(TREAD_SOURCE_DIR) + "/config/worlds/meadow.yaml"),
                       {0.0, 0.0, 0.0}, seed, "", {});
    system.bus().setTap([&](int64_t utime, const char* channel, const uint8_t* bytes, size_t size) {
      log.write(utime, channel, bytes, size);
    });
    Bus& outside = system.bus().outside();
    outside.subscribe<learning_t>(kLearning, [&](const learning_t& learning) {
      if (learning.learned_run_id != 0) return;
      ++result.taught;
      result.fair += learning.accepted ? 1 : 0;
    });
    outside.subscribe<plan_t>(kPlan, [&](const plan_t& plan) {
      result.arrived = result.arrived || plan.plan_status == plan_t::PLAN_ARRIVED;
    });
    Operator seat(outside, {15.0, 0.0, 0.0});
    Person person(outside, seed);
    const int64_t start = outside.now();
    for (int64_t now = start; now < start + 150'000'000 && !result.arrived; now += 20'000) {
      system.bus().runUntil(now);
      if ((now - start) % 40'000 == 0) seat.step(now);
      const double time = static_cast<double>(now - start) * 1e-6;
      if (time > 8.0 && time < 69.0) person.step(now, time > 68.0);
    }
    system.bus().setTap({});
  }
  result.report = report::HandRecord(readTimeline({path})).words();
  std::remove(path.c_str());
  return result;
}

}  // namespace

TEST_CASE("driven by hand the robot learns and plans on, and given back it goes to its goal") {
  const HandDriven full = driveByHand(std::nullopt, 1);
  INFO(full.report << full.taught << " taught, " << full.fair << " fair");
  CHECK(full.taught >= 3);
  CHECK(full.fair >= 1);
  CHECK(full.arrived);
  CHECK_THAT(full.report, Catch::Contains("taken over 1 times") &&
                              Catch::Contains("handed back 1 times") &&
                              Catch::Contains("the planner would have made the same motion"));
}

TEST_CASE("at half power no pattern is driven by hand, and nothing is taught") {
  const HandDriven half = driveByHand(0.5, 2);
  INFO(half.report);
  CHECK(half.taught == 0);
  CHECK(half.arrived);
}

namespace {

/// The kernel's values before the first movement of a pad with axes from 0 to 255.
const std::string kUntouched =
    "A: 00 0 255 0 0 0\nA: 01 0 255 0 0 0\nE: 0.0 0003 0000 0\nE: 0.0 0003 0001 0\n";
/// START, then the dead man's button, twice.
const std::string kArmsAndHolds =
    "E: 2.000000 0001 013b 1\nE: 2.200000 0001 013b 0\nE: 4.000000 0001 0137 1\n"
    "E: 5.000000 0001 0137 0\nE: 5.500000 0001 0137 1\n";
const std::string kEnds = "E: 8.000000 0000 0000 0\n";

struct PadDriven {
  bool moved = false;
  bool armed = false;
  std::string lines;  ///< output of tread-drive
};

/// The shipped robot on a meadow, with only tread-drive and a recorded pad.
PadDriven driveWith(const std::string& events) {
  const std::string path = "test_driven_by_hand_" + std::to_string(getpid()) + ".evemu";
  std::ofstream(path) << events;
  PadDriven result;
  RobotSystem system(teodor(),
                     sim::readWorld(std::string(TREAD_SOURCE_DIR) + "/config/worlds/meadow.yaml"),
                     {0.0, 0.0, 0.0}, 1, "", {});
  Bus& outside = system.bus().outside();
  const Latest<motor_t> motor(outside, kMotor);
  drive::DriveCall call(outside, {"ada", "", "ada"}, std::make_unique<drive::RecordedPad>(path));
  auto state = operators::CallResult::kPending;
  for (int64_t now = outside.now(); state == operators::CallResult::kPending; now += 20'000) {
    system.bus().runUntil(now);
    state = call.step(now);
    result.lines += call.describe(now) + "\n";
    const sim::MotorValues power = system.devices().power(now);
    result.moved |= power[0] != 0.0 || power[1] != 0.0;
    result.armed |= motor.any() && mayDrive(motor.message().bridge_state);
  }
  std::remove(path.c_str());
  return result;
}

}  // namespace

TEST_CASE("a pad that was not seen at rest moves nothing, and tread-drive says so") {
  const std::string lies = GENERATE(as<std::string>{},
                                    "",                                           // never touched
                                    "E: 1.0 0003 0000 0\nE: 1.0 0003 0001 0\n",   // repeats it
                                    "E: 1.0 0003 0001 128\n",                     // one axis only
                                    "E: 1.0 0003 0000 1\nE: 1.0 0003 0001 2\n");  // at an extreme
  const PadDriven run = driveWith(kUntouched + lies + kArmsAndHolds + kEnds);
  INFO(run.lines);
  CHECK(run.armed);
  CHECK_FALSE(run.moved);
  CHECK_THAT(run.lines, Catch::Contains("the stick was not seen at rest"));
}

TEST_CASE("a pad that was seen at rest drives, whatever the kernel told before") {
  const PadDriven run = driveWith(kUntouched + "E: 1.0 0003 0000 128\nE: 1.0 0003 0001 127\n" +
                                  kArmsAndHolds + "E: 6.0 0003 0001 0\n" + kEnds);
  INFO(run.lines);
  CHECK(run.moved);
}
