// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"

namespace tread::sim {
namespace {

/// The driver's end of the line: sends, waits, and reads the reply.
class Terminal {
 public:
  explicit Terminal(const RoboteqSettings& settings = {}) : controller(settings) {}

  std::string ask(const std::string& bytes, int64_t wait_us = 10000) {
    controller.receive(bytes, now);
    now += wait_us;
    return controller.transmit(now);
  }
  /// Echo off, so that only replies return.
  void quiet() { ask("^ECHOF 1\r"); }
  MotorValues output() { return controller.output(now); }

  RoboteqEmulator controller;
  int64_t now = 1000000;
};

using Output = MotorValues;

}  // namespace

TEST_CASE("after power-up the controller echoes, has a watchdog of one second and gives no power") {
  Terminal line;
  CHECK(line.output() == Output{0.0, 0.0});
  CHECK(line.ask("~RWD\r") == "~RWD\rRWD=1000\r");
  CHECK(line.ask("^ECHOF 1\r") == "^ECHOF 1\r+\r");
  CHECK(line.ask("~RWD\r") == "RWD=1000\r");
  CHECK(line.ask("^ECHOF 0\r") == "+\r");
  CHECK(line.ask("?FF\r") == "?FF\rFF=0\r");
}

TEST_CASE(
    "an underscore ends a line like CR, case does not matter, control characters are nothing") {
  Terminal line;
  CHECK(line.ask("^echof 1_") == "^echof 1_+\r");
  CHECK(line.ask("!m 100 -200_?m_") == "+\rM=100:-200\r");
  CHECK(line.ask("!M\n 1\t0 20\r") == "+\r");
  CHECK(line.ask("?M\r") == "M=10:20\r");
  CHECK(line.ask("\r\r_") == "");
  CHECK(line.ask("\x05") == "\x06");
}

TEST_CASE("commands out of range, unknown or malformed are refused and change nothing") {
  Terminal line;
  line.quiet();
  CHECK(line.ask("!M 500 500\r") == "+\r");
  for (const char* bad :
       {"!M 1001 0\r",  "!M 0 -1001\r", "!M 1 2 3\r", "!M\r",    "!M 1.5 0\r", "!M abc 0\r",
        "!G 3 100\r",   "!G 1 2000\r",  "!Q\r",       "hello\r", "?XYZ\r",     "^RWD -1\r",
        "^RWD 65001\r", "^ECHOF 2\r",   "^NOPE 1\r",  "~NOPE\r", "?A 3\r",     "?A x\r",
        "%EESAV 1\r",   "%RESET 1\r",   "!MS 3\r"}) {
    INFO(bad);
    CHECK(line.ask(bad, 5000) == "-\r");
  }
  CHECK(line.ask(std::string(200, '9') + "\r", 50000) == "-\r");
  CHECK(line.output() == Output{0.5, 0.5});
}

TEST_CASE("both channels in one line, one channel alone, stop of one or all") {
  Terminal line;
  line.quiet();
  line.ask("!M 250 -750\r");
  CHECK(line.output() == Output{0.25, -0.75});
  line.ask("!G 1 1000\r");
  CHECK(line.output() == Output{1.0, -0.75});
  line.ask("!G 2 -1000\r");
  CHECK(line.output() == Output{1.0, -1.0});
  line.ask("!MS 1\r");
  CHECK(line.output() == Output{0.0, -1.0});
  line.ask("!MS\r");
  CHECK(line.output() == Output{0.0, 0.0});
}

TEST_CASE("only commands feed the watchdog, queries and settings do not") {
  Terminal line;
  line.quiet();
  CHECK(line.ask("^RWD 250\r") == "+\r");
  CHECK(line.ask("~RWD\r") == "RWD=250\r");
  line.ask("!M 800 800\r");
  for (int i = 0; i < 20; ++i) {
    line.ask("!M 800 800\r", 200000);
    CHECK(line.output() == Output{0.8, 0.8});
  }
  line.ask("!M 800 800\r", 0);
  for (int i = 0; i < 23; ++i) line.ask("?A\r^RWD 250\r~RWD\r?FF\r", 10000);
  CHECK(line.output() == Output{0.8, 0.8});
  for (int i = 0; i < 3; ++i) line.ask("?A\r?V\r", 10000);
  CHECK(line.output() == Output{0.0, 0.0});
  CHECK(line.ask("?M\r") == "M=0:0\r");
  CHECK(line.ask("?FS\r") == "FS=0\r");
}

TEST_CASE("the watchdog stops the motors at its time, to the byte") {
  Terminal line;
  line.quiet();
  line.ask("^RWD 100\r");
  line.controller.receive("!M 500 500\r", line.now);
  // The last of 11 bytes has arrived 955 us later, when the command takes effect.
  const int64_t heard = line.now + 955;
  CHECK(line.controller.output(heard - 1) == Output{0.0, 0.0});
  CHECK(line.controller.output(heard) == Output{0.5, 0.5});
  CHECK(line.controller.output(heard + 99999) == Output{0.5, 0.5});
  CHECK(line.controller.output(heard + 100000) == Output{0.0, 0.0});
}

TEST_CASE("a watchdog of zero never stops anything") {
  Terminal line;
  line.quiet();
  line.ask("^RWD 0\r");
  line.ask("!M 300 300\r", 60000000);
  CHECK(line.output() == Output{0.3, 0.3});
}

TEST_CASE("after the watchdog any good command lets the motors run on at the old speed") {
  Terminal line;
  line.quiet();
  line.ask("!M 600 600\r", 2000000);
  CHECK(line.output() == Output{0.0, 0.0});
  CHECK(line.ask("!M 2000 0\r") == "-\r");
  CHECK(line.output() == Output{0.0, 0.0});
  line.ask("!MG\r");
  CHECK(line.output() == Output{0.6, 0.6});

  line.ask("?M\r", 2000000);
  line.ask("!M 0 0\r");
  CHECK(line.output() == Output{0.0, 0.0});
}

TEST_CASE("emergency stop is latched in the fault flags until it is released") {
  Terminal line;
  line.quiet();
  line.ask("!M 600 600\r");
  CHECK(line.ask("!EX\r") == "+\r");
  CHECK(line.output() == Output{0.0, 0.0});
  CHECK(line.ask("?FF\r") == "FF=16\r");
  CHECK(line.ask("?FS\r") == "FS=9\r");
  CHECK(line.ask("!M 100 100\r") == "+\r");
  CHECK(line.output() == Output{0.0, 0.0});
  CHECK(line.ask("!MG\r") == "+\r");
  CHECK(line.ask("?FF\r") == "FF=0\r");
  CHECK(line.output() == Output{0.1, 0.1});
}

TEST_CASE("queries tell what the drive measures") {
  RoboteqSettings settings;
  Terminal line(settings);
  line.quiet();
  line.controller.measure({24.36, {12.34, -5.0}, {1.0, -0.5}});
  CHECK(line.ask("?V\r") == "V=135:244:4980\r");
  CHECK(line.ask("?V 2\r") == "V=244\r");
  CHECK(line.ask("?A\r") == "A=123:-50\r");
  CHECK(line.ask("?A 2\r") == "A=-50\r");
  CHECK(line.ask("?T\r") == "T=32:30:30\r");
  CHECK(line.ask("?FID\r").substr(0, 12) == "FID=Roboteq ");
  CHECK(line.ask("?S\r") == "-\r");
  settings.encoders = true;
  Terminal with_encoders(settings);
  with_encoders.quiet();
  with_encoders.controller.measure({24.0, {0.0, 0.0}, {1.0, -0.5}});
  CHECK(with_encoders.ask("?S\r") == "S=400:-200\r");
}

TEST_CASE("bytes take their time on the line in both directions") {
  Terminal line;
  line.quiet();
  line.controller.receive("?FF\r", line.now);
  // 4 bytes there (348 us), 300 us of processing, 5 bytes back (435 us).
  CHECK(line.controller.transmit(line.now + 640) == "");
  CHECK(line.controller.transmit(line.now + 830) == "FF");
  CHECK(line.controller.transmit(line.now + 1100) == "=0\r");
  line.now += 2000;
  const std::string many(1000, '\n');
  line.controller.receive(many + "!M 10 10\r", line.now);
  CHECK(line.controller.output(line.now + 86000) == Output{0.0, 0.0});
  CHECK(line.controller.output(line.now + 89000) == Output{0.01, 0.01});
}

TEST_CASE("lost and cut replies fall away, the command counts all the same") {
  Terminal line;
  line.quiet();
  line.controller.loseReplies(1);
  CHECK(line.ask("!M 200 200\r") == "");
  CHECK(line.output() == Output{0.2, 0.2});
  CHECK(line.ask("!M 200 200\r") == "+\r");
  line.controller.cutReply();
  CHECK(line.ask("?FF\r") == "FF");
  CHECK(line.ask("?FF\r") == "FF=0\r");
}

TEST_CASE("half a command is no command, whatever follows") {
  Terminal line;
  line.quiet();
  line.ask("!M 100 100\r");
  line.ask("!M 9");
  CHECK(line.output() == Output{0.1, 0.1});
  CHECK(line.ask("!M 300 300\r") == "-\r");
  CHECK(line.output() == Output{0.1, 0.1});
}

TEST_CASE("a reboot brings back echo, the default watchdog and zero") {
  Terminal line;
  line.quiet();
  line.ask("^RWD 250\r!M 700 700\r");
  line.controller.reboot(line.now);
  CHECK(line.output() == Output{0.0, 0.0});
  CHECK(line.ask("?FF\r", 300000) == "");
  line.now += 200000;
  CHECK(line.ask("~RWD\r") == "~RWD\rRWD=1000\r");
}

TEST_CASE("a brown-out switches the power stage off, tells so and lets go when it is over") {
  Terminal line;
  line.quiet();
  line.ask("!M 400 400\r");
  line.controller.setBrownOut(true);
  CHECK(line.output() == Output{0.0, 0.0});
  CHECK(line.ask("?FF\r") == "FF=4\r");
  CHECK(line.ask("?V\r") == "V=135:120:4980\r");
  line.controller.setBrownOut(false);
  CHECK(line.output() == Output{0.4, 0.4});
  line.controller.measure({17.0, {}, {}});
  CHECK(line.ask("?FF\r") == "FF=4\r");
}

TEST_CASE("a silent controller hears nothing and its watchdog stops the motors") {
  Terminal line;
  line.quiet();
  line.ask("!M 400 400\r");
  line.controller.setSilent(true);
  CHECK(line.ask("!M 400 400\r", 500000) == "");
  CHECK(line.output() == Output{0.4, 0.4});
  line.ask("!M 400 400\r", 600000);
  CHECK(line.output() == Output{0.0, 0.0});
}

}  // namespace tread::sim
