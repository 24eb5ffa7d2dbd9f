// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>

#include "common/bus/shell.hpp"
#include "common/link/make_link.hpp"
#include "modules/motor_bridge/motor_bridge_node.hpp"
#include "modules/motor_bridge/real_time.hpp"

int main(int argc, char** argv) {
  using namespace tread;
  using namespace tread::motor;
  const auto prepare = [](ConfigReader& reader) -> ShellBody {
    const MotorBridgeConfig config = readMotorBridgeConfig(reader);
    parseLinkAddress(config.address);  // throws if it is invalid
    return [config](BusAccess access, const std::atomic<bool>& stop) {
      LcmBus bus(std::move(access), TimeSource::kHost);
      const std::unique_ptr<Link> link = makeLink(config.address);
      requireFree(*link);
      MotorBridgeNode node(config, bus, *link);
      for (const std::string& line : {node.notice(), becomeRealTime()})
        if (!line.empty()) std::cerr << "tread-motor-bridge: " << line << std::endl;
      bus.run(node, stop);
    };
  };
  return runShell(argc, argv, "tread-motor-bridge",
                  "Plays PROGRAM on the motor controller, and stops the robot by itself on faults.",
                  prepare);
}
