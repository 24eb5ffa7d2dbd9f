// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// VESC drivers with emulated controllers, which share no code with them.
#include <cmath>
#include <limits>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/vesc/vesc_connection.hpp"
#include "modules/simulator/emulators/vesc/vesc_emulators.hpp"
#include "tests/motor_bridge/controller_promises.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

using UartRig = EmulatedRig<VescUart, sim::VescUartEmulator>;
using CanRig = EmulatedRig<VescCan, sim::VescCanEmulator>;

VescConfig configOf(const std::string& text, const DriveDescription& drive = {}) {
  ConfigReader reader = ConfigReader::fromText(text, "vesc.yaml");
  const VescConfig config = readVescConfig(reader, drive);
  reader.finish();
  return config;
}

std::string refusalOf(const std::string& text, const DriveDescription& drive = {}) {
  try {
    configOf(text, drive);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

/// 5000 electrical rpm at 1 m/s, like the emulated ones.
const std::string kGeared = "{pole_pairs: 5, gear_ratio: 10.471975512, wheel_radius: 0.1}";

template <class Rig>
void drivesAndReads(Rig& rig) {
  sim::DriveMeasurements measured;
  measured.battery_voltage = 24.3;
  measured.motor_current = {5.5, 6.5};
  measured.track_speed = {0.8, -0.4};
  rig.device.measure(measured);
  rig.drive();
  rig.run(5'000'000);
  REQUIRE(rig.state() == BridgeState::kDriving);
  CHECK(rig.device.output(rig.now)[0] == Approx(rig.out.command[0]).margin(1e-4));
  CHECK(rig.device.output(rig.now)[1] == Approx(rig.out.command[1]).margin(1e-4));
  const MotorTelemetry told = rig.connection.telemetry();
  CHECK(told.battery_voltage == Approx(24.3));
  CHECK(told.temperature == Approx(31.2));
  CHECK(told.current[0] == Approx(5.5).margin(0.11));
  CHECK(told.current[1] == Approx(6.5).margin(0.11));
  CHECK(told.measured[0] == Approx(0.8).margin(0.001));
  CHECK(told.measured[1] == Approx(-0.4).margin(0.001));
  CHECK(rig.count("start-ups") == 1);
  CHECK(rig.count("garbage bytes") == 0);
}

}  // namespace

TEST_CASE("VESC packets: the firmware's example, split and glued, garbage and wrong ends between") {
  // COMM_GET_VALUES in VESC Tool's encoding.
  const std::string ask("\x02\x01\x04\x40\x84\x03", 6);
  CHECK(vescPacket("\x04") == ask);
  VescPackets packets;
  CHECK(packets.push(ask.substr(0, 3)).empty());
  CHECK(packets.push(ask.substr(3) + ask).size() == 2);
  std::string wrong = ask;
  wrong[3] ^= 1;
  packets.expectAtMost(128);
  CHECK(packets.push("\x7f" + wrong + ask).size() == 1);
  CHECK(packets.badChecksums() >= 1);
  CHECK(packets.push("\x03" + ask).size() == 1);
  packets.expectAtMost(VescPackets::kMaxPayload);
  packets.clear();
  const std::string long_one(400, 'x');
  CHECK(packets.push(vescPacket(long_one)) == std::vector<std::string>{long_one});
}

TEST_CASE("VESC commands: duty or electrical speed by side, clamped, NaN is zero") {
  VescConfig config = configOf("{left: [1, 3], right: [2, 4]}");
  config.invert_right = true;
  using Kind = VescCommand::Kind;
  CHECK(vescCommand({0.5, 0.25}, 3, config).value == 50'000);
  CHECK(vescCommand({0.5, 0.25}, 4, config).value == -25'000);
  CHECK(vescCommand({7.0, std::nan("")}, 1, config).value == 100'000);
  CHECK(vescCommand({7.0, std::nan("")}, 2, config).value == 0);
  DriveDescription drive;
  drive.kind = CommandKind::kTrackSpeed;
  drive.full_speed = 2.0;
  const VescConfig speeds = configOf(kGeared, drive);
  CHECK(vescCommand({1.5, 9.0}, 1, speeds).kind == Kind::kRpm);
  CHECK(vescCommand({1.5, 9.0}, 1, speeds).value == 7'500);
  CHECK(vescCommand({1.5, 9.0}, 2, speeds).value == 10'000);
  config.brake_current = 12.0;
  CHECK(vescCommand({}, 1, config).kind == Kind::kBrakeCurrent);
  CHECK(vescCommand({}, 1, config).value == 12'000);
}

namespace {

DriveDescription drivenCar() {
  DriveDescription drive;
  drive.layout = DriveLayout::kThrottleSteering;
  drive.full_speed = 1.3;
  drive.max_command = 1.0;
  drive.wheelbase = 0.9;
  drive.max_steering = 0.5;
  return drive;
}

}  // namespace

TEST_CASE("VESC: a car's throttle is its duty, the steering the servo output, NaN goes straight") {
  DriveDescription drive = drivenCar();
  const VescConfig config = configOf("{servo_left: 0.8, servo_right: 0.3}", drive);
  CHECK(config.ids() == std::vector<int>{1});
  CHECK(vescCommand({0.5, 0.2}, 1, config).value == 50'000);
  CHECK(servoCommand({0.5, 0.0}, config).value == 550);
  CHECK(servoCommand({0.5, 0.5}, config).value == 800);
  CHECK(servoCommand({0.5, -0.25}, config).value == 425);
  CHECK(servoCommand({0.5, -9.0}, config).value == 300);
  CHECK(servoCommand({0.5, std::nan("")}, config).value == 550);
  CHECK(vescPayload(servoCommand({0.5, 0.5}, config)) == std::string("\x0c\x03\x20", 3));
  drive.invert_right = true;
  CHECK(servoCommand({0.0, 0.5}, configOf("{servo_left: 0.8, servo_right: 0.3}", drive)).value ==
        300);
  CHECK(refusalOf("{servo_left: 0.4, servo_right: 0.4}", drive).find("nothing would be steered") !=
        std::string::npos);
  CHECK(refusalOf("{throttle: [1], steering: 2}", drive).find("steering") != std::string::npos);
  CHECK(refusalOf("{left: [1]}", drive).find("left") != std::string::npos);
}

TEST_CASE("VESC over UART: a car's servo follows, and goes straight when the drive is stopped") {
  sim::VescSettings settings;
  settings.controllers = 1;
  settings.servo = true;
  UartRig rig(configOf("{}", drivenCar()), settings);
  rig.drive();
  rig.run(5'000'000);
  REQUIRE(rig.state() == BridgeState::kDriving);
  CHECK(rig.device.output(rig.now)[0] == Approx(rig.out.command[0]).margin(1e-4));
  CHECK(rig.device.output(rig.now)[1] ==
        Approx(std::clamp(rig.out.command[1] / 0.5, -1.0, 1.0)).margin(3e-3));
  rig.planner_alive = false;
  rig.run(1'000'000);
  CHECK(rig.device.output(rig.now)[0] == 0.0);
  CHECK(rig.device.output(rig.now)[1] == Approx(0.0).margin(1e-9));
}

TEST_CASE("VESC: four wheels that are not steered are the controllers 1 to 4 unless told") {
  DriveDescription drive;
  drive.layout = DriveLayout::kSkidSteer4;
  CHECK(configOf("{}", drive).left == std::vector<int>{1, 3});
  CHECK(configOf("{}", drive).right == std::vector<int>{2, 4});
  drive.left_channel = 2;
  CHECK(configOf("{}", drive).left == std::vector<int>{2, 4});
  CHECK(configOf("{right: [7]}", drive).right == std::vector<int>{7});
}

TEST_CASE("a VESC section is refused with its line") {
  DriveDescription speed;
  speed.kind = CommandKind::kTrackSpeed;
  CHECK(refusalOf("{}", speed).rfind("vesc.yaml:1", 0) == 0);
  for (const char* bad : {"left: [1, 1]", "left: [2]", "left: []", "left: [1, 2, 3]", "left: [1.5]",
                          "left: [300]", "local: 9", "pole_pairs: 7", "watchdog: 0"}) {
    INFO(bad);
    CHECK(refusalOf(bad).rfind("vesc.yaml:1", 0) == 0);
  }
}

TEST_CASE("VESC over UART: two and four controllers get what is played, and are read") {
  UartRig two(configOf(kGeared));
  drivesAndReads(two);
  CHECK(two.count("replies missing") == 0);
  sim::VescSettings settings;
  settings.controllers = 4;
  VescConfig config = configOf(kGeared);
  config.left = {1, 3};
  config.right = {2, 4};
  UartRig four(config, settings);
  drivesAndReads(four);
  four.device.bank().find(4)->setFault(5);
  four.run(200'000);
  CHECK(four.out.failsafe.reason.rfind("controller 4: power stage too hot", 0) == 0);
}

TEST_CASE("VESC over CAN: two controllers get what is played, and are read") {
  CanRig rig(configOf(kGeared));
  drivesAndReads(rig);
  CHECK(rig.connection.notice().find("200 ms") == std::string::npos);
  CHECK(rig.connection.notice().find("timeout") != std::string::npos);
}

TEST_CASE("VESC: a speed command is held by the controller itself") {
  DriveDescription drive;
  drive.kind = CommandKind::kTrackSpeed;
  drive.full_speed = 1.0;
  VescUart connection(configOf(kGeared, drive));
  sim::VescUartEmulator device;
  connection.open();
  double speed = 0.0;
  for (int64_t now = 1'000'000; now < 6'000'000; now += 1'000) {
    speed += 0.001 * (1.4 * device.output(now)[0] - speed) / 0.2;  // the track with its lag
    device.measure({25.0, {1.0, 1.0}, {speed, speed}});
    if (now % 10'000 != 0) continue;
    connection.receive(device.transmit(now), now);
    if (now % 50'000 == 0) connection.command({0.6, 0.6}, now);
    device.receive(connection.poll(now), now);
  }
  CHECK(speed == Approx(0.6).margin(0.02));
  CHECK(connection.telemetry().measured[0] == Approx(0.6).margin(0.02));
}

TEST_CASE("VESC over UART: no timeout, or too long a one, keeps the robot standing") {
  for (const int64_t timeout : {0, 1000}) {
    sim::VescSettings settings;
    settings.timeout_ms = timeout;
    UartRig rig(configOf("{}"), settings);
    rig.drive();
    rig.run(2'000'000);
    CHECK(rig.last_motion == 0);
    const std::string fault = rig.connection.report(rig.now).link_fault;
    if (fault.find("being started") == std::string::npos) {
      CHECK_THAT(fault, Catch::Contains("set at most 250 ms in VESC Tool"));
    }
    CHECK(rig.count("controller lost: its timeout is not that of the configuration") > 1);
  }
}

TEST_CASE("VESC controllers stop in time, and nothing moves before it is armed") {
  stopsInTime([] { return UartRig{configOf("{}")}; }, 200'000);
  stopsInTime([] { return CanRig{configOf("{}")}; }, 200'000);
}

TEST_CASE("VESC: a reboot and a stall are noticed, and nothing moves before it is armed") {
  const auto noticed = [](auto rig) {
    requireDriving(rig);
    rig.device.reboot(rig.now);
    CHECK(rig.lastMotionWithin(3'000'000) <= 15'000);
    CHECK(rig.count("start-ups") == 2);
    standsUntilArmed(rig, 1'000'000);
    rig.device.setSilent(true);
    CHECK(rig.lastMotionWithin(2'000'000) <= 215'000);
    CHECK(rig.state() == BridgeState::kFault);
    rig.device.setSilent(false);
    standsUntilArmed(rig, 3'000'000);
  };
  noticed(UartRig{configOf("{}")});
  noticed(CanRig{configOf("{}")});
}

TEST_CASE("VESC: the second controller missing keeps the robot standing and is named") {
  sim::VescSettings settings;
  settings.controllers = 1;
  UartRig uart(configOf("{}"), settings);
  uart.run(3'000'000);
  CHECK(uart.count("controller lost: no good answer to COMM_FW_VERSION of VESC 2; check its id "
                   "and its CAN cable") > 1);
  CanRig can(configOf("{}"), settings);
  can.run(3'000'000);
  CHECK_FALSE(can.connection.ready());
  bool named = false;
  for (const auto& [name, count] : can.connection.counters())
    named = named || name.find("no status of VESC 2;") != std::string::npos;
  CHECK(named);
}

TEST_CASE("VESC over UART: lost, cut and garbled packets are counted and stop nobody") {
  UartRig rig{configOf("{}")};
  requireDriving(rig);
  for (int i = 0; i < 300; ++i) {
    rig.run(300'000);
    if (i % 3 == 0) rig.device.loseReplies(1);
    if (i % 3 == 1) rig.device.cutReply();
    if (i % 3 == 2) rig.device.garbleReply();
  }
  CHECK(rig.state() == BridgeState::kDriving);
  CHECK(rig.count("start-ups") == 1);
  CHECK(rig.count("wrong checksums") > 50);
}

TEST_CASE("VESC: a million random and mutated bytes") {
  UartRig uart{configOf("{}")};
  CanRig can{configOf("{}")};
  std::string uart_talk, can_talk;
  for (int i = 0; i < 200; ++i) {
    uart.now = can.now = uart.now + 10'000;
    const std::string said = uart.device.transmit(uart.now);
    uart_talk += said;
    can_talk += can.device.transmit(can.now);
    uart.connection.receive(said, uart.now);
    uart.device.receive(uart.connection.poll(uart.now), uart.now);
  }
  bearsRandomBytes<VescUart>(configOf("{}"), uart_talk, 1'000'000);
  bearsRandomBytes<VescCan>(configOf("{}"), can_talk, 1'000'000);
}
