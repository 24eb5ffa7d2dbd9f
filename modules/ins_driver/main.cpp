// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/lcm_bus.hpp"
#include "common/bus/shell.hpp"
#include "modules/ins_driver/ins_driver_node.hpp"

namespace {

using namespace tread;

void run(const ShellArguments& arguments, const std::atomic<bool>& stop) {
  ConfigReader reader = arguments.config_path.empty()
                            ? ConfigReader::fromText("{}", "defaults")
                            : ConfigReader::fromFile(arguments.config_path);
  const ins::InsDriverConfig config = ins::readInsDriverConfig(reader);
  LcmBus bus(arguments.lcm_url, TimeSource::kHost);
  const std::unique_ptr<Link> link = makeLink(config.address);
  FileStore store(config.store);
  ins::InsDriverNode node(config, bus, *link, store);
  bus.run(node, stop);
}

}  // namespace

int main(int argc, char** argv) {
  return runShell(argc, argv, "tread-ins-driver",
                  "Publishes INS from a device that speaks NMEA 0183.", run);
}
