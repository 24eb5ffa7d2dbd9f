// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <limits>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/roboteq/roboteq_session.hpp"

using namespace tread;
using namespace tread::motor;
using Lines = std::vector<std::string>;

TEST_CASE("a command becomes one line for both tracks, in per mille") {
  CHECK(commandLines({0.5, -0.25}, {}) == Lines{"!M 500 -250"});
  CHECK(commandLines({0.0004, 0.0006}, {}) == Lines{"!M 0 1"});
  CHECK(commandLines({-0.0, 0.0}, {}) == Lines{"!M 0 0"});
}

TEST_CASE("the layout says which channel is which track, which way it turns and how it is told") {
  RoboteqLayout layout;
  layout.left_channel = 2;
  CHECK(commandLines({0.5, -0.25}, layout) == Lines{"!M -250 500"});
  layout.invert_right = true;
  CHECK(commandLines({0.5, -0.25}, layout) == Lines{"!M 250 500"});
  layout.both_in_one_line = false;
  layout.invert_left = true;
  CHECK(commandLines({0.5, -0.25}, layout) == Lines{"!G 1 250", "!G 2 -500"});
  layout = {};
  layout.full_scale = 2.0;
  CHECK(commandLines({1.0, 2.0}, layout) == Lines{"!M 500 1000"});
}

TEST_CASE("the last look before the wire: NaN is zero, too much is full scale") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(commandLines({nan, infinity}, {}) == Lines{"!M 0 0"});
  CHECK(commandLines({1.5, -7e300}, {}) == Lines{"!M 1000 -1000"});
}

TEST_CASE("lines are cut at CR, however they arrive, and control bytes are dropped") {
  LineCutter lines;
  CHECK(lines.push("A=10").empty());
  CHECK(lines.push("0:20\r\n\r+\r-") == Lines{"A=100:20", "+"});
  CHECK(lines.push("\r") == Lines{"-"});
  CHECK(lines.push(std::string("\x01\xff\x80+\r", 5)) == Lines{"+"});
  CHECK(lines.garbageBytes() == 3);
}

TEST_CASE("an endless line is discarded up to its end, and the next one is read") {
  LineCutter lines;
  for (int i = 0; i < 100'000; ++i) REQUIRE(lines.push("x").empty());
  CHECK(lines.push("\rV=1:2:3\r") == Lines{"V=1:2:3"});
  CHECK(lines.overlong() == 1);
}

TEST_CASE("replies are recognised, and what is none is said to be other") {
  using Kind = RoboteqReply::Kind;
  CHECK(parseReply("+").kind == Kind::kAck);
  CHECK(parseReply("-").kind == Kind::kRefused);
  const RoboteqReply volts = parseReply("V=135:246:4730");
  CHECK(volts.kind == Kind::kValue);
  CHECK(volts.key == "V");
  CHECK(volts.values == std::vector<long>{135, 246, 4730});
  CHECK(parseReply("A=-5:12").values == std::vector<long>{-5, 12});
  const RoboteqReply id = parseReply("FID=Roboteq v1.8d");
  CHECK(id.values.empty());
  CHECK(id.text == "Roboteq v1.8d");
  for (const char* line : {"", "=5", "++", "A", "a=5", "TOOLONGKEY=5", "?A=1", "\x7f"})
    CHECK(parseReply(line).kind == Kind::kOther);
  for (const char* line : {"A=", "A=1:", "A=:1", "A=1:x", "A=+"})
    CHECK(parseReply(line).values.empty());
  CHECK(isEcho("!M 0 0"));
  CHECK(isEcho("~RWD"));
  CHECK_FALSE(isEcho("+"));
  CHECK_FALSE(isEcho("FF=0"));
}

TEST_CASE("fault flags in words, flags that only describe stop nobody") {
  CHECK(describeFaults(0, 1 | 2 | 4 | 32 | 128).empty());
  CHECK(describeFaults(1 | 4, 0) == "controller: overheat, undervoltage");
  CHECK(describeFaults(16, 8) == "controller: emergency stop, power stage off");
  CHECK(describeFaults(2 | 8 | 32 | 64 | 128, 16) ==
        "controller: overvoltage, short circuit, sensor or set-up fault, MOSFET failure, "
        "default configuration loaded, stall detected");
  CHECK(describeFaults(256, 0) == "controller: unknown fault flag");
}

TEST_CASE("telemetry in SI units, left and right by the layout") {
  RoboteqLayout layout;
  layout.left_channel = 2;
  layout.invert_left = true;
  layout.rpm_per_mps = 100.0;
  RoboteqTelemetry telemetry;
  CHECK(telemetry.take(parseReply("A=120:-70"), layout, 5));
  CHECK(telemetry.current[0] == Approx(-7.0));
  CHECK(telemetry.current[1] == Approx(12.0));
  CHECK(telemetry.take(parseReply("V=135:246:4730"), layout, 5));
  CHECK(telemetry.battery_voltage == Approx(24.6));
  CHECK(telemetry.take(parseReply("S=50:-100"), layout, 5));
  CHECK(telemetry.measured[0] == Approx(1.0));
  CHECK(telemetry.measured[1] == Approx(0.5));
  CHECK(telemetry.take(parseReply("T=31:45:38"), layout, 5));
  CHECK(telemetry.temperature == 45.0);
  CHECK(telemetry.take(parseReply("FM=2:9"), layout, 5));
  CHECK(describeMotorFaults("left", telemetry.motor_flags_left) == "left motor: safety stop");
  CHECK(describeMotorFaults("right", telemetry.motor_flags_right) == "right motor: stall");
  CHECK(describeMotorFaults("left", 1 | 16 | 32).empty());
  CHECK_FALSE(telemetry.take(parseReply("FM=2"), layout, 7));
  CHECK_FALSE(telemetry.take(parseReply("FM=2:70000"), layout, 7));
  CHECK(telemetry.take(parseReply("FF=5"), layout, 6));
  CHECK(telemetry.fault_flags == 5);
  CHECK(telemetry.faults_read_at == 6);
  for (const char* line : {"FF=4294967296", "FF=65536", "FF=-1", "FF=99999999999999999999"})
    CHECK_FALSE(telemetry.take(parseReply(line), layout, 7));
  CHECK_FALSE(telemetry.take(parseReply("FS=4294967296"), layout, 7));
  CHECK_FALSE(telemetry.status_read_at);
  CHECK(telemetry.faults_read_at == 6);
  CHECK_FALSE(telemetry.take(parseReply("A=1"), layout, 7));
  CHECK_FALSE(telemetry.take(parseReply("FF="), layout, 7));
  CHECK_FALSE(telemetry.take(parseReply("XY=1"), layout, 7));
  CHECK(telemetry.fault_flags == 5);
}
