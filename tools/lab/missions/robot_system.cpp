// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/missions/robot_system.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>
#include <utility>

#include "common/bus/channels.hpp"
#include "common/config/config_reader.hpp"
#include "common/config/scalars.hpp"
#include "common/geometry/microseconds.hpp"
#include "common/link/make_link.hpp"
#include "common/messages/blank.hpp"
#include "common/messages/pattern_messages.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "modules/simulator/simulator_node.hpp"

namespace tread::missions {
namespace {

/// Computing time of each node on the robot's two cores [us], as a delay in virtual time. Rounded
/// up from benchmarks and HEALTH on a machine of that class.
std::map<std::string, NodeTiming> usualTiming() {
  return {{"ins_driver", {100, 0}},    {"scan_matching", {2'000, 0}}, {"lidar_driver", {200, 300}},
          {"mapping", {8'000, 1'700}}, {"planner", {15'000, 3'100}},  {"learner", {1'000, 5'300}},
          {"motor_bridge", {100, 700}}};
}

/// Nodes of every robot and optional ones.
std::vector<std::string> possibleNodes() {
  std::vector<std::string> names = robotNodes();
  names.push_back("scan_matching");
  return names;
}

/// The faults with "every receiver" expanded.
FaultPlan onTheRobot(const FaultPlan& faults) {
  FaultPlan spelled;
  spelled.nodes = faults.nodes;
  for (MessageFault fault : faults.messages) {
    const bool all = fault.receiver == "*";
    if (!all) spelled.messages.push_back(fault);
    for (const std::string& node : all ? possibleNodes() : std::vector<std::string>{}) {
      fault.receiver = node;
      spelled.messages.push_back(fault);
    }
  }
  return spelled;
}

/// The files of a robot's folder with overridden keys.
class RobotFiles {
 public:
  RobotFiles(std::string folder, const std::vector<std::string>& overrides)
      : folder_(std::move(folder)) {
    for (const std::string& words : overrides) {
      const size_t dot = words.find('.');
      const std::string process = words.substr(0, dot);
      const std::vector<std::string> nodes = possibleNodes();
      if (dot == std::string::npos || std::find(nodes.begin(), nodes.end(), process) == nodes.end())
        throw ConfigError("--set " + words + ": write PROCESS.KEY=VALUE, PROCESS one of " +
                          joinWords(nodes));
      overrides_[process].push_back(words.substr(dot + 1));
    }
  }

  template <class Read>
  auto read(const std::string& process, Read take) {
    ConfigReader reader =
        ConfigReader::fromFile(folder_ + "/" + process + ".yaml", overrides_[process]);
    return take(reader);
  }

 private:
  std::string folder_;
  std::map<std::string, std::vector<std::string>> overrides_;
};

constexpr Range kShare{0.0, 1.0};
constexpr Range kTime{0.0, 1e6};

MessageFault readMessageFault(ConfigReader& reader) {
  MessageFault fault;
  double reorder_s = 0.1, delay_s = 0.0, from_s = 0.0, until_s = 1e6;
  std::vector<std::string> channels{"*"};
  for (const ChannelSpec& channel : kChannels) channels.push_back(channel.name);
  reader.choice("channel", fault.channel, channels);
  std::vector<std::string> receivers = possibleNodes();
  receivers.push_back("*");
  reader.choice("receiver", fault.receiver, receivers);
  reader.number("drop", fault.drop, kShare, "1");
  reader.number("duplicate", fault.duplicate, kShare, "1");
  reader.number("corrupt", fault.corrupt, kShare, "1");
  reader.number("reorder", fault.reorder, kShare, "1");
  reader.number("reorder_s", reorder_s, {0.0, 10.0}, "s");
  reader.number("delay_s", delay_s, {0.0, 10.0}, "s");
  reader.number("from_s", from_s, kTime, "s");
  reader.number("until_s", until_s, kTime, "s");
  fault.reorder_us = toMicroseconds(reorder_s);
  fault.delay_us = toMicroseconds(delay_s);
  fault.from = toMicroseconds(from_s);
  fault.until = toMicroseconds(until_s);
  return fault;
}

NodeFault readNodeFault(ConfigReader& reader) {
  NodeFault fault;
  double kill_at_s = 0.0, restart_after_s = -1.0;
  reader.choice("node", fault.node, robotNodes(), true);
  reader.number("kill_at_s", kill_at_s, kTime, "s", true);
  reader.number("restart_after_s", restart_after_s, {-1.0, 1e6}, "s, negative = never");
  fault.kill_at = toMicroseconds(kill_at_s);
  fault.restart_after = restart_after_s < 0.0 ? -1 : toMicroseconds(restart_after_s);
  return fault;
}

void requireEmulated(const std::string& device, const std::string& folder) {
  const std::vector<std::string> known = sim::emulatedDevices().devices;
  if (std::find(known.begin(), known.end(), device) != known.end()) return;
  std::string names;
  for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
  throw ConfigError(folder + "/lidar_driver.yaml: no range finder '" + device +
                    "' can be simulated; give one of " + names);
}

}  // namespace

/// The driver's session; scans are altered on their way to the bus.
class RobotSystem::DisturbedDevice : public lidar::ScanDevice {
 public:
  DisturbedDevice(std::unique_ptr<lidar::ScanDevice> device,
                  const std::function<void(lidar::RangeScan&)>& disturb)
      : device_(std::move(device)), disturb_(disturb) {}

  void open(int64_t now) override { device_->open(now); }
  void close() override { device_->close(); }
  void receive(std::string_view bytes, int64_t now) override { device_->receive(bytes, now); }
  std::string poll(int64_t now) override { return device_->poll(now); }
  std::vector<lidar::RangeScan> take(int64_t now) override {
    std::vector<lidar::RangeScan> scans = device_->take(now);
    if (disturb_)
      for (lidar::RangeScan& scan : scans) disturb_(scan);
    return scans;
  }
  bool lost() const override { return device_->lost(); }
  bool hungry() const override { return device_->hungry(); }
  std::string shortcomings() const override { return device_->shortcomings(); }

 private:
  std::unique_ptr<lidar::ScanDevice> device_;
  const std::function<void(lidar::RangeScan&)>& disturb_;
};

const std::vector<std::string>& robotNodes() {
  static const std::vector<std::string> kNames{"ins_driver", "lidar_driver", "mapping",
                                               "planner",    "learner",      "motor_bridge"};
  return kNames;
}

RobotConfig readRobot(const std::string& folder, const std::vector<std::string>& overrides) {
  RobotFiles files(folder, overrides);
  RobotConfig config(files.read("learner", learner::readLearnerConfig));
  if (std::filesystem::exists(folder + "/scan_matching.yaml"))
    config.scan_matching = files.read("scan_matching", scan_matching::readScanMatchingConfig);
  if (config.hasIns()) config.ins_driver = files.read("ins_driver", ins::readInsDriverConfig);
  config.lidar_driver = files.read("lidar_driver", lidar::readLidarDriverConfig);
  config.mapping = files.read("mapping", mapping::readMappingConfig);
  config.planner = files.read("planner", planner::readPlannerConfig);
  config.motor_bridge = files.read("motor_bridge", motor::readMotorBridgeConfig);
  config.simulated = sim::readSimulatedRobot(folder);
  const CommandChannels& given = config.learner.shipped.content().channels;
  const CommandChannels& taken = config.motor_bridge.bridge.gate.slot.channels;
  if (kindsOf(given) != kindsOf(taken))
    throw ConfigError(folder + "/learner.yaml: its patterns command " + describe(given) +
                      ", the robot takes " + describe(taken) + "; give a set of the same vehicle");
  requireEmulated(config.lidar_driver.device.name, folder);
  config.timing = usualTiming();
  return config;
}

void enterWorld(RobotConfig& robot, const std::string& kind) {
  robot.world = readWorldKind(kind, robot.simulated.vehicle);
  if (robot.world.shipped) robot.learner.shipped = *robot.world.shipped;
  if (robot.world.vehicle && !robot.world.changesOnTheWay())
    robot.simulated.vehicle = *robot.world.vehicle;
}

RobotSystem::RobotSystem(const RobotConfig& config, const sim::WorldDescription& world,
                         const Pose2& T_map_start, uint64_t seed, const std::string& rule,
                         const FaultPlan& faults, const Knowledge& known, sim::RobotParts parts)
    : config_(config), known_(known), bus_(std::make_unique<VirtualBus>(seed, onTheRobot(faults))) {
  if (!rule.empty()) config_.learner.rule.rule = rule;
  std::tie(ins_line_, ins_device_) = makePipe();
  std::tie(motor_line_, motor_device_) = makePipe();
  std::tie(laser_line_, laser_device_) = makePipe();
  std::tie(ground_line_, ground_device_) = makePipe();
  sim::SimulatorSettings settings;
  settings.robot = config.simulated;
  settings.source = config.ins_driver.source;
  settings.controller = config.motor_bridge.controller;
  settings.device = config.lidar_driver.device.name;
  settings.robot.start = T_map_start;
  settings.robot.start_utime = bus_->now();
  settings.robot.seed = seed;
  // Without an INS the map begins at the given start pose, and goals are in the map.
  if (config_.scan_matching && !config_.hasIns())
    config_.scan_matching->matcher.start = T_map_start;
  devices_ = std::make_unique<sim::SimulatedDevices>(std::make_shared<const sim::World>(world),
                                                     settings, std::move(parts));
  config_.lidar_driver.device.make = [this, make = config.lidar_driver.device.make] {
    return std::make_unique<DisturbedDevice>(make(), disturb_scan_);
  };
  bus_->addNode("simulator", [this](Bus& bus) {
    return std::make_unique<sim::SimulatorNode>(
        *devices_, bus,
        sim::DeviceLines{*ins_device_, *motor_device_, laser_device_.get(), ground_device_.get()});
  });
  addRobotNodes();
}

RobotSystem::~RobotSystem() = default;

void RobotSystem::connect(const std::string& device, bool connected) {
  setPipeConnected(device == "ins" ? *ins_device_ : *motor_device_, connected);
}

void RobotSystem::addRobotNodes() {
  if (config_.hasIns())
    add("ins_driver", [this](Bus& bus) {
      return std::make_unique<ins::InsDriverNode>(config_.ins_driver, bus, *ins_line_, ins_store_);
    });
  add("lidar_driver", [this](Bus& bus) {
    return std::make_unique<lidar::LidarDriverNode>(config_.lidar_driver, bus, *laser_line_,
                                                    ground_line_.get());
  });
  if (config_.scan_matching)
    add("scan_matching", [this](Bus& bus) {
      return std::make_unique<scan_matching::ScanMatchingNode>(*config_.scan_matching, bus);
    });
  add("mapping",
      [this](Bus& bus) { return std::make_unique<mapping::MappingNode>(config_.mapping, bus); });
  add("planner",
      [this](Bus& bus) { return std::make_unique<planner::PlannerNode>(config_.planner, bus); });
  add("learner", [this](Bus& bus) { return makeLearner(bus); });
  add("motor_bridge", [this](Bus& bus) {
    return std::make_unique<motor::MotorBridgeNode>(config_.motor_bridge, bus, *motor_line_);
  });
}

std::unique_ptr<Node> RobotSystem::makeLearner(Bus& bus) {
  if (known_.patterns != nullptr && known_.share == TrueShare::kAll)
    return std::make_unique<TruePatternsNode>(*known_.patterns, devices_->robot(), bus);
  auto learner = std::make_unique<learner::LearnerNode>(config_.learner, bus, learner_store_);
  if (known_.patterns != nullptr)
    learner->replaceSets([this](const PatternSet& learned) {
      return known_.patterns->mixedInto(learned, robot().truth().surface, known_.share);
    });
  return learner;
}

void RobotSystem::add(const std::string& name, VirtualBus::Factory factory) {
  bus_->addNode(name, std::move(factory), config_.timing[name]);
}

FaultPlan readFaultFile(const std::string& path) {
  ConfigReader reader = ConfigReader::fromFile(path);
  FaultPlan plan;
  for (ConfigReader& entry : reader.sections("messages"))
    plan.messages.push_back(readMessageFault(entry));
  for (ConfigReader& entry : reader.sections("nodes")) plan.nodes.push_back(readNodeFault(entry));
  reader.finish();
  return plan;
}

namespace {

const std::string kOperatorName = "mission operator";
constexpr int64_t kGoalPeriod = 1'000'000;
constexpr int64_t kGoalPatience =
    1'500'000;  ///< [us] until a goal that the planner does not follow is sent again
constexpr int64_t kFirstArming = 3'000'000;  ///< [us] after the start, when all processes are up
/// [us] disarmed at standstill, as for a person to look around
constexpr int64_t kArmAgainAfter = 2'000'000;
constexpr int64_t kArmRepeats = 1'000'000;  ///< [us] ARM is repeated

}  // namespace

Operator::Operator(Bus& bus, const Pose2& T_map_goal, double tolerance)
    : bus_(bus),
      T_map_goal_(T_map_goal),
      tolerance_(tolerance),
      beacon_(bus, kOperatorName),
      motor_(bus, kMotor),
      plan_(bus, kPlan),
      start_(bus.now()) {}

void Operator::step(int64_t utime) {
  const bool may_drive = motor_.any() && mayDrive(motor_.message().bridge_state);
  if (needsArming(utime, may_drive)) {
    ++arming_;
    arm_until_ = utime + kArmRepeats;
  }
  const bool ended = goal_id_ > 0 && plan_.any() && plan_.message().goal_id != goal_id_ &&
                     utime > given_ + kGoalPatience;
  if (may_drive && (armed_ < arming_ || ended)) {
    armed_ = arming_;
    given_ = next_goal_ = utime;
    beacon_.standFor(++goal_id_);
  }
  beacon_.step(utime);
  if (utime < arm_until_) sendArm(utime);
  if (goal_id_ == 0 || utime < next_goal_) return;
  sendGoal(utime);
  next_goal_ = utime + kGoalPeriod;
}

bool Operator::needsArming(int64_t utime, bool may_drive) {
  if (utime < start_ + kFirstArming || utime < arm_until_ || !motor_.any()) return false;
  if (may_drive) {
    disarmed_since_ = -1;
    return false;
  }
  if (disarmed_since_ < 0) disarmed_since_ = utime;
  if (arming_ > 0 && utime < disarmed_since_ + kArmAgainAfter) return false;
  disarmed_since_ = -1;
  return true;
}

void Operator::sendGoal(int64_t utime) {
  auto goal = blank<goal_t>();
  goal.utime = utime;
  goal.seq = seq_goal_++;
  goal.goal_id = goal_id_;
  goal.goal_pose[0] = T_map_goal_.x;
  goal.goal_pose[1] = T_map_goal_.y;
  goal.goal_pose[2] = T_map_goal_.yaw;
  goal.position_tolerance = tolerance_;
  goal.yaw_tolerance = kPi;
  bus_.publish(kGoal, goal);
}

void Operator::sendArm(int64_t utime) {
  auto arm = blank<arm_t>();
  arm.utime = utime;
  arm.seq = seq_arm_++;
  arm.armed = true;
  arm.armed_by = kOperatorName;
  arm.arm_reason = arming_ == 1 ? "mission begins" : "armed again after a stop";
  bus_.publish(kArm, arm);
}

}  // namespace tread::missions
