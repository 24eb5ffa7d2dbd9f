// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/vehicle_config.hpp"

#include "common/vehicle/robot_file.hpp"

namespace tread::sim {
namespace {

void readBody(ConfigReader& reader, VehicleParameters& vehicle, bool required) {
  reader.number("mass", vehicle.mass, {100.0, 2000.0}, "kg", required);
  reader.number("yaw_inertia", vehicle.yaw_inertia, {5.0, 500.0}, "kg m2", required);
  reader.number("gauge", vehicle.gauge, {0.2, 2.0}, "m");
  reader.number("contact_length", vehicle.contact_length, {0.2, 3.0}, "m", required);
  reader.number("centre", vehicle.centre, {-0.5, 0.5}, "m", required);
  reader.number("mass_height", vehicle.mass_height, {0.0, 2.0}, "m", required);
}

void readDrive(ConfigReader& reader, DriveParameters& drive, bool required) {
  reader.number("free_speed", drive.free_speed, {0.1, 5.0}, "m/s");
  reader.number("stiffness", drive.stiffness, {200.0, 50000.0}, "N s/m", required);
  reader.number("force_limit", drive.force_limit, {100.0, 20000.0}, "N", required);
  reader.number("power_lag", drive.power_lag, {0.001, 2.0}, "s");
  reader.number("dead_power", drive.dead_power, {0.0, 0.5}, "");
  reader.number("track_mass", drive.track_mass, {5.0, 500.0}, "kg", required);
  reader.number("gear_friction", drive.gear_friction, {0.0, 2000.0}, "N", required);
  reader.number("brake_force", drive.brake_force, {0.0, 20000.0}, "N", required);
}

void readBattery(ConfigReader& reader, VehicleParameters& vehicle) {
  DriveParameters& drive = vehicle.drive;
  reader.number("charge", vehicle.charge, {0.0, 1.0}, "");
  reader.number("full_voltage", drive.full_voltage, {20.0, 32.0}, "V");
  reader.number("empty_voltage", drive.empty_voltage, {10.0, 32.0}, "V");
  reader.number("inner_resistance", drive.inner_resistance, {0.0, 0.2}, "ohm");
  double capacity = drive.capacity / 3600.0;
  reader.number("capacity", capacity, {0.1, 1000.0}, "Ah");
  drive.capacity = capacity * 3600.0;
  reader.number("idle_current", drive.idle_current, {0.0, 100.0}, "A");
  if (drive.empty_voltage > drive.full_voltage)
    throw reader.error("empty_voltage", "must not be above full_voltage");
}

}  // namespace

void readVehicle(ConfigReader reader, VehicleParameters& vehicle, bool whole) {
  readBody(reader, vehicle, whole);
  reader.number("left_power", vehicle.left_power, {0.0, 1.5}, "");
  reader.number("right_power", vehicle.right_power, {0.0, 1.5}, "");
  readDrive(reader, vehicle.drive, whole);
  readBattery(reader, vehicle);
}

void readSimulatedRobot(ConfigReader& reader, RobotSettings& settings) {
  const RobotDescription robot = readRobot(reader);
  settings.vehicle.outline = robot.outline;
  settings.vehicle.gauge = robot.gauge;
  settings.vehicle.drive.free_speed = robot.drive.full_speed;
  settings.wiring = {robot.drive.left_channel, robot.drive.invert_left, robot.drive.invert_right};
  settings.laser.mounting = robot.range_finder;
  settings.ins.mounting = robot.ins;
  readVehicle(reader.file("dynamics", "dynamics.yaml"), settings.vehicle, true);
}

RobotSettings readSimulatedRobot(const std::string& folder) {
  ConfigReader reader = ConfigReader::fromText("{}", folder + "/simulator");
  RobotSettings settings;
  readSimulatedRobot(reader, settings);
  reader.finish();
  return settings;
}

}  // namespace tread::sim
