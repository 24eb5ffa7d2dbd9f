// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/virtual_bus.hpp"
#include "common/geometry/se2.hpp"
#include "common/link/link.hpp"
#include "common/messages/operator_beacon.hpp"
#include "common/pattern/pattern.hpp"
#include "common/store/store.hpp"
#include "modules/ins_driver/ins_driver_node.hpp"
#include "modules/learner/learner_node.hpp"
#include "modules/lidar_driver/lidar_driver_node.hpp"
#include "modules/mapping/mapping_node.hpp"
#include "modules/motor_bridge/motor_bridge_node.hpp"
#include "modules/planner/planner_node.hpp"
#include "modules/scan_matching/scan_matching_node.hpp"
#include "modules/simulator/core/robot.hpp"
#include "modules/simulator/emulators/simulated_devices.hpp"
#include "tools/lab/missions/true_patterns.hpp"
#include "tools/lab/missions/world_kind.hpp"

namespace tread::missions {

/// True patterns for a planner, and which part of them.
struct Knowledge {
  const TruePatterns* patterns = nullptr;  ///< if given; must outlive the planner
  TrueShare share = TrueShare::kAll;
};

/// Configurations of all processes of one robot, as in its folder.
struct RobotConfig {
  explicit RobotConfig(learner::LearnerNodeConfig learner_config)
      : learner(std::move(learner_config)) {}

  learner::LearnerNodeConfig learner;  ///< with the shipped pattern set
  ins::InsDriverConfig ins_driver;     ///< if the robot has an INS
  /// if the robot has scan matching
  std::optional<scan_matching::ScanMatchingConfig> scan_matching;
  lidar::LidarDriverConfig lidar_driver;
  mapping::MappingConfig mapping;
  planner::PlannerConfig planner;
  motor::MotorBridgeConfig motor_bridge;
  sim::RobotSettings simulated;              ///< the simulator's counterpart
  std::map<std::string, NodeTiming> timing;  ///< model of each node's computing time
  WorldKind world;                           ///< world of the missions

  /// Otherwise scan matching replaces the INS.
  bool hasIns() const { return !scan_matching || scan_matching->fills_in; }
};

/// Bus names of the processes of a robot with an INS; scan_matching is optional.
const std::vector<std::string>& robotNodes();

/// Reads a robot's folder (config/robots/teodor: one file a process); throws ConfigError with one
/// clear line.
/** An override is "process.key=value" or "process.section.key=value" and replaces the value in the
 * file of that process. */
RobotConfig readRobot(const std::string& folder, const std::vector<std::string>& overrides = {});

/// Applies a kind of world to the robot; throws ConfigError with one clear line.
void enterWorld(RobotConfig& robot, const std::string& kind);

/// Reads a fault file: `messages` (channel, receiver, drop, duplicate, corrupt, reorder, reorder_s,
/// delay_s, from_s, until_s) and `nodes` (node, kill_at_s, restart_after_s). Throws ConfigError
/// with file:line.
FaultPlan readFaultFile(const std::string& path);

/// The whole robot and its world on a virtual bus: real nodes, real device bytes, real messages.
/** Device lines are in-memory pipes between drivers and emulators. Links, stores and the simulated
 * robot survive the killing of a node. Message faults for every receiver affect only the robot's
 * processes, not outside observers. */
class RobotSystem {
 public:
  /// `rule`: learning rule; empty = that of the configuration. `known`: if all true patterns are
  /// given, TruePatternsNode replaces the learner; if a part, it is put into each set that the
  /// learner publishes, for the ground under the body at that time.
  RobotSystem(const RobotConfig& config, const sim::WorldDescription& world,
              const Pose2& T_map_start, uint64_t seed, const std::string& rule,
              const FaultPlan& faults, const Knowledge& known = {}, sim::RobotParts parts = {});
  ~RobotSystem();

  VirtualBus& bus() { return *bus_; }
  const sim::SimulatedRobot& robot() const { return devices_->robot(); }
  sim::SimulatedDevices& devices() { return *devices_; }
  /// Disconnects or reconnects a device's line: "ins" or "motor".
  void connect(const std::string& device, bool connected);
  /// Alters each scan that the range finder's driver has read.
  void disturbScans(std::function<void(lidar::RangeScan&)> disturb) {
    disturb_scan_ = std::move(disturb);
  }
  const PatternSet& patterns() const { return config_.learner.shipped; }
  const learner::LearnerNodeConfig& learnerConfig() const { return config_.learner; }
  const planner::PlannerConfig& planner() const { return config_.planner; }
  const mapping::OccupancyMapConfig& map() const { return config_.mapping.map; }

 private:
  class DisturbedDevice;
  void addRobotNodes();
  std::unique_ptr<Node> makeLearner(Bus& bus);
  void add(const std::string& name, VirtualBus::Factory factory);

  RobotConfig config_;
  Knowledge known_;
  std::unique_ptr<Link> ins_line_, ins_device_;      ///< both ends of the INS line
  std::unique_ptr<Link> motor_line_, motor_device_;  ///< both ends of the motor controller's line
  std::unique_ptr<Link> laser_line_, laser_device_;  ///< both ends of the range finder's line
  /// the same for the one that looks at the ground
  std::unique_ptr<Link> ground_line_, ground_device_;
  std::unique_ptr<sim::SimulatedDevices> devices_;
  std::function<void(lidar::RangeScan&)> disturb_scan_;
  MemoryStore ins_store_;
  MemoryStore learner_store_;
  std::unique_ptr<VirtualBus> bus_;  ///< last: its nodes refer to the other members
};

/// Position tolerance of goals in missions [m].
inline constexpr double kGoalTolerance = 0.6;

/// The remote operator: sends the goal, arms, and arms again after a failsafe.
class Operator {
 public:
  /// `tolerance` [m] of the goal.
  Operator(Bus& bus, const Pose2& T_map_goal, double tolerance = kGoalTolerance);

  void step(int64_t utime);
  /// Number of repeated armings.
  int rearmed() const { return arming_ - 1 < 0 ? 0 : arming_ - 1; }

 private:
  void sendGoal(int64_t utime);
  void sendArm(int64_t utime);
  bool needsArming(int64_t utime, bool may_drive);

  Bus& bus_;
  Pose2 T_map_goal_;
  double tolerance_;
  OperatorBeacon beacon_;
  Latest<motor_t> motor_;
  Latest<plan_t> plan_;
  int64_t start_;
  int64_t next_goal_ = 0;
  int64_t given_ = 0;      ///< [us]
  int armed_ = 0;          ///< arming before the present goal
  int64_t goal_id_ = 0;    ///< new after each arming: earlier goals are void
  int64_t arm_until_ = 0;  ///< ARM is repeated until then
  int64_t disarmed_since_ = -1;
  int arming_ = 0;
  int64_t seq_goal_ = 0;
  int64_t seq_arm_ = 0;
};

}  // namespace tread::missions
