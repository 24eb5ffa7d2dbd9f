// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <iostream>

#include "common/bus/shell.hpp"
#include "common/link/make_link.hpp"
#include "modules/lidar_driver/lidar_driver_node.hpp"

namespace {

using namespace tread;

std::unique_ptr<Link> lineAt(const std::string& address) {
  std::unique_ptr<Link> line = makeLink(address);
  requireFree(*line);
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  const auto prepare = [](ConfigReader& reader) -> ShellBody {
    const lidar::LidarDriverConfig config = lidar::readLidarDriverConfig(reader);
    lidar::checkDeviceAddress(config.device.name, config.address);
    if (config.ground_mounting)
      lidar::checkDeviceAddress(config.device.name, config.ground_address);
    const auto run = [config](BusAccess access, const std::atomic<bool>& stop) {
      LcmBus bus(std::move(access), TimeSource::kHost);
      const std::unique_ptr<Link> line = lineAt(config.address);
      const std::unique_ptr<Link> ground =
          config.ground_mounting ? lineAt(config.ground_address) : nullptr;
      lidar::LidarDriverNode node(config, bus, *line, ground.get(), [](const std::string& words) {
        std::cerr << "tread-lidar-driver: " << words << std::endl;
      });
      bus.run(node, stop);
    };
    return {run, [config] {
              requireListening(config.address);
              if (config.ground_mounting) requireListening(config.ground_address);
            }};
  };
  return runShell(argc, argv, "tread-lidar-driver", "Publishes SCAN from a range finder.", prepare);
}
