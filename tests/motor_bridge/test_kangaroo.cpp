// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/kangaroo/kangaroo_connection.hpp"
#include "modules/simulator/emulators/kangaroo/kangaroo_emulator.hpp"
#include "tests/motor_bridge/controller_promises.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

using KangarooRig = EmulatedRig<KangarooConnection, sim::KangarooEmulator>;

DriveDescription heldSpeedDrive() {
  DriveDescription drive;
  drive.kind = CommandKind::kTrackSpeed;
  drive.full_speed = drive.max_command = 1.2;
  return drive;
}

KangarooConfig kangarooOf(const std::string& text = "units_per_metre: 1000") {
  ConfigReader reader = ConfigReader::fromText(text, "kangaroo.yaml");
  const KangarooConfig config = readKangarooConfig(reader, heldSpeedDrive());
  reader.finish();
  return config;
}

std::string statusOf(char channel, int value, bool error) {
  return kangarooPacket(
      128, KangarooCommand::kStatus,
      std::string{channel, static_cast<char>(error), kKangarooSpeed} + kangarooNumber(value));
}

}  // namespace

TEST_CASE("Kangaroo packets: known checksums and numbers, split, glued and damaged") {
  CHECK(kangarooStart(128, '1') == std::string("\x80\x20\x02\x31\x00\x22\x44", 7));
  CHECK(kangarooNumber(1000) == "\x50\x1f");
  CHECK(kangarooNumber(-1) == "\x03");
  for (const int value : {0, 1, -1, 31, 32, -700, 123456, (1 << 29) - 1, 1 - (1 << 29)}) {
    const std::string bytes = kangarooNumber(value);
    size_t offset = 0;
    int32_t read = 7;
    REQUIRE(readKangarooNumber(bytes, offset, read));
    CHECK(read == value);
    CHECK(offset == bytes.size());
    offset = 0;
    CHECK_FALSE(readKangarooNumber(bytes.substr(0, bytes.size() - 1), offset, read));
  }
  CHECK(kangarooNumber(int64_t{1} << 40) == kangarooNumber((1 << 29) - 1));
  KangarooPackets packets(128);
  const std::string talk = statusOf('1', 700, false);
  CHECK(packets.push(talk.substr(0, 4)).empty());
  CHECK(packets.push(talk.substr(4) + talk).size() == 2);
  std::string damaged = talk;
  damaged[5] ^= 1;
  CHECK(packets.push(damaged + "garbage" + talk).size() == 1);
  CHECK(packets.badChecksums() == 1);
  CHECK(packets.garbageBytes() == 7);
  // An incomplete packet does not destroy the next one.
  CHECK(packets.push(talk.substr(0, 6) + talk).size() == 1);
}

TEST_CASE("a Kangaroo's tracks get their speeds both ways, whichever channel is the left one") {
  KangarooConfig config = kangarooOf();
  config.left_channel = 2;
  config.invert_right = true;
  KangarooConnection connection(config);
  connection.open();
  int64_t now = 0;
  for (; !connection.ready() && now < 500'000; now += 10'000) {
    connection.poll(now);
    connection.receive(statusOf('1', 0, false) + statusOf('2', 0, false), now);
  }
  REQUIRE(connection.ready());
  connection.poll(now);
  connection.command({0.5, 1.0}, now);
  CHECK(connection.poll(now) == kangarooSpeed(128, '1', -1000) + kangarooSpeed(128, '2', 500));
  connection.command({std::nan(""), -7.0}, now);
  CHECK(connection.poll(now) == kangarooSpeed(128, '1', 1200) + kangarooSpeed(128, '2', 0));
}

TEST_CASE("a Kangaroo section is refused with its line") {
  for (const char* bad :
       {"{}", "units_per_metre: 0", "{units_per_metre: 100, address: 127}",
        "{units_per_metre: 100, watchdog: 0.2}", "{units_per_metre: 100, adress: 128}"}) {
    INFO(bad);
    try {
      kangarooOf(bad);
      FAIL("accepted");
    } catch (const ConfigError& error) {
      CHECK(std::string(error.what()).rfind("kangaroo.yaml:", 0) == 0);
    }
  }
}

TEST_CASE("an emulated Kangaroo holds what is played and tells its speeds") {
  KangarooRig rig{kangarooOf()};
  sim::DriveMeasurements measured;
  measured.track_speed = {0.8, -0.4};
  rig.device.measure(measured);
  requireDriving(rig);
  rig.run(5'000'000);
  CHECK((*rig.device.heldSpeeds())[0] == Approx(rig.out.command[0]).margin(0.001));
  CHECK((*rig.device.heldSpeeds())[1] == Approx(rig.out.command[1]).margin(0.001));
  CHECK(rig.device.timeoutUs() == 187'500);
  CHECK(rig.connection.telemetry().measured[0] == Approx(0.8).margin(0.001));
  CHECK(rig.connection.telemetry().measured[1] == Approx(-0.4).margin(0.001));
  CHECK(rig.connection.notice().find("serial timeout") != std::string::npos);
  CHECK(rig.device.badSums() == 0);
  CHECK(rig.count("start-ups") == 1);
}

TEST_CASE("Kangaroo: it stops in time, and nothing moves before it is armed") {
  stopsInTime([] { return KangarooRig{kangarooOf()}; }, 187'500);
}

TEST_CASE("Kangaroo: a restarted one has its timeout again, and stands until it is armed") {
  KangarooRig rig{kangarooOf()};
  requireDriving(rig);
  rig.device.reboot(rig.now);
  REQUIRE_FALSE(rig.turning());
  standsUntilArmed(rig, 3'000'000);
  CHECK(rig.device.timeoutUs() == 187'500);
  CHECK(rig.count("start-ups") == 2);
}

TEST_CASE("Kangaroo: a channel that lost control is a fault in words, and stands") {
  KangarooRig rig{kangarooOf()};
  requireDriving(rig);
  rig.device.loseControl(1);
  rig.run(500'000);
  CHECK(rig.state() != BridgeState::kDriving);
  CHECK(rig.connection.report(rig.now).device_fault.rfind("channel 2 has lost control", 0) == 0);
  CHECK_FALSE(rig.turning());
}

TEST_CASE("Kangaroo: an untuned one is not driven, and the reason stands there") {
  KangarooConnection connection(kangarooOf());
  connection.open();
  for (int64_t now = 0; now < 2'000'000; now += 10'000) {
    connection.receive(statusOf('1', 4, true), now);
    connection.command({0.5, 0.5}, now);
    connection.poll(now);
    CHECK_FALSE(connection.ready());
  }
  CHECK(connection.counters().at(
            "controller lost: channel 1 is tuned for another mode than its switches select") > 1);
}

TEST_CASE("Kangaroo: lost and damaged bytes leave no wrong command on the motors for long") {
  KangarooRig rig{kangarooOf()};
  requireDriving(rig);
  rig.lost_bytes = 0.02;
  rig.run(20'000'000);
  CHECK(rig.device.badSums() > 5);
  rig.lost_bytes = 0.0;
  rig.planner_alive = false;
  CHECK(rig.lastMotionWithin(1'000'000) <= 230'000);
}

TEST_CASE("Kangaroo: a million random bytes") {
  bearsRandomBytes<KangarooConnection>(
      kangarooOf(), statusOf('1', 0, false) + statusOf('2', 0, false) + statusOf('1', 3, true),
      1'000'000);
}
