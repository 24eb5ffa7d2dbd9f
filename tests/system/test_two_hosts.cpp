// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The operator on another host, and what a third host can do to the robot.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include <catch2/catch.hpp>
#include <lcm/lcm-cpp.hpp>

#include "common/messages/blank.hpp"
#include "common/seal/key_file.hpp"
#include "tests/system/robot_run.hpp"
#include "tests/system/two_hosts.hpp"
#include "tests/system/worlds.hpp"
#include "tools/robot/launch/stall_watch.hpp"

namespace tread::testing {
namespace {

std::unique_ptr<TwoHosts> hostsOrSkip() {
  try {
    return std::make_unique<TwoHosts>();
  } catch (const std::runtime_error& error) {
    WARN("skipped: " << error.what());
    return nullptr;
  }
}

uint16_t portOf(const std::string& url) {
  const size_t at = url.rfind(':') + 1;
  return static_cast<uint16_t>(std::stoi(url.substr(at, url.find('?') - at)));
}

/// Drives at speed with tread-goal at the station as operator. False on timeout.
bool driveByStation(RobotRun& run, const TwoHosts& hosts) {
  for (int i = 0; i < 5; ++i) {
    run.setGoal(30.0, 0.0);
    run.untilDriving(20.0, [&] { return run.driving() && run.motor().message().command[0] > 0.3; });
    run.leaveTo(30.0, 1.0, hosts.atStation());
    run.wait(1.5);
    if (run.driving()) return true;
    run.takeBack();
    run.arm(10.0);
  }
  return false;
}

/// LCM's short message of a type's bytes.
template <class Message>
std::vector<uint8_t> datagramOf(const std::string& channel, const Message& message, uint32_t seq) {
  std::vector<uint8_t> bytes{0x4c, 0x43, 0x30, 0x32};
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<uint8_t>(seq >> shift));
  bytes.insert(bytes.end(), channel.begin(), channel.end());
  bytes.push_back(0);
  const size_t head = bytes.size();
  bytes.resize(head + static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), static_cast<int>(head), message.getEncodedSize());
  return bytes;
}

}  // namespace

TEST_CASE(
    "the cable to the operator's host is pulled: zero in time, and nothing goes on by itself") {
  const auto hosts = hostsOrSkip();
  if (!hosts) return;
  const std::filesystem::path key =
      std::filesystem::temp_directory_path() / ("tread_two_hosts_" + std::to_string(getpid()));
  writeNewKey(key.string());
  for (int trial = 1; trial <= 4; ++trial) {
    RobotRun run(kField, "[-20, 0, 0]", key.string(), hosts->url());
    run.startAll();
    REQUIRE(run.arm(20.0));
    REQUIRE(driveByStation(run, *hosts));
    std::optional<int64_t> zero;
    double stall = 0.0;
    int64_t pulling = 0;
    int64_t pulled = 0;
    {
      const launch::StallWatch watch;
      pulling = run.now();
      hosts->plug(false);  // by a program that has to be started: at some time between the two
      pulled = run.now();
      run.until(5.0, [&] {
        run.wait(0.2);
        zero = zeroAfter(run.truth(), pulling, 1'000'000);
        return zero.has_value();
      });
      stall = watch.longest();
    }
    hosts->plug(true);
    const double took = static_cast<double>(pulled - pulling) * 1e-6;
    if (std::max(stall, took) > 0.05 && trial < 4) continue;
    REQUIRE(zero);
    const double stands = static_cast<double>(*zero - pulled) * 1e-6;
    INFO(stands << " s, machine's stall " << stall << " s, the cable's program took " << took);
    CHECK(static_cast<double>(*zero - pulling) * 1e-6 > 0.5);
    CHECK(stands <= 1.25);
    CHECK_THAT(run.motor().message().state_reason, Catch::Contains("the operator is lost: test"));
    // The cable is back, and the station's program still runs.
    const int64_t from = run.now();
    run.wait(3.0);
    for (const sim::TruthRow& row : run.truth())
      if (row.utime > from) REQUIRE(row.motorsAtZero());
    break;
  }
  std::filesystem::remove(key);
}

TEST_CASE(
    "unicast from another host reaches no process, and without the key its multicast moves "
    "nothing") {
  const auto hosts = hostsOrSkip();
  if (!hosts) return;
  const int station = hosts->stationSocket();
  const uint16_t port = portOf(hosts->url());
  const auto send = [&](const char* address, const std::vector<uint8_t>& bytes) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    REQUIRE(inet_pton(AF_INET, address, &to.sin_addr) == 1);
    REQUIRE(sendto(station, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                   sizeof to) == static_cast<ssize_t>(bytes.size()));
  };
  auto stop = blank<estop_t>();
  stop.engaged = true;
  stop.estop_by = "another host";
  {
    // LCM alone accepts it, so the test is meaningful.
    lcm::LCM bare(hosts->url());
    int heard = 0;
    bare.subscribeFunction(
        "ESTOP", +[](const lcm::ReceiveBuffer*, const std::string&, int* count) { ++*count; },
        &heard);
    send(TwoHosts::kRobot, datagramOf("ESTOP", stop, 1));
    for (int i = 0; i < 100 && heard == 0; ++i) bare.handleTimeout(20);
    REQUIRE(heard == 1);
  }
  RobotRun run(kField, "[-20, 0, 0]", "", hosts->url());
  run.startAll();
  REQUIRE(run.arm(20.0));
  // Even a stop by unicast is not received; by the group it is.
  for (uint32_t i = 0; i < 50; ++i) {
    stop.utime = run.now();
    send(TwoHosts::kRobot, datagramOf("ESTOP", stop, 2 + i));
    run.wait(0.02);
  }
  CHECK(run.motor().message().bridge_state == motor_t::STATE_ARMED);
  send("239.255.76.67", datagramOf("ESTOP", stop, 100));
  CHECK(run.until(2.0, [&] { return run.motor().message().bridge_state == motor_t::STATE_ESTOP; }));
  close(station);
}

}  // namespace tread::testing
