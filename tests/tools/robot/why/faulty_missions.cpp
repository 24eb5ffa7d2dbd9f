// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/tools/robot/why/faulty_missions.hpp"

#include <functional>
#include <random>

#include "tests/bench/faults/fault_run.hpp"
#include "tests/tools/lab/missions/shipped_robot.hpp"
#include "tools/lab/missions/mission_runner.hpp"

namespace tread::testing {
namespace {

using faults::Fault;
using faults::FaultKind;

constexpr double kDuration = 22.0;  // [s]

struct Kind {
  FaultKind kind;
  const char* channel;
  const char* node;
  double strength_least, strength_most;
  double length_least, length_most;  // [s]
  std::set<std::string> causes;
};

const std::vector<Kind>& kinds() {
  using K = FaultKind;
  static const std::vector<Kind> all{
      // The bus.
      {K::kDrop, "INS", "motor_bridge", 0.97, 1.0, 0.6, 2.0, {"lost_INS"}},
      {K::kDrop, "PROGRAM", "motor_bridge", 0.97, 1.0, 0.6, 2.0, {"lost_PROGRAM"}},
      {K::kDrop, "MAP", "planner", 1.0, 1.0, 3.0, 4.0, {"lost_MAP"}},
      {K::kDrop, "OPERATOR", "motor_bridge", 1.0, 1.0, 2.0, 3.0, {"lost_OPERATOR"}},
      {K::kDelay, "INS", "motor_bridge", 0.6, 0.9, 0.8, 2.0, {"lost_INS"}},
      {K::kDelay, "PROGRAM", "motor_bridge", 0.6, 0.9, 0.8, 2.0, {"lost_PROGRAM"}},
      {K::kCorrupt, "INS", "motor_bridge", 0.97, 1.0, 0.8, 2.0, {"lost_INS"}},
      // Processes.
      {K::kKill, "", "ins_driver", 0, 1, 0.8, 3.0, {"ins_driver_died"}},
      {K::kKill, "", "lidar_driver", 0, 1, 2.5, 4.0, {"lidar_driver_died"}},
      {K::kKill, "", "mapping", 0, 1, 2.5, 4.0, {"mapping_died"}},
      {K::kKill, "", "planner", 0, 1, 0.8, 3.0, {"planner_died"}},
      {K::kKill, "", "motor_bridge", 0, 1, 0.8, 3.0, {"motor_bridge_died"}},
      {K::kKill, "", "learner", 0, 1, 6.5, 8.0, {"learner_died"}},
      {K::kHang, "", "ins_driver", 0, 1, 1.2, 3.0, {"ins_driver_hung"}},
      {K::kHang, "", "mapping", 0, 1, 2.5, 4.0, {"mapping_hung"}},
      {K::kHang, "", "planner", 0, 1, 1.2, 3.0, {"planner_hung"}},
      {K::kHang, "", "motor_bridge", 0, 1, 1.2, 3.0, {"motor_bridge_hung"}},
      // Devices.
      {K::kInsOutage, "", "", 0.0, 0.4, 1.0, 3.0, {"ins_device"}},
      {K::kInsOutage, "", "", 0.6, 1.0, 1.0, 3.0, {"ins_no_fix", "ins_device"}},
      {K::kInsGarbage, "", "", 0.97, 1.0, 1.0, 3.0, {"ins_device"}},
      {K::kInsJump, "", "", 0.75, 1.0, 1.5, 3.0, {"ins_jump"}},
      {K::kInsFreeze, "", "", 0, 1, 1.5, 3.0, {"ins_frozen"}},
      {K::kInsDrift, "", "", 0.85, 1.0, 2.5, 3.5, {"ins_drift", "ins_jump"}},
      {K::kTilt, "", "", 0.6, 1.0, 1.0, 2.0, {"tilt"}},
      {K::kMotorLine, "", "", 0.0, 0.35, 1.0, 3.0, {"motor_line"}},
      {K::kMotorLine, "", "", 0.45, 0.65, 1.0, 3.0, {"motor_line"}},
      {K::kMotorLine, "", "", 0.75, 1.0, 1.0, 3.0, {"motor_line"}},
      {K::kBattery, "", "", 0, 1, 1.0, 3.0, {"battery"}},
      // The map.
      {K::kPhantom, "", "", 0.05, 0.3, 1.5, 3.0, {"ghost"}},
      {K::kPhantom, "", "", 0.4, 0.6, 1.5, 3.0, {"ghost"}},
      // People.
      {K::kEstop, "", "", 0, 1, 1.0, 3.0, {"estop"}},
      {K::kDisarm, "", "", 0, 1, 1.0, 3.0, {"disarmed"}},
      {K::kOperatorLost, "", "", 0, 1, 2.0, 3.0, {"operator_lost"}},
  };
  return all;
}

/// The vehicle changes, or the ground does.
struct VehicleKind {
  const char* world;
  std::set<std::string> causes;
};
const std::vector<VehicleKind>& vehicles() {
  static const std::vector<VehicleKind> all{{"dragging_track", {"prediction", "vehicle"}},
                                            {"other_machine", {"prediction", "vehicle"}}};
  return all;
}

class Draws {
 public:
  explicit Draws(uint64_t seed) : engine_(seed * 7919 + 17) {}
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1.0p-53);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace

size_t faultKinds() {
  return kinds().size() + vehicles().size();
}

FaultyMission driveFaulty(uint64_t seed, const std::string& log) {
  FaultyMission mission;
  mission.seed = seed;
  faults::FaultSchedule schedule;
  schedule.seed = seed;
  const size_t index = seed % faultKinds();
  Draws draw(seed);
  missions::RobotConfig robot = missions::teodor();
  LogWriter writer(log);
  faults::RunOptions options;
  options.duration = kDuration;
  options.log = &writer;
  if (index >= kinds().size()) {
    const VehicleKind& vehicle = vehicles()[index - kinds().size()];
    missions::enterWorld(robot, vehicle.world);
    mission.fault = vehicle.world;
    mission.causes = vehicle.causes;
    missions::MissionOptions whole;
    whole.log = &writer;
    missions::runMission(robot, seed, whole);
    writer.flush();
    return mission;
  }
  const Kind& kind = kinds()[index];
  Fault fault;
  fault.kind = kind.kind;
  fault.channel = kind.channel;
  fault.node = kind.node;
  fault.strength = draw.between(kind.strength_least, kind.strength_most);
  mission.from = draw.between(5.0, 9.0);
  fault.from = std::llround(1e6 * mission.from);
  fault.until = fault.from + std::llround(1e6 * draw.between(kind.length_least, kind.length_most));
  schedule.faults.push_back(fault);
  mission.fault = faults::describe(fault);
  mission.causes = kind.causes;
  faults::runFaulty(robot, schedule, options);
  writer.flush();
  return mission;
}

}  // namespace tread::testing
