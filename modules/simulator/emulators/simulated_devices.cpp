// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/simulated_devices.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "modules/simulator/emulators/hokuyo/scip_emulator.hpp"
#include "modules/simulator/emulators/kangaroo/kangaroo_emulator.hpp"
#include "modules/simulator/emulators/line_protocol/mole_emulator.hpp"
#include "modules/simulator/emulators/nmea/nmea_ins_emulator.hpp"
#include "modules/simulator/emulators/novatel/novatel_emulator.hpp"
#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"
#include "modules/simulator/emulators/rplidar/rplidar_emulator.hpp"
#include "modules/simulator/emulators/sabertooth/sabertooth_emulator.hpp"
#include "modules/simulator/emulators/sick_cola/cola_emulator.hpp"
#include "modules/simulator/emulators/sick_lms2xx/lms_emulator.hpp"
#include "modules/simulator/emulators/ublox/ublox_emulator.hpp"
#include "modules/simulator/emulators/vectornav/vectornav_emulator.hpp"
#include "modules/simulator/emulators/velodyne/velodyne_emulator.hpp"
#include "modules/simulator/emulators/vesc/vesc_emulators.hpp"
#include "modules/simulator/emulators/xsens/xsens_emulator.hpp"

namespace tread::sim {
namespace {

constexpr int64_t kStepUs = 1000;
constexpr uint64_t kInsStream = 10;  // of random numbers, separate from the robot's
constexpr uint64_t kLaserStream = 11;
constexpr uint64_t kMotorStream = 12;
constexpr uint64_t kGroundLaserStream = 13;

/// Positive while the motor drives, negative while it brakes.
double drivingCurrent(const TrackDrive& track) {
  return std::copysign(1.0, track.power) * track.current;
}

/// As many as the robot has motors; a car's only one also has the servo.
VescSettings vescsOf(const RobotSettings& robot) {
  VescSettings vesc;
  vesc.servo = robot.vehicle.wheelbase > 0.0;
  vesc.controllers = vesc.servo ? 1 : robot.wiring.four_motors ? 4 : 2;
  if (robot.vehicle.wheels.empty()) return vesc;
  vesc.channels = robot.vehicle.wheels.size();
  vesc.controllers = static_cast<int>(vesc.channels);
  return vesc;
}

// A new device needs one line in one of these tables and a folder of its own.
using Settings = SimulatorSettings;
template <class Kind, class From = Settings>
using Table = std::map<std::string, std::unique_ptr<Kind> (*)(const From&, uint64_t seed)>;

const Table<MotorEmulator> kControllers{
    {"kangaroo",
     [](const Settings&, uint64_t) -> std::unique_ptr<MotorEmulator> {
       return std::make_unique<KangarooEmulator>();
     }},
    {"line_protocol",
     [](const Settings& settings, uint64_t) -> std::unique_ptr<MotorEmulator> {
       return std::make_unique<MoleEmulator>(
           std::max<size_t>(2, settings.robot.vehicle.wheels.size()));
     }},
    {"roboteq",
     [](const Settings&, uint64_t) -> std::unique_ptr<MotorEmulator> {
       return std::make_unique<RoboteqEmulator>();
     }},
    {"sabertooth",
     [](const Settings&, uint64_t) -> std::unique_ptr<MotorEmulator> {
       return std::make_unique<SabertoothEmulator>();
     }},
    {"vesc",
     [](const Settings& settings, uint64_t) -> std::unique_ptr<MotorEmulator> {
       return std::make_unique<VescUartEmulator>(vescsOf(settings.robot));
     }},
    {"vesc_can", [](const Settings& settings, uint64_t) -> std::unique_ptr<MotorEmulator> {
       return std::make_unique<VescCanEmulator>(vescsOf(settings.robot));
     }}};
template <class Device>
std::unique_ptr<InsEmulator> binaryIns(const Settings& settings, uint64_t seed) {
  return std::make_unique<Device>(settings.ins, seed);
}
const Table<InsEmulator> kSources{
    {"novatel", binaryIns<NovatelEmulator>},
    {"ublox", binaryIns<UbloxEmulator>},
    {"vectornav", binaryIns<VectornavEmulator>},
    {"xsens", binaryIns<XsensEmulator>},
    {"nmea", [](const Settings& settings, uint64_t seed) -> std::unique_ptr<InsEmulator> {
       return std::make_unique<NmeaInsEmulator>(NmeaInsSettings{settings.ins, {}}, seed);
     }}};
const Table<LaserEmulator, LaserParameters> kRangeFinders{
    {"hokuyo",
     [](const LaserParameters& laser, uint64_t seed) -> std::unique_ptr<LaserEmulator> {
       return std::make_unique<ScipEmulator>(scipSettingsOf(laser), seed);
     }},
    {"rplidar",
     [](const LaserParameters& laser, uint64_t) -> std::unique_ptr<LaserEmulator> {
       return std::make_unique<RplidarEmulator>(laser);
     }},
    {"sick_cola",
     [](const LaserParameters& laser, uint64_t) -> std::unique_ptr<LaserEmulator> {
       return std::make_unique<ColaEmulator>(laser);
     }},
    {"sick_lms2xx",
     [](const LaserParameters& laser, uint64_t) -> std::unique_ptr<LaserEmulator> {
       return std::make_unique<LmsEmulator>(laser);
     }},
    {"velodyne", [](const LaserParameters& laser, uint64_t) -> std::unique_ptr<LaserEmulator> {
       return std::make_unique<VelodyneEmulator>(laser);
     }}};

template <class Kind, class From>
std::vector<std::string> namesIn(const Table<Kind, From>& table) {
  std::vector<std::string> names;
  for (const auto& [name, make] : table) names.push_back(name);
  return names;
}

}  // namespace

EmulatedDevices emulatedDevices() {
  return {namesIn(kControllers), namesIn(kSources), namesIn(kRangeFinders)};
}

SimulatedDevices::SimulatedDevices(std::shared_ptr<const World> world,
                                   const SimulatorSettings& settings, RobotParts parts)
    : robot_(std::move(world), settings.robot, std::move(parts)),
      speed_loops_(robot_.vehicle().motors(), SpeedLoop(settings.robot.vehicle.drive.free_speed)),
      ins_(kSources.at(settings.source)(settings, streamSeed(settings.robot.seed, kInsStream))),
      motor_(kControllers.at(settings.controller)(settings,
                                                  streamSeed(settings.robot.seed, kMotorStream))),
      laser_(kRangeFinders.at(settings.device)(settings.robot.laser,
                                               streamSeed(settings.robot.seed, kLaserStream))) {
  if (settings.robot.ground_laser)
    ground_laser_ = kRangeFinders.at(settings.device)(
        *settings.robot.ground_laser, streamSeed(settings.robot.seed, kGroundLaserStream));
  measureDrive();
}

void SimulatedDevices::advanceTo(int64_t utime) {
  while (robot_.truth().utime + kStepUs <= utime) {
    drive();
    robot_.advanceTo(robot_.truth().utime + kStepUs);
    measureDrive();
  }
  for (const InsMeasurement& sample : robot_.takeInsSamples()) ins_->add(sample);
  for (const LaserScan& scan : robot_.takeScans())
    (scan.ground ? *ground_laser_ : *laser_).add(scan);
}

MotorValues SimulatedDevices::power(int64_t utime) {
  return ofTracks(motor_->output(utime));
}

/// From the controller's channels to the left and the right track, and back; for a holonomic base,
/// to its wheels.
MotorValues SimulatedDevices::ofTracks(MotorValues channels) const {
  const MotorWiring& wiring = robot_.settings().wiring;
  for (size_t i = 0; i < wiring.invert_wheels.size(); ++i)
    if (wiring.invert_wheels[i]) channels[i] = -channels[i];
  if (!wiring.invert_wheels.empty()) return channels;
  if (wiring.left_channel == 2) std::swap(channels[0], channels[1]);
  if (wiring.invert_left) channels[0] = -channels[0];
  if (wiring.invert_right) channels[1] = -channels[1];
  return channels;
}

void SimulatedDevices::drive() {
  const MotorValues given = power(robot_.truth().utime);
  const double top_speed = robot_.settings().wiring.top_speed.value_or(0.0);
  const Plant& vehicle = robot_.vehicle();
  const auto held = motor_->heldSpeeds();
  if (top_speed == 0.0 || (held && !vehicle.takesSpeeds()))
    return robot_.setPower(MotorPower::of(given));
  MotorValues wanted = held ? ofTracks(*held) : given;
  if (!held)
    for (double& value : wanted) value *= top_speed;
  if (vehicle.takesSpeeds()) return robot_.setPower(MotorPower::of(wanted));
  constexpr double kStep = static_cast<double>(kStepUs) * 1e-6;
  MotorValues power{};
  for (size_t i = 0; i < speed_loops_.size(); ++i)
    power[i] = speed_loops_[i].step(wanted[i], vehicle.motor(i).speed, kStep);
  robot_.setPower(MotorPower::of(power));
}

void SimulatedDevices::measureDrive() {
  const MotorWiring& wiring = robot_.settings().wiring;
  const Plant& vehicle = robot_.vehicle();
  DriveMeasurements seen;
  seen.battery_voltage = vehicle.battery().voltage;
  for (size_t i = 0; i < vehicle.motors(); ++i) {
    const bool inverted = i < wiring.invert_wheels.size() ? wiring.invert_wheels[i]
                          : i == 0                        ? wiring.invert_left
                                                          : wiring.invert_right;
    seen.motor_current[i] = drivingCurrent(vehicle.motor(i));
    seen.track_speed[i] = inverted ? -vehicle.motor(i).speed : vehicle.motor(i).speed;
  }
  if (wiring.left_channel == 2) {
    std::swap(seen.motor_current[0], seen.motor_current[1]);
    std::swap(seen.track_speed[0], seen.track_speed[1]);
  }
  motor_->measure(seen);
}

}  // namespace tread::sim
