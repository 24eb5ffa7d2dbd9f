// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/simulator_node.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <tread/health_t.hpp>

#include "common/link/make_link.hpp"
#include "common/vehicle/model_file.hpp"

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

/// `holds_speeds`: the motor controller of the simulated robot controls speeds; otherwise power.
std::optional<ModelDocument> readModel(ConfigReader& reader, bool holds_speeds) {
  std::string path = "none";
  reader.text("model", path);
  if (path == "none") return std::nullopt;
  reader.path("model", path);
  if (reader.has("vehicle"))
    throw reader.error("vehicle",
                       "is of the dynamic vehicle, model: of the vehicle in its place; "
                       "give one of them");
  ModelDocument document = readTrackModelDocument(path);
  if (document.vehicle.kind == CommandKind::kTrackSpeed && !holds_speeds)
    throw reader.error("model", path +
                                    " takes track speeds, the simulated robot's controller gives "
                                    "power; give a model of kind power, or drive: kind: "
                                    "track_speed in robot.yaml");
  return document;
}

constexpr int64_t kHealthEvery = 1'000'000;  // [us]

/// Summary of a simulation for people, as YAML.
std::string describe(const SimulatedDevices& devices) {
  const WorldDescription& world = devices.robot().world().description();
  const std::string model = devices.robot().vehicle().name();
  return "world: \"" + world.name + "\"\n" + (model.empty() ? "" : "model: \"" + model + "\"\n") +
         "seed: " + std::to_string(devices.robot().settings().seed) +
         "\nobstacles: " + std::to_string(world.obstacles.size()) +
         "\nregions: " + std::to_string(world.regions.size()) + "\n";
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
  readSimulatedRobot(reader, robot);
  config.model = readModel(reader, robot.wiring.top_speed.has_value());
  readVehicle(reader.section("vehicle"), robot.vehicle);
  const EmulatedDevices known = emulatedDevices();
  reader.choice("controller", config.settings.controller, known.controllers);
  reader.choice("source", config.settings.source, known.sources);
  reader.choice("device", config.settings.device, known.devices);
  readAddress(reader, "ins", config.ins);
  readAddress(reader, "motor", config.motor);
  readAddress(reader, "laser", config.laser);
  readAddress(reader, "ground_laser", config.ground_laser);
  reader.text("record", config.record);
  reader.finish();
  return config;
}

SimulatorNode::SimulatorNode(SimulatedDevices& devices, Bus& bus, const DeviceLines& lines,
                             TruthRecord* record, Say say)
    : devices_(devices),
      lines_(lines),
      record_(record),
      say_(std::move(say)),
      health_(bus, "simulator", describe(devices)) {}

void SimulatorNode::step(int64_t utime) {
  advanceTo(utime);
  devices_.ins().receive(hear(lines_.ins, utime), utime);
  devices_.motor().receive(hear(lines_.motor, utime), utime);
  transmit(lines_.ins, devices_.ins().transmit(utime));
  transmit(lines_.motor, devices_.motor().transmit(utime));
  if (lines_.laser != nullptr) serve(devices_.laser(), *lines_.laser, laser_connected_, utime);
  if (lines_.ground_laser != nullptr && devices_.groundLaser() != nullptr)
    serve(*devices_.groundLaser(), *lines_.ground_laser, ground_laser_connected_, utime);
  tellHealth(utime);
}

void SimulatorNode::serve(LaserEmulator& laser, Link& line, bool& connected, int64_t utime) {
  const bool open = line.isOpen();
  if (open && !connected) laser.reconnect();
  connected = open;
  laser.receive(hear(line, utime), utime);
  transmit(line, laser.transmit(utime));
}

void SimulatorNode::tellHealth(int64_t utime) {
  const RobotTruth& truth = devices_.robot().truth();
  health_.setCounter("collisions", static_cast<int64_t>(truth.collisions.size()));
  if (utime >= next_health_) {
    next_health_ = utime + kHealthEvery;
    const std::string warning = devices_.robot().vehicle().warning();
    if (!warning.empty()) health_.setState(health_t::HEALTH_DEGRADED, warning);
    if (!warning.empty() && !warned_ && say_) say_(warning);
    warned_ = warned_ || !warning.empty();
  }
  health_.step(utime);
}

void SimulatorNode::advanceTo(int64_t utime) {
  if (record_ == nullptr) return devices_.advanceTo(utime);
  // In steps, so that the record keeps its resolution after a pause of the host.
  for (int64_t t = devices_.robot().truth().utime; t < utime;) {
    t = std::min(t + period(), utime);
    devices_.advanceTo(t);
    if (record_ != nullptr) note(t);
  }
}

void SimulatorNode::note(int64_t utime) {
  try {
    record_->note(devices_.robot().truth(), devices_.power(utime));
  } catch (const WriteError& error) {
    record_ = nullptr;
    if (say_) say_(std::string(error.what()) + "; the simulation continues without its record");
  }
}

std::string SimulatorNode::hear(Link& line, int64_t utime) {
  if (!line.isOpen() && !line.reopen(utime)) return {};
  std::string bytes;
  std::array<uint8_t, 512> buffer;
  while (const auto count = line.read(buffer.data(), buffer.size())) {
    if (*count == 0) break;
    bytes.append(reinterpret_cast<const char*>(buffer.data()), *count);
  }
  return bytes;
}

void SimulatorNode::transmit(Link& line, const std::string& bytes) {
  if (bytes.empty()) return;
  if (!line.write(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()))
    health_.addToCounter("bytes lost: line full or down", static_cast<int64_t>(bytes.size()));
}

}  // namespace tread::sim
