// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/lcm_bus.hpp"
#include "common/bus/shell.hpp"
#include "modules/mapping/mapping_node.hpp"

namespace {

using namespace tread;

void run(const ShellArguments& arguments, const std::atomic<bool>& stop) {
  ConfigReader reader = arguments.config_path.empty()
                            ? ConfigReader::fromText("{}", "defaults")
                            : ConfigReader::fromFile(arguments.config_path);
  const mapping::MappingConfig config = mapping::readMappingConfig(reader);
  LcmBus bus(arguments.lcm_url, TimeSource::kFollow);
  mapping::MappingNode node(config, bus);
  bus.run(node, stop);
}

}  // namespace

int main(int argc, char** argv) {
  return runShell(argc, argv, "tread-mapping", "Makes MAP, the local grid, from SCAN and INS.",
                  run);
}
