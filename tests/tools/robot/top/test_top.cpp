// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// tread-top in a terminal, with a robot that only publishes its presence.
#include <catch2/catch.hpp>

#include <pty.h>

#include "common/bus/lcm_bus.hpp"
#include "common/messages/blank.hpp"
#include "common/seal/key_file.hpp"
#include "tests/system/process.hpp"
#include "tests/tools/called_program.hpp"

using namespace tread;
using namespace tread::testing;

namespace {

/// The robot's end of the bus: publishes MOTOR, and stores requests.
class Robot {
 public:
  explicit Robot(const std::string& url, const std::string& key = "")
      : bus_(BusAccess{url, hostSealer(key)}, TimeSource::kHost) {
    bus_.subscribe<estop_t>(kEstop, [this](const estop_t& stop) { stopped = stop.engaged != 0; });
    bus_.subscribe<arm_t>(kArm, [this](const arm_t& arm) { armed = arm.armed != 0; });
  }
  void run(double seconds) {
    const int64_t end = bus_.now() + static_cast<int64_t>(1e6 * seconds);
    while (bus_.now() < end) {
      auto motor = blank<motor_t>();
      motor.utime = bus_.now();
      motor.seq = seq_++;
      motor.bridge_state = stopped ? motor_t::STATE_ESTOP
                           : armed ? motor_t::STATE_ARMED
                                   : motor_t::STATE_DISARMED;
      motor.state_reason = "says the test";
      bus_.publish(kMotor, motor);
      bus_.handle(40);
    }
  }
  bool stopped = false;
  bool armed = false;

 private:
  LcmBus bus_;
  int64_t seq_ = 0;
};

}  // namespace

TEST_CASE("tread-top --once prints what it saw, without a terminal") {
  const std::string url = ownLcmUrl();
  Robot robot(url);
  const samples::OwnFolder folder;
  Process top("tread-top", {"--once", "2", "--lcm-url", url}, folder.path("out.txt"));
  while (top.running()) robot.run(0.1);
  CAPTURE(folder.text("out.txt"));
  CHECK(top.exitCode() == 0);
  CHECK_THAT(folder.text("out.txt"), Catch::Contains("motors   disarmed: says the test"));
  CHECK_THAT(folder.text("out.txt"), Catch::Contains("MOTOR"));
}

TEST_CASE("of a robot with a key tread-top shows what is sealed by it, and tells of the rest") {
  const std::string url = ownLcmUrl();
  const samples::OwnFolder folder;
  writeNewKey(folder.path("key"));
  Robot stranger(url);
  Process forged("tread-top", {"--once", "2", "--lcm-url", url, "--key", folder.path("key")},
                 folder.path("forged.txt"));
  while (forged.running()) stranger.run(0.1);
  CAPTURE(folder.text("forged.txt"));
  CHECK_THAT(folder.text("forged.txt"), Catch::Contains("motors   no MOTOR message") &&
                                            Catch::Contains("trust    messages not shown: ") &&
                                            Catch::Contains(" unsealed"));
  Robot robot(url, folder.path("key"));
  Process sealed("tread-top", {"--once", "2", "--lcm-url", url, "--key", folder.path("key")},
                 folder.path("sealed.txt"));
  while (sealed.running()) robot.run(0.1);
  CAPTURE(folder.text("sealed.txt"));
  CHECK_THAT(folder.text("sealed.txt"),
             Catch::Contains("motors   disarmed: says the test") && !Catch::Contains("trust"));
  Process without("tread-top", {"--once", "2", "--lcm-url", url}, folder.path("without.txt"));
  while (without.running()) robot.run(0.1);
  CHECK_THAT(folder.text("without.txt"), Catch::Contains("nothing here is proven: --key FILE"));
}

TEST_CASE("in a terminal a key arms, another one stops, and q gives the terminal back") {
  const std::string url = ownLcmUrl();
  Robot robot(url);
  winsize size{40, 120, 0, 0};
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) {
    setenv("TERM", "xterm", 1);
    const std::string program = std::string(TREAD_BIN_DIR) + "/tread-top";
    execl(program.c_str(), "tread-top", "--lcm-url", url.c_str(), nullptr);
    _exit(127);
  }
  fcntl(terminal, F_SETFL, O_NONBLOCK);
  std::string seen;
  const auto look = [&](double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 10.0); ++i) {
      robot.run(0.1);
      char buffer[4096];
      for (ssize_t got = 0; (got = read(terminal, buffer, sizeof buffer)) > 0;)
        seen.append(buffer, static_cast<size_t>(got));
    }
  };
  const auto press = [&](char key) { REQUIRE(write(terminal, &key, 1) == 1); };
  for (int i = 0; i < 50 && seen.find("says the test") == std::string::npos; ++i) look(0.2);
  CHECK(seen.find("disarmed") != std::string::npos);
  press('a');
  for (int i = 0; i < 25 && !robot.armed; ++i) look(0.2);
  CHECK(robot.armed);
  press(' ');
  for (int i = 0; i < 25 && !robot.stopped; ++i) look(0.2);
  CHECK(robot.stopped);
  press('q');
  int status = -1;
  for (int i = 0; i < 50 && waitpid(child, &status, WNOHANG) != child; ++i) look(0.1);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  close(terminal);
}
