// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/simulator_config.hpp"

#include "common/link/address.hpp"

namespace tread::sim {
namespace {

constexpr double kFar = 10000.0;  // [m]

void readAddress(ConfigReader& reader, const std::string& key, std::string& address) {
  reader.text(key, address);
  try {
    parseLinkAddress(address);
  } catch (const std::invalid_argument& refusal) {
    throw reader.error(key, refusal.what());
  }
}

}  // namespace

SimulatorConfig readSimulatorConfig(ConfigReader& reader) {
  SimulatorConfig config;
  RobotSettings& robot = config.settings.robot;
  reader.path("world", config.world, true);
  std::vector<double> start{0.0, 0.0, 0.0};
  reader.numbers("start", start, 3, {-kFar, kFar}, "m m rad");
  robot.start = {start[0], start[1], start[2]};
  int64_t seed = 1;
  reader.integer("seed", seed, {0.0, 1e15}, "1");
  robot.seed = static_cast<uint64_t>(seed);
  reader.flag("motion_noise", robot.motion_noise);
  readAddress(reader, "ins", config.ins);
  readAddress(reader, "motor", config.motor);
  readAddress(reader, "laser", config.laser);
  reader.text("record", config.record);
  reader.finish();
  config.effective = reader.effective();
  return config;
}

}  // namespace tread::sim
