// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/simulator_config.hpp"

#include "common/link/address.hpp"
#include "common/vehicle/model_file.hpp"
#include "modules/simulator/vehicle_config.hpp"

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

/// The motor controller of the simulated robot takes power and nothing else.
std::optional<ModelDocument> readModel(ConfigReader& reader) {
  std::string path = "none";
  reader.text("model", path);
  if (path == "none") return std::nullopt;
  reader.path("model", path);
  if (reader.has("vehicle"))
    throw reader.error("vehicle",
                       "is of the dynamic vehicle, model: of the vehicle in its place; "
                       "give one of them");
  ModelDocument document = readModelDocument(path);
  if (document.vehicle.kind != CommandKind::kPower)
    throw reader.error("model", path +
                                    " takes track speeds, the simulated robot's motor line "
                                    "only power; give a model of kind power");
  return document;
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
  config.model = readModel(reader);
  readSimulatedRobot(reader, robot);
  readVehicle(reader.section("vehicle"), robot.vehicle);
  const EmulatedDevices known = emulatedDevices();
  reader.choice("controller", config.settings.controller, known.controllers);
  reader.choice("source", config.settings.source, known.sources);
  reader.choice("device", config.settings.device, known.devices);
  readAddress(reader, "ins", config.ins);
  readAddress(reader, "motor", config.motor);
  readAddress(reader, "laser", config.laser);
  reader.text("record", config.record);
  reader.finish();
  return config;
}

}  // namespace tread::sim
