// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "modules/simulator/core/robot.hpp"
#include "modules/simulator/core/speed_loop.hpp"
#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// Robot and devices of one simulation. Devices have the names that their drivers' configurations
/// use.
struct SimulatorSettings {
  RobotSettings robot;
  MapOnEarth ins;
  std::string controller = "roboteq";  ///< of the motors
  std::string source = "nmea";         ///< the INS
  std::string device = "hokuyo";       ///< the range finder
};

/// Names of the devices with emulators.
struct EmulatedDevices {
  std::vector<std::string> controllers;
  std::vector<std::string> sources;
  std::vector<std::string> devices;
};
EmulatedDevices emulatedDevices();

/// The simulated robot with its devices: drivers access it only by bytes in and out.
/** Pure: no clock, no links. */
class SimulatedDevices {
 public:
  /// Throws std::out_of_range for a device that is not in emulatedDevices().
  SimulatedDevices(std::shared_ptr<const World> world, const SimulatorSettings& settings,
                   RobotParts parts = {});

  /// Simulates up to a time; the motors follow the controller's output in steps of 1 ms.
  void advanceTo(int64_t utime);

  /// Present output of the controller to the left and the right motor, or to each wheel's, -1..1:
  /// power, or a share of the speed controlled at full command.
  MotorValues power(int64_t utime);

  const SimulatedRobot& robot() const { return robot_; }
  InsEmulator& ins() { return *ins_; }
  MotorEmulator& motor() { return *motor_; }
  LaserEmulator& laser() { return *laser_; }
  /// The one that looks at the ground ahead; null if the robot has none.
  LaserEmulator* groundLaser() { return ground_laser_.get(); }

 private:
  void measureDrive();
  void drive();
  MotorValues ofTracks(MotorValues channels) const;

  SimulatedRobot robot_;
  std::vector<SpeedLoop> speed_loops_;  ///< left and right, or each wheel
  std::unique_ptr<InsEmulator> ins_;
  std::unique_ptr<MotorEmulator> motor_;
  std::unique_ptr<LaserEmulator> laser_;
  std::unique_ptr<LaserEmulator> ground_laser_;
};

}  // namespace tread::sim
