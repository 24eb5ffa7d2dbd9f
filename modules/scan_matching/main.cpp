// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/shell.hpp"
#include "modules/scan_matching/scan_matching_node.hpp"

int main(int argc, char** argv) {
  using namespace tread;
  const auto prepare = [](ConfigReader& reader) -> ShellBody {
    const auto config = scan_matching::readScanMatchingConfig(reader);
    return [config](BusAccess access, const std::atomic<bool>& stop) {
      LcmBus bus(std::move(access), TimeSource::kFollow);
      scan_matching::ScanMatchingNode node(config, bus);
      bus.run(node, stop);
    };
  };
  return runShell(argc, argv, "tread-scan-matching",
                  "Makes INS from SCAN alone, for robots without an INS.", prepare);
}
