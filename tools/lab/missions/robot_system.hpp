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
#include "tools/lab/missions/world_kind.hpp"

namespace tread::missions {

/// What of the true patterns an experiment gives the planner.
enum class TrueShare {
  kAll,         ///< means and covariances; nobody learns
  kMeans,       ///< trajectories and classes, with the covariances of a rule that learns beside
  kCovariances  ///< of the ends, with the trajectories of that rule
};

/// What an omniscient robot would know: the patterns as each surface truly makes them.
/** The simulator's ground truth executes every pattern on level ground of the surface, entered in
 * the steady motion of its entry class, without the ground's chance. That chance is in the
 * covariances: those of so many disturbed executions. Classes get the steady twists of the surface.
 * What even this robot does not know: slopes, and where within a pattern the surface changes. */
class TruePatterns {
 public:
  /// For all built-in surfaces and some more; of a vehicle with speed loops, where the set asks
  /// for speeds.
  TruePatterns(const PatternSet& shipped, const sim::VehicleParameters& vehicle,
               const std::vector<sim::SurfaceParameters>& more = {});

  /// The set of a surface under a version; throws std::out_of_range for a surface that is not
  /// known.
  PatternSet on(const std::string& surface, int64_t version) const;
  /// A learned set with the true means or covariances of a surface in the place of its own.
  PatternSet mixedInto(const PatternSet& learned, const std::string& surface,
                       TrueShare share) const;

 private:
  std::map<std::string, PatternSetContent> by_surface_;
};

/// True patterns for a planner, and how many of them.
struct Knowledge {
  const TruePatterns* patterns = nullptr;  ///< if given; they must outlive who is told of them
  TrueShare share = TrueShare::kAll;
};

/// In the learner's place: publishes the true set of the ground that the body stands on.
/** A new version whenever that becomes another one; repeated as the learner repeats its own. */
class TruePatternsNode : public Node {
 public:
  TruePatternsNode(const TruePatterns& patterns, const sim::SimulatedRobot& robot, Bus& bus)
      : patterns_(patterns), robot_(robot), publisher_(bus), version_(bus.now() / 1'000'000) {}

  int64_t period() const override { return 20'000; }
  void step(int64_t utime) override;

 private:
  static constexpr int64_t kRepeat = 2'000'000;  ///< [us]

  const TruePatterns& patterns_;
  const sim::SimulatedRobot& robot_;
  learner::SetPublisher publisher_;
  std::string surface_;
  int64_t version_;  ///< begins with the seconds, so that a restarted node counts on
  int64_t next_repeat_ = 0;
};

/// The configurations of all processes of one robot, as the files of its folder have them.
struct RobotConfig {
  explicit RobotConfig(learner::LearnerNodeConfig learner_config)
      : learner(std::move(learner_config)) {}

  learner::LearnerNodeConfig learner;                              ///< with the shipped pattern set
  ins::InsDriverConfig ins_driver;                                 ///< where the robot has an INS
  std::optional<scan_matching::ScanMatchingConfig> scan_matching;  ///< where the robot has it
  lidar::LidarDriverConfig lidar_driver;
  mapping::MappingConfig mapping;
  planner::PlannerConfig planner;
  motor::MotorBridgeConfig motor_bridge;
  sim::RobotSettings simulated;              ///< what the simulator drives in its place
  std::map<std::string, NodeTiming> timing;  ///< how long each node computes, as a model
  WorldKind world;                           ///< that its missions take place in

  /// Else scan matching is in the INS's place.
  bool hasIns() const { return !scan_matching || scan_matching->fills_in; }
};

/// Names of the processes that a robot with an INS has on the bus; scan_matching may be there, too.
const std::vector<std::string>& robotNodes();

/// Reads a robot's folder (config/robots/teodor: one file a process); throws ConfigError with one
/// clear line.
/** An override is "process.key=value" or "process.section.key=value": it replaces what the file of
 * that process says. */
RobotConfig readRobot(const std::string& folder, const std::vector<std::string>& overrides = {});

/// Puts the robot into a kind of world; throws ConfigError with one clear line.
void enterWorld(RobotConfig& robot, const std::string& kind);

/// Reads a fault file: `messages` (channel, receiver, drop, duplicate, corrupt, reorder, reorder_s,
/// delay_s, from_s, until_s) and `nodes` (node, kill_at_s, restart_after_s). Throws ConfigError
/// with file:line.
FaultPlan readFaultFile(const std::string& path);

/// The whole robot and its world on a virtual bus: real nodes, real device bytes, real messages.
/** Device lines are in-memory pipes between drivers and emulators. Links, stores and the simulated
 * robot outlive a node that is killed. A fault of messages to every receiver affects only the
 * robot's processes; observers outside receive every message unharmed. */
class RobotSystem {
 public:
  /// `rule`: of learning; empty = the configuration's. `known`: all true patterns take the
  /// learner's place (TruePatternsNode); a share of them is put into each set that it publishes, as
  /// they are on the ground below the body when the set is new.
  RobotSystem(const RobotConfig& config, const sim::WorldDescription& world,
              const Pose2& T_map_start, uint64_t seed, const std::string& rule,
              const FaultPlan& faults, const Knowledge& known = {}, sim::RobotParts parts = {});
  ~RobotSystem();

  VirtualBus& bus() { return *bus_; }
  const sim::SimulatedRobot& robot() const { return devices_->robot(); }
  sim::SimulatedDevices& devices() { return *devices_; }
  /// Cuts or mends a device's line: "ins" or "motor".
  void connect(const std::string& device, bool connected);
  /// Changes each scan that the range finder's driver has read.
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
  std::unique_ptr<Link> ins_line_, ins_device_;        ///< both ends of the INS line
  std::unique_ptr<Link> motor_line_, motor_device_;    ///< both ends of the motor controller's line
  std::unique_ptr<Link> laser_line_, laser_device_;    ///< both ends of the range finder's line
  std::unique_ptr<Link> ground_line_, ground_device_;  ///< the same of the one at the ground
  std::unique_ptr<sim::SimulatedDevices> devices_;
  std::function<void(lidar::RangeScan&)> disturb_scan_;
  MemoryStore ins_store_;
  MemoryStore learner_store_;
  std::unique_ptr<VirtualBus> bus_;  ///< last: its nodes refer to the rest
};

/// Of goals in missions [m].
inline constexpr double kGoalTolerance = 0.6;

/// The person at the remote control: sends the goal, arms, and arms again after a failsafe.
class Operator {
 public:
  /// `tolerance` [m]: of the goal.
  Operator(Bus& bus, const Pose2& T_map_goal, double tolerance = kGoalTolerance);

  void step(int64_t utime);
  /// How often it had to arm again.
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
  int armed_ = 0;          ///< the arming that the goal was given after
  int64_t goal_id_ = 0;    ///< a new one after each arming: an earlier goal counts for nothing
  int64_t arm_until_ = 0;  ///< ARM is repeated until then
  int64_t disarmed_since_ = -1;
  int arming_ = 0;
  int64_t seq_goal_ = 0;
  int64_t seq_arm_ = 0;
};

}  // namespace tread::missions
