// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/robot_system.hpp"

#include <tuple>
#include <utility>

#include "modules/ins_driver/ins_driver_node.hpp"
#include "modules/learner/learner_node.hpp"
#include "modules/motor_bridge/motor_bridge_node.hpp"
#include "modules/simulator/simulator_node.hpp"

namespace tread::missions {
namespace {

/// How long each node takes on the robot's two cores [us], as delays in virtual time. Rounded up
/// from what benchmarks and HEALTH show on a machine of that class.
std::map<std::string, NodeTiming> usualTiming() {
  return {{"ins_driver", {100, 0}},     {"lidar_driver", {200, 300}}, {"mapping", {8'000, 1'700}},
          {"planner", {15'000, 3'100}}, {"learner", {1'000, 5'300}},  {"motor_bridge", {100, 700}}};
}

/// The faults with "every receiver" spelled out.
FaultPlan onTheRobot(const FaultPlan& faults) {
  FaultPlan spelled;
  spelled.nodes = faults.nodes;
  for (MessageFault fault : faults.messages) {
    const bool all = fault.receiver == "*";
    if (!all) spelled.messages.push_back(fault);
    for (const std::string& node : all ? robotNodes() : std::vector<std::string>{}) {
      fault.receiver = node;
      spelled.messages.push_back(fault);
    }
  }
  return spelled;
}

template <class Config, class Read>
Config readFile(const std::string& path, Read read) {
  ConfigReader reader = ConfigReader::fromFile(path);
  return read(reader);
}

}  // namespace

/// What stands behind the range finder's library in virtual time.
class RobotSystem::SimulatedScans : public lidar::ScanSource {
 public:
  explicit SimulatedScans(sim::SimulatedDevices& devices) : devices_(devices) {}

  std::vector<lidar::RangeScan> take(int64_t /*utime*/) override {
    std::vector<lidar::RangeScan> scans;
    const sim::LaserParameters& laser = devices_.robot().settings().laser;
    for (sim::LaserScan& measured : devices_.takeScans()) {
      lidar::RangeScan scan;
      scan.utime = measured.utime;
      scan.duration_us = measured.sweep_us;
      scan.angle_first = measured.angle_min;
      scan.angle_step = measured.angle_step;
      scan.range_min = laser.range_min;
      scan.range_max = laser.range_max;
      scan.ranges = std::move(measured.ranges);
      scans.push_back(std::move(scan));
    }
    return scans;
  }
  std::string problem() const override { return {}; }

 private:
  sim::SimulatedDevices& devices_;
};

const std::vector<std::string>& robotNodes() {
  static const std::vector<std::string> kNames{"ins_driver", "lidar_driver", "mapping",
                                               "planner",    "learner",      "motor_bridge"};
  return kNames;
}

RobotConfig readRobot(const std::string& folder) {
  RobotConfig config(
      readFile<learner::LearnerNodeConfig>(folder + "/learner.yaml", learner::readLearnerConfig));
  config.ins_driver =
      readFile<ins::InsDriverConfig>(folder + "/ins_driver.yaml", ins::readInsDriverConfig);
  config.lidar_driver = readFile<lidar::LidarDriverConfig>(folder + "/lidar_driver.yaml",
                                                           lidar::readLidarDriverConfig);
  config.mapping =
      readFile<mapping::MappingConfig>(folder + "/mapping.yaml", mapping::readMappingConfig);
  config.planner =
      readFile<planner::PlannerConfig>(folder + "/planner.yaml", planner::readPlannerConfig);
  config.motor_bridge = readFile<motor::MotorBridgeConfig>(folder + "/motor_bridge.yaml",
                                                           motor::readMotorBridgeConfig);
  config.timing = usualTiming();
  return config;
}

RobotSystem::RobotSystem(const RobotConfig& config, const sim::WorldDescription& world,
                         const Pose2& T_map_start, uint64_t seed, const std::string& rule,
                         const FaultPlan& faults)
    : config_(config), bus_(std::make_unique<VirtualBus>(seed, onTheRobot(faults))) {
  if (!rule.empty()) config_.learner.rule.rule = *learner::ruleNamed(rule);
  std::tie(ins_line_, ins_device_) = makePipe();
  std::tie(motor_line_, motor_device_) = makePipe();
  sim::SimulatorSettings settings;
  settings.robot.start = T_map_start;
  settings.robot.start_utime = bus_->now();
  settings.robot.seed = seed;
  devices_ =
      std::make_unique<sim::SimulatedDevices>(std::make_shared<const sim::World>(world), settings);
  scans_ = std::make_unique<SimulatedScans>(*devices_);
  bus_->addNode("simulator", [this](Bus& bus) {
    return std::make_unique<sim::SimulatorNode>(*devices_, bus,
                                                sim::DeviceLines{*ins_device_, *motor_device_});
  });
  addRobotNodes();
}

RobotSystem::~RobotSystem() = default;

void RobotSystem::connect(const std::string& device, bool connected) {
  setPipeConnected(device == "ins" ? *ins_device_ : *motor_device_, connected);
}

void RobotSystem::addRobotNodes() {
  add("ins_driver", [this](Bus& bus) {
    return std::make_unique<ins::InsDriverNode>(config_.ins_driver, bus, *ins_line_, ins_store_);
  });
  add("lidar_driver", [this](Bus& bus) {
    return std::make_unique<lidar::LidarDriverNode>(config_.lidar_driver, bus, *scans_);
  });
  add("mapping",
      [this](Bus& bus) { return std::make_unique<mapping::MappingNode>(config_.mapping, bus); });
  add("planner",
      [this](Bus& bus) { return std::make_unique<planner::PlannerNode>(config_.planner, bus); });
  add("learner", [this](Bus& bus) {
    return std::make_unique<learner::LearnerNode>(config_.learner, bus, learner_store_);
  });
  add("motor_bridge", [this](Bus& bus) {
    return std::make_unique<motor::MotorBridgeNode>(config_.motor_bridge, bus, *motor_line_);
  });
}

void RobotSystem::add(const std::string& name, VirtualBus::Factory factory) {
  bus_->addNode(name, std::move(factory), config_.timing[name]);
}

}  // namespace tread::missions
