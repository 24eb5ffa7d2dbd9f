// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <optional>

#include "common/bus/shell.hpp"
#include "common/store/store.hpp"
#include "modules/planner/planner_node.hpp"

int main(int argc, char** argv) {
  using namespace tread;
  const auto prepare = [](ConfigReader& reader) -> ShellBody {
    const planner::PlannerConfig config = planner::readPlannerConfig(reader);
    return [config](BusAccess access, const std::atomic<bool>& stop) {
      LcmBus bus(std::move(access), TimeSource::kFollow);
      std::optional<FileStore> store;
      if (!config.store.empty()) store.emplace(config.store);
      planner::PlannerNode node(config, bus, store ? &*store : nullptr);
      bus.run(node, stop);
    };
  };
  return runShell(argc, argv, "tread-planner",
                  "Plans sequences of motion patterns to the goal, for the motor bridge.", prepare);
}
