// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/lcm_bus.hpp"
#include "common/bus/shell.hpp"
#include "modules/learner/learner_node.hpp"

namespace {

using namespace tread;

void run(const ShellArguments& arguments, const std::atomic<bool>& stop) {
  // Nothing can be learned without shipped patterns, so there is no default configuration.
  if (arguments.config_path.empty())
    throw ConfigError("--config is needed: a file with at least 'patterns: FILE'");
  ConfigReader reader = ConfigReader::fromFile(arguments.config_path);
  const learner::LearnerNodeConfig config = learner::readLearnerConfig(reader);
  LcmBus bus(arguments.lcm_url, TimeSource::kFollow);
  FileStore store(config.store);
  learner::LearnerNode node(config, bus, store);
  bus.run(node, stop);
}

}  // namespace

int main(int argc, char** argv) {
  return runShell(argc, argv, "tread-learner",
                  "Learns what the ground makes of the motion patterns, and publishes them.", run);
}
