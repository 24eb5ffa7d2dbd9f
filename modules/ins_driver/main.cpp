// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/shell.hpp"
#include "common/link/make_link.hpp"
#include "modules/ins_driver/ins_driver_node.hpp"

int main(int argc, char** argv) {
  using namespace tread;
  const auto prepare = [](ConfigReader& reader) -> ShellBody {
    const ins::InsDriverConfig config = ins::readInsDriverConfig(reader);
    parseLinkAddress(config.address);  // throws if it is invalid
    return [config](BusAccess access, const std::atomic<bool>& stop) {
      LcmBus bus(std::move(access), TimeSource::kHost);
      const std::unique_ptr<Link> link = makeLink(config.address);
      requireFree(*link);
      FileStore store(config.store);
      ins::InsDriverNode node(config, bus, *link, store);
      bus.run(node, stop);
    };
  };
  return runShell(argc, argv, "tread-ins-driver", "Publishes INS from the INS on its line.",
                  prepare);
}
