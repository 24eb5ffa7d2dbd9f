// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/shell.hpp"
#include "modules/learner/learner_node.hpp"

int main(int argc, char** argv) {
  using namespace tread;
  const auto prepare = [](ConfigReader& reader) -> ShellBody {
    learner::LearnerNodeConfig config = learner::readLearnerConfig(reader);
    // A little more than the period of HEALTH.
    config.listen_us = 1'200'000;
    ShellBody body = [config](BusAccess access, const std::atomic<bool>& stop) {
      LcmBus bus(std::move(access), TimeSource::kFollow);
      FileStore store(config.store);
      learner::LearnerNode node(config, bus, store);
      bus.run(node, stop);
    };
    body.warnings = config.warnings;
    return body;
  };
  return runShell(argc, argv, "tread-learner",
                  "Learns the motion patterns as executed on the ground, and publishes them.",
                  prepare);
}
