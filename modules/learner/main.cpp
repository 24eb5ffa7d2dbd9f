// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/lcm_bus.hpp"
#include "common/bus/shell.hpp"
#include "modules/learner/learner_node.hpp"

namespace {

using namespace tread;

ShellBody prepare(ConfigReader& reader) {
  const learner::LearnerNodeConfig config = learner::readLearnerConfig(reader);
  return [config](const std::string& lcm_url, const std::atomic<bool>& stop) {
    LcmBus bus(lcm_url, TimeSource::kFollow);
    FileStore store(config.store);
    learner::LearnerNode node(config, bus, store);
    bus.run(node, stop);
  };
}

}  // namespace

int main(int argc, char** argv) {
  return runShell(argc, argv, "tread-learner",
                  "Learns what the ground makes of the motion patterns, and publishes them.",
                  prepare);
}
