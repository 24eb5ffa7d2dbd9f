// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/sabertooth/sabertooth_connection.hpp"
#include "modules/simulator/emulators/sabertooth/sabertooth_emulator.hpp"
#include "tests/motor_bridge/controller_promises.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

using SabertoothRig = EmulatedRig<SabertoothConnection, sim::SabertoothEmulator>;

SabertoothConfig sabertoothOf(const std::string& text, const DriveDescription& drive = {}) {
  ConfigReader reader = ConfigReader::fromText(text, "sabertooth.yaml");
  const SabertoothConfig config = readSabertoothConfig(reader, drive);
  reader.finish();
  return config;
}

}  // namespace

TEST_CASE("Sabertooth packets: the manual's example, and both motors both ways") {
  // Address 130, motor 1 forwards at 64: checksum 66.
  CHECK(sabertoothPacket(130, 0, 64) == std::string("\x82\x00\x40\x42", 4));
  SabertoothConfig config = sabertoothOf("{}");
  config.left_motor = 2;
  config.invert_right = true;
  SabertoothConnection connection(config);
  connection.open();
  for (int64_t now = 0; !connection.ready(); now += 10'000) connection.poll(now);
  connection.command({0.5, 1.0}, 20'000);
  CHECK(connection.poll(20'000) == sabertoothPacket(128, 1, 127) + sabertoothPacket(128, 4, 64));
  connection.command({std::nan(""), -7.0}, 30'000);
  CHECK(connection.poll(30'000) == sabertoothPacket(128, 0, 127) + sabertoothPacket(128, 4, 0));
}

TEST_CASE("a Sabertooth section is refused with its line") {
  for (const char* bad : {"address: 127", "address: 136", "watchdog: 0", "watchdog: 0.25",
                          "watchdog: 1", "addres: 128"}) {
    INFO(bad);
    try {
      sabertoothOf(bad);
      FAIL("accepted");
    } catch (const ConfigError& error) {
      CHECK(std::string(error.what()).rfind("sabertooth.yaml:1", 0) == 0);
    }
  }
}

TEST_CASE("an emulated Sabertooth gets what is played, and what it cannot say is told once") {
  SabertoothRig rig{sabertoothOf("{}")};
  requireDriving(rig);
  rig.run(5'000'000);
  CHECK(rig.device.output(rig.now)[0] == Approx(rig.out.command[0]).margin(0.005));
  CHECK(rig.device.output(rig.now)[1] == Approx(rig.out.command[1]).margin(0.005));
  CHECK(rig.device.timeoutUs() == 200'000);
  CHECK(rig.connection.notice().find("does not answer") != std::string::npos);
  CHECK(rig.device.badSums() == 0);
}

TEST_CASE("Sabertooth: it stops in time, and nothing moves before it is armed") {
  stopsInTime([] { return SabertoothRig{sabertoothOf("{}")}; }, 200'000);
}

TEST_CASE("Sabertooth: a restarted one has its baud rate and its watchdog again within a second") {
  SabertoothRig rig{sabertoothOf("{}")};
  requireDriving(rig);
  rig.device.reboot(rig.now);
  REQUIRE_FALSE(rig.turning());
  rig.run(1'000'000);
  CHECK(rig.device.timeoutUs() == 200'000);
  rig.bridge_alive = false;
  CHECK(rig.lastMotionWithin(1'000'000) <= 215'000);
}

TEST_CASE("Sabertooth: lost bytes leave no wrong command on the motors for long") {
  SabertoothRig rig{sabertoothOf("{}")};
  requireDriving(rig);
  rig.lost_bytes = 0.05;
  rig.run(20'000'000);
  CHECK(rig.device.badSums() > 10);
  rig.lost_bytes = 0.0;
  rig.planner_alive = false;
  CHECK(rig.lastMotionWithin(1'000'000) <= 230'000);
}

TEST_CASE("Sabertooth: a million random bytes") {
  bearsRandomBytes<SabertoothConnection>(sabertoothOf("{}"), "nothing", 1'000'000);
}
