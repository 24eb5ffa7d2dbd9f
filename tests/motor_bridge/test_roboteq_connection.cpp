// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <random>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"
#include "tests/motor_bridge/scripted_roboteq.hpp"

using namespace tread;
using namespace tread::motor;
using Lines = std::vector<std::string>;

namespace {

/// A connection and a controller on one line in virtual time; commands every 20 ms.
struct Wire {
  RoboteqConfig config;
  ScriptedRoboteq device;
  RoboteqConnection connection;
  int64_t now = 1'000'000;
  TrackCommand wanted;
  bool commanding = true;

  explicit Wire(const RoboteqConfig& c = {}) : config(c), connection(c) {}

  void step() {
    now += 10'000;
    connection.receive(device.read(), now);
    if (commanding && now % 20'000 == 0) connection.command(wanted, now);
    device.write(connection.poll(now), now);
  }
  void run(int64_t us) {
    for (const int64_t end = now + us; now < end;) step();
  }
  void open() {
    connection.open();
    run(300'000);
    REQUIRE(connection.ready());
  }
  int64_t count(const std::string& name) const {
    const auto counters = connection.counters();
    const auto found = counters.find(name);
    return found == counters.end() ? 0 : found->second;
  }
  std::string linkFault() const { return connection.report(now).link_fault; }
};

}  // namespace

TEST_CASE("start-up, byte by byte: echo off, watchdog set and read back, zero, firmware") {
  RoboteqConnection connection{RoboteqConfig{}};
  CHECK(connection.poll(0).empty());
  connection.open();
  CHECK(connection.poll(0) == "^ECHOF 1\r!M 0 0\r");
  connection.receive("^ECHOF 1\r+\r", 5'000);
  CHECK(connection.poll(10'000) == "^RWD 250\r");
  connection.receive("+\r", 15'000);
  CHECK(connection.poll(20'000) == "~RWD\r");
  connection.receive("RWD=250\r", 25'000);
  CHECK(connection.poll(30'000) == "!M 0 0\r");
  connection.receive("+\r", 35'000);
  CHECK(connection.poll(40'000) == "?FID\r");
  connection.receive("FID=Roboteq v1.8\r", 45'000);
  CHECK(connection.ready());
  CHECK(connection.firmware() == "Roboteq v1.8");
  connection.command({0.5, 0.5}, 50'000);
  CHECK(connection.poll(50'000) == "!M 500 500\r");
}

TEST_CASE("nothing but zero can leave before the controller is ready") {
  Wire wire;
  wire.wanted = {1.0, 1.0};
  wire.device.mute = true;
  wire.connection.open();
  wire.run(5'000'000);
  CHECK(wire.device.stands(wire.now));
  for (const std::string& line : wire.device.heard) CHECK((line == "^ECHOF 1" || line == "!M 0 0"));
  CHECK(wire.linkFault() == "controller lost: no good answer to ^ECHOF 1");
}

TEST_CASE("ready, it gives commands and reads voltage, currents, speeds and flags") {
  RoboteqConfig config;
  config.layout.rpm_per_mps = 100.0;
  Wire wire(config);
  wire.wanted = {0.4, -0.3};
  wire.open();
  wire.run(500'000);
  CHECK(wire.device.motor1(wire.now) == 400);
  CHECK(wire.device.motor2(wire.now) == -300);
  CHECK(wire.device.watchdog() == 250);
  CHECK_FALSE(wire.device.echo());
  CHECK(wire.connection.telemetry().battery_voltage == Approx(24.6));
  CHECK(wire.connection.telemetry().current[0] == Approx(1.2));
  CHECK(wire.connection.telemetry().measured[1] == Approx(-0.5));
  CHECK(wire.linkFault().empty());
  CHECK(wire.connection.report(wire.now).device_fault.empty());
  CHECK(wire.count("replies missing") == 0);
  CHECK(wire.count("unexpected replies") == 0);
}

TEST_CASE("two lines for two channels work as well") {
  RoboteqConfig config;
  config.layout.both_in_one_line = false;
  Wire wire(config);
  wire.wanted = {0.4, -0.3};
  wire.open();
  wire.run(500'000);
  CHECK(wire.device.motor1(wire.now) == 400);
  CHECK(wire.device.motor2(wire.now) == -300);
  CHECK(wire.linkFault().empty());
}

TEST_CASE("a watchdog that does not take its setting keeps the robot standing") {
  Wire wire;
  wire.wanted = {1.0, 1.0};
  wire.device.forced_watchdog = 1000;
  wire.connection.open();
  wire.run(3'000'000);
  CHECK_FALSE(wire.connection.ready());
  CHECK(wire.device.stands(wire.now));
  CHECK(wire.count("controller lost: its watchdog did not take its setting") > 1);
  wire.device.forced_watchdog = -1;
  wire.run(2'000'000);
  CHECK(wire.connection.ready());
}

TEST_CASE("a half line left over by a killed predecessor cannot become a command") {
  Wire wire;
  wire.device.write("!M 1000 10", wire.now);
  wire.connection.open();
  for (int i = 0; i < 40; ++i) {
    wire.step();
    REQUIRE(wire.device.stands(wire.now));
  }
  CHECK(wire.connection.ready());
}

TEST_CASE("a refused command is repeated at once and counted") {
  Wire wire;
  wire.wanted = {0.5, 0.5};
  wire.open();
  wire.run(500'000);
  wire.device.refuse = 2;
  wire.run(100'000);
  CHECK(wire.count("commands refused") == 2);
  CHECK(wire.device.motor1(wire.now) == 500);
  CHECK(wire.linkFault().empty());
}

TEST_CASE("single lost and cut replies are counted and stop nobody") {
  Wire wire;
  wire.wanted = {0.5, 0.5};
  wire.open();
  for (int i = 0; i < 40; ++i) {
    wire.run(330'000);
    (i % 2 == 0 ? wire.device.lose : wire.device.cut) = 1;
  }
  wire.run(300'000);
  CHECK(wire.connection.ready());
  CHECK(wire.count("start-ups") == 1);
  CHECK(wire.count("replies missing") >= 40);
}

TEST_CASE("a mute controller is given zero at once, is started up anew, and zero comes first") {
  Wire wire;
  wire.wanted = {0.5, 0.5};
  wire.open();
  wire.run(500'000);
  wire.device.mute = true;
  const int64_t cut = wire.now;
  while (wire.connection.ready()) wire.step();
  CHECK(wire.now - cut <= 270'000);
  CHECK(wire.device.stands(wire.now));
  CHECK(wire.linkFault() == "controller lost: it does not acknowledge commands");
  wire.device.mute = false;
  wire.wanted = {};
  wire.run(1'500'000);
  CHECK(wire.connection.ready());
  CHECK(wire.device.stands(wire.now));
  CHECK(wire.device.resumed == 0);
}

TEST_CASE("queries that are answered do not hide commands that are not") {
  Wire wire;
  wire.open();
  wire.run(500'000);
  wire.device.mute_plus = true;
  wire.run(300'000);
  CHECK_FALSE(wire.connection.ready());
}

TEST_CASE("a deaf controller is stopped by its own watchdog, within 250 ms") {
  Wire wire;
  wire.wanted = {0.5, 0.5};
  wire.open();
  wire.run(500'000);
  wire.device.deaf = true;
  const int64_t cut = wire.now;
  while (!wire.device.stands(wire.now)) wire.step();
  CHECK(wire.now - cut <= 260'000);
  wire.run(2'000'000);
  wire.device.deaf = false;
  wire.wanted = {};
  wire.run(2'000'000);
  CHECK(wire.connection.ready());
  CHECK(wire.device.resumed == 0);
}

TEST_CASE("after a silence of the bridge itself zero goes first") {
  Wire wire;
  wire.wanted = {0.5, 0.5};
  wire.open();
  wire.run(500'000);
  wire.device.read();
  wire.now += 300'000;
  REQUIRE(wire.device.stands(wire.now));
  wire.connection.receive("+\r", wire.now);
  wire.connection.command({0.5, 0.5}, wire.now);
  wire.device.write(wire.connection.poll(wire.now), wire.now);
  CHECK(wire.device.stands(wire.now));
  CHECK(wire.device.resumed == 0);
  CHECK(wire.count("zero before resuming") == 1);
}

TEST_CASE("a controller that was switched off and on in between is noticed and started up anew") {
  Wire wire;
  wire.wanted = {0.5, 0.5};
  wire.open();
  wire.run(500'000);
  wire.device.powerCycle();
  wire.run(50'000);
  CHECK(wire.linkFault().rfind("controller lost: it was restarted", 0) == 0);
  CHECK(wire.device.stands(wire.now));
  wire.wanted = {};
  wire.run(1'000'000);
  CHECK(wire.connection.ready());
  CHECK(wire.device.watchdog() == 250);
}

TEST_CASE("a watchdog setting that is lost later is noticed within two seconds") {
  Wire wire;
  wire.open();
  wire.run(500'000);
  wire.device.forced_watchdog = 1000;
  wire.device.write("^RWD 1000\r", wire.now);
  wire.run(2'000'000);
  CHECK(wire.count("controller lost: its watchdog setting was lost") == 1);
}

TEST_CASE("device faults are reported in words within a tenth of a second, and go when they go") {
  Wire wire;
  wire.open();
  wire.run(500'000);
  wire.device.fault_flags = 4;
  wire.run(150'000);
  CHECK(wire.connection.report(wire.now).device_fault == "controller: undervoltage");
  wire.device.fault_flags = 0;
  wire.device.status_flags = 1 | 16;
  wire.run(150'000);
  CHECK(wire.connection.report(wire.now).device_fault == "controller: stall detected");
  wire.device.status_flags = 1;
  wire.run(150'000);
  CHECK(wire.connection.report(wire.now).device_fault.empty());
}

TEST_CASE("an E-stop is held in the controller, too, until it is released") {
  Wire wire;
  wire.wanted = {};
  wire.open();
  wire.run(500'000);
  wire.connection.holdStop(true);
  wire.run(300'000);
  CHECK(wire.connection.report(wire.now).stop_latched);
  CHECK(wire.linkFault().empty());
  wire.connection.releaseStop(wire.now);
  wire.run(300'000);
  CHECK_FALSE(wire.connection.report(wire.now).stop_latched);
  CHECK(wire.device.stands(wire.now));
  CHECK(std::count(wire.device.heard.begin(), wire.device.heard.end(), "!MG") >= 1);
}

TEST_CASE("closing forgets what was to be sent, and reopening starts up anew") {
  Wire wire;
  wire.wanted = {0.5, 0.5};
  wire.open();
  wire.connection.command({1.0, 1.0}, wire.now);
  wire.connection.close("unplugged");
  CHECK(wire.connection.poll(wire.now).empty());
  CHECK(wire.linkFault() == "controller lost: unplugged");
  wire.connection.command({1.0, 1.0}, wire.now);
  CHECK(wire.connection.poll(wire.now).empty());
  wire.wanted = {};
  wire.open();
  CHECK(wire.count("start-ups") == 2);
}

TEST_CASE("attempts on a dead line are spaced up to a second") {
  Wire wire;
  wire.device.deaf = true;
  wire.connection.open();
  wire.run(60'000'000);
  const int64_t attempts = wire.count("controller lost: no good answer to ^ECHOF 1");
  CHECK(attempts >= 45);
  CHECK(attempts <= 50);
}

TEST_CASE("garbage in any order never breaks it, and never moves the motors") {
  std::mt19937_64 random(5);
  const Lines pieces = {"+\r",
                        "-\r",
                        "RWD=250\r",
                        "RWD=9\r",
                        "FID=x\r",
                        "A=1:2\r",
                        "FF=0\r",
                        "FF=\r",
                        "FS=1\r",
                        "V=",
                        ":::\r",
                        "\r\r",
                        "?A\r",
                        "!M 5 5\r",
                        "\xff\xfe",
                        "=\r",
                        "A=9999999999999999999999:1\r",
                        "+",
                        "-",
                        "~RWD\r"};
  for (int run = 0; run < 50; ++run) {
    RoboteqConnection connection{RoboteqConfig{}};
    connection.open();
    int64_t now = 0;
    for (int i = 0; i < 5'000; ++i) {
      now += 10'000;
      connection.receive(pieces[random() % pieces.size()], now);
      connection.command({}, now);
      const std::string sent = connection.poll(now);
      REQUIRE((sent.find("!M") == std::string::npos || sent.find("!M 0 0\r") != std::string::npos));
      REQUIRE(sent.size() < 200);
    }
  }
}
