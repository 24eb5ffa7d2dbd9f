// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The real process with the emulated range finder on a real socket.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>

#include "common/bus/lcm_bus.hpp"
#include "tests/lidar_driver/scip_server.hpp"
#include "tests/system/process.hpp"

using namespace tread;
using namespace tread::testing;

namespace {

const std::string kRobot = "robot: " TREAD_SOURCE_DIR "/config/robots/teodor/robot.yaml\n";

/// The process, a bus that receives its messages, and its configuration file.
class Driven {
 public:
  explicit Driven(const std::string& address) {
    const std::string url = ownLcmUrl();
    bus_ = std::make_unique<LcmBus>(url, TimeSource::kHost);
    bus_->subscribe<scan_t>(kScan, [this](const scan_t& scan) {
      last = scan;
      ++scans;
    });
    bus_->subscribe<health_t>(kHealth, [this](const health_t& message) { health = message; });
    file_ = "lidar_" + std::to_string(getpid()) + ".yaml";
    std::ofstream(file_) << "address: " << address << "\nrange_max: 12\n" << kRobot;
    arguments_ = {"--config", file_, "--lcm-url", url};
    start();
  }
  ~Driven() { std::remove(file_.c_str()); }

  void start() { process = std::make_unique<Process>("tread-lidar-driver", arguments_); }

  /// Listens until the condition holds, or a timeout.
  template <class Condition>
  bool until(Condition condition, double seconds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      bus_->handle(20);
    }
    return true;
  }

  int scans = 0;
  scan_t last{};
  health_t health{};
  std::unique_ptr<Process> process;

 private:
  std::unique_ptr<LcmBus> bus_;
  std::string file_;
  std::vector<std::string> arguments_;
};

bool haveMulticast() {
  try {
    const LcmBus bus(ownLcmUrl(), TimeSource::kHost);
    return true;
  } catch (const std::runtime_error& error) {
    WARN("skipped: " << error.what());
    return false;
  }
}

bool says(const health_t& health, const std::string& words) {
  return health.health_state == health_t::HEALTH_FAILED &&
         health.health_reason.find(words) != std::string::npos;
}

}  // namespace

TEST_CASE(
    "scans of a SCIP device come out with the device's own geometry, and SIGTERM ends the "
    "process") {
  if (!haveMulticast()) return;
  ScipServer server(ScipServer::Manner::kGood);
  Driven driven(server.address());
  REQUIRE(driven.until([&] { return driven.scans >= 8; }, 20));
  REQUIRE(driven.last.num_beams == 541);
  REQUIRE(driven.last.angle_first == Approx(-0.75 * M_PI));
  REQUIRE(driven.last.angle_step == Approx(M_PI / 360));
  REQUIRE(driven.last.ranges[0] == Approx(3.0));
  REQUIRE(std::isinf(driven.last.ranges[270]));
  REQUIRE(driven.last.ranges[540] == Approx(5.0));
  REQUIRE(driven.last.range_max == 12.0);
  REQUIRE(driven.last.duration > 0);
  driven.process->signal(SIGTERM);
  REQUIRE(driven.process->waitFor(5));
  REQUIRE(driven.process->exitCode() == 0);
}

TEST_CASE("a range finder that goes away and comes back is connected again") {
  if (!haveMulticast()) return;
  auto server = std::make_unique<ScipServer>(ScipServer::Manner::kGood);
  const int port = server->port();
  Driven driven(server->address());
  REQUIRE(driven.until([&] { return driven.scans >= 3; }, 20));
  server.reset();
  REQUIRE(driven.until([&] { return says(driven.health, "no scan for"); }, 20));
  const int before = driven.scans;
  ScipServer again(ScipServer::Manner::kGood, port);
  REQUIRE(again.port() == port);
  const bool connected = driven.until([&] { return driven.scans >= before + 3; }, 20);
  INFO(driven.health.health_reason);
  REQUIRE(connected);
  REQUIRE(driven.process->running());
}

TEST_CASE("a range finder that starts up and never scans is connected again") {
  if (!haveMulticast()) return;
  ScipServer server(ScipServer::Manner::kLazy);
  Driven driven(server.address());
  REQUIRE(driven.until([&] { return driven.scans >= 3; }, 20));
  REQUIRE(server.connections() > 2);
}

TEST_CASE("a peer that accepts and closes at once does not catch the process") {
  if (!haveMulticast()) return;
  for (const int signal : {SIGINT, SIGTERM}) {
    ScipServer server(ScipServer::Manner::kCloses);
    Driven driven(server.address());
    const auto told_so = [&] {
      return says(driven.health, "hung up") || says(driven.health, "reset by peer");
    };
    const bool told = driven.until(told_so, 20);
    INFO(driven.health.health_reason);
    REQUIRE(told);
    REQUIRE(driven.process->running());
    REQUIRE(server.connections() < 60);
    driven.process->signal(signal);
    REQUIRE(driven.process->waitFor(2));
    REQUIRE(driven.process->exitCode() == 0);
  }
}

TEST_CASE("a silent device, a deaf port and a mistyped key are each one clear line") {
  if (!haveMulticast()) return;
  SECTION("silent") {
    ScipServer server(ScipServer::Manner::kSilent);
    Driven driven(server.address());
    REQUIRE(
        driven.until([&] { return says(driven.health, "connected, but no answer to QT"); }, 20));
  }
  SECTION("refuses SCIP 2.0") {
    ScipServer server(ScipServer::Manner::kRefuses);
    Driven driven(server.address());
    REQUIRE(driven.until(
        [&] { return says(driven.health, "refused by the device: PP, status '0E'"); }, 20));
    REQUIRE_FALSE(says(driven.health, "ARES"));
  }
  SECTION("nobody listens") {
    int port = 0;
    { port = ScipServer(ScipServer::Manner::kGood).port(); }
    Driven driven("tcp:127.0.0.1:" + std::to_string(port));
    REQUIRE(driven.until([&] { return says(driven.health, "Connection refused"); }, 20));
  }
  SECTION("mistyped key") {
    const std::string file = "lidar_typo_" + std::to_string(getpid());
    std::ofstream(file + ".yaml") << "adress: tcp:127.0.0.1:1\n" << kRobot;
    Process process("tread-lidar-driver", {"--config", file + ".yaml"}, file + ".txt");
    REQUIRE(process.waitFor(10));
    REQUIRE(process.exitCode() == 1);
    std::ifstream output(file + ".txt");
    std::string line;
    std::getline(output, line);
    REQUIRE(line.find(file + ".yaml:1") != std::string::npos);
    REQUIRE(line.find("adress") != std::string::npos);
    std::remove((file + ".yaml").c_str());
    std::remove((file + ".txt").c_str());
  }
  SECTION("not an address of a range finder, told by --check already") {
    for (const char* address : {"udp:2368", "tcp:host", "tcp:host:99999"}) {
      Process process(
          "tread-lidar-driver",
          {"--check", "--config", TREAD_SOURCE_DIR "/config/robots/teodor/lidar_driver.yaml",
           "--set", std::string("address=") + address});
      REQUIRE(process.waitFor(10));
      REQUIRE(process.exitCode() == 1);
    }
  }
}

TEST_CASE("random bytes between scans cost some scans and nothing else") {
  if (!haveMulticast()) return;
  ScipServer server(ScipServer::Manner::kGarbage);
  Driven driven(server.address());
  driven.until([&] { return driven.scans >= 3; }, 10);
  REQUIRE(driven.process->running());
  driven.process->signal(SIGTERM);
  REQUIRE(driven.process->waitFor(10));
}
