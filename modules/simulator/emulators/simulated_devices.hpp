// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "modules/simulator/core/robot.hpp"
#include "modules/simulator/emulators/hokuyo/scip_emulator.hpp"
#include "modules/simulator/emulators/nmea/nmea_ins_emulator.hpp"
#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"

namespace tread::sim {

/// Robot and devices of one simulation.
struct SimulatorSettings {
  RobotSettings robot;
  NmeaInsSettings ins;
  RoboteqSettings motor;
};

/// The simulated robot with its three devices: bytes in and out are all that a driver sees of it.
/** Pure: no clock, no links. */
class SimulatedDevices {
 public:
  SimulatedDevices(std::shared_ptr<const World> world, const SimulatorSettings& settings,
                   RobotParts parts = {});

  /// Simulates up to a time; the motors follow the controller's output in steps of 1 ms.
  void advanceTo(int64_t utime);

  /// Power that the controller gives to the left and the right motor now, -1..1.
  std::array<double, 2> power(int64_t utime);

  /// Laser scans finished since the last call: the interface behind the range finder's library.
  std::vector<LaserScan> takeScans();

  const SimulatedRobot& robot() const { return robot_; }
  NmeaInsEmulator& ins() { return ins_; }
  RoboteqEmulator& motor() { return motor_; }
  ScipEmulator& laser() { return laser_; }

 private:
  void measureDrive();

  SimulatedRobot robot_;
  NmeaInsEmulator ins_;
  RoboteqEmulator motor_;
  ScipEmulator laser_;
  std::vector<LaserScan> scans_;
};

}  // namespace tread::sim
