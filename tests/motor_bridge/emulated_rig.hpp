// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <string>

#include "modules/motor_bridge/core/bridge.hpp"
#include "tests/motor_bridge/endless_planner.hpp"

namespace tread::motor {

/// Bridge, connection and emulated controller in steps of 10 ms; the line runs at 115200 baud.
template <class Connection, class Device>
struct EmulatedRig {
  Bridge bridge{BridgeConfig{}};
  Connection connection;
  Device device;
  EndlessPlanner planner;
  BridgeOutput out;
  int64_t now = 10'000'000;
  int64_t last_motion = 0;
  bool planner_alive = true;
  bool bridge_alive = true;
  bool plugged = true;
  double lost_bytes = 0.0;  ///< share, in both directions
  std::mt19937 random{1};

  template <class Config, class... Settings>
  explicit EmulatedRig(const Config& config, const Settings&... settings)
      : connection(config), device(settings...) {
    connection.open();
  }

  void step() {
    for (int i = 0; i < 10; ++i) {
      now += 1'000;
      if (turning()) last_motion = now;
    }
    if (!bridge_alive) return;
    if (now % 20'000 == 0) bridge.receive(InsNotice{now - 5'000, true}, now);
    if (planner_alive && now % 50'000 == 0) {
      const auto& log = bridge.executions().records();
      const auto last = log.empty() ? std::nullopt : std::optional(log.back());
      bridge.receive(planner.plan(now - 1'000, last), now);
    }
    if (now % 200'000 == 0) bridge.receive(OperatorNotice{1, "operator", true, now, 0, ""}, now);
    const std::string said = thinned(device.transmit(now));
    if (plugged) connection.receive(said, now);
    out = bridge.step(now, connection.report(now));
    connection.holdStop(out.hold_device_stop);
    if (out.release_device_stop) connection.releaseStop(now);
    if (out.send) connection.command(out.command, now);
    const std::string sent = thinned(connection.poll(now));
    if (plugged) device.receive(sent, now);
  }
  std::string thinned(std::string bytes) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    bytes.erase(std::remove_if(bytes.begin(), bytes.end(),
                               [&](char) { return share(random) < lost_bytes; }),
                bytes.end());
    return bytes;
  }
  void run(int64_t us) {
    for (const int64_t end = now + us; now < end;) step();
  }
  void unplug() {
    plugged = false;
    connection.close("unplugged");
  }
  void plugIn() {
    plugged = true;
    connection.open();
  }
  void drive() {
    run(1'600'000);
    bridge.receive(ArmRequest{now, true, "operator", "go"}, now);
    run(400'000);
  }
  bool turning() {
    const sim::MotorValues power = device.output(now);
    return power[0] != 0.0 || power[1] != 0.0;
  }
  int64_t lastMotionWithin(int64_t us) {
    const int64_t begin = now;
    run(us);
    return std::max<int64_t>(0, last_motion - begin);
  }
  int64_t count(const std::string& name) const {
    const auto counters = connection.counters();
    const auto found = counters.find(name);
    return found == counters.end() ? 0 : found->second;
  }
  BridgeState state() const { return out.failsafe.state; }
};

}  // namespace tread::motor
