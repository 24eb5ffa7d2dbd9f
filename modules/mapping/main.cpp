// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/shell.hpp"
#include "modules/mapping/mapping_node.hpp"

int main(int argc, char** argv) {
  using namespace tread;
  const auto prepare = [](ConfigReader& reader) -> ShellBody {
    const mapping::MappingConfig config = mapping::readMappingConfig(reader);
    return [config](BusAccess access, const std::atomic<bool>& stop) {
      LcmBus bus(std::move(access), TimeSource::kFollow);
      mapping::MappingNode node(config, bus);
      bus.run(node, stop);
    };
  };
  return runShell(argc, argv, "tread-mapping", "Makes MAP, the local grid, from SCAN and INS.",
                  prepare);
}
