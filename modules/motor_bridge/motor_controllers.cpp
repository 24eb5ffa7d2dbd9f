// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/motor_controllers.hpp"

#include <map>
#include <vector>

#include "modules/motor_bridge/kangaroo/kangaroo_connection.hpp"
#include "modules/motor_bridge/line_protocol/line_connection.hpp"
#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"
#include "modules/motor_bridge/sabertooth/sabertooth_connection.hpp"
#include "modules/motor_bridge/vesc/vesc_connection.hpp"

namespace tread::motor {
namespace {

template <class Connection, class Config>
MakeMotorController making(const Config& config) {
  return [config] { return std::make_unique<Connection>(config); };
}

MakeMotorController roboteq(ConfigReader& reader, const DriveDescription& drive) {
  ConfigReader section = reader.section("roboteq");
  return making<RoboteqConnection>(readRoboteqConfig(section, drive));
}

MakeMotorController lineProtocol(ConfigReader& reader, const DriveDescription& drive) {
  ConfigReader description = reader.file("line_protocol", "line_protocol.yaml");
  return making<LineConnection>(readLineDescription(description, drive));
}

MakeMotorController kangaroo(ConfigReader& reader, const DriveDescription& drive) {
  if (drive.kind != CommandKind::kTrackSpeed)
    throw reader.error("controller",
                       "kangaroo controls only speeds, but the robot's drive is power: set "
                       "track_speed, or use sabertooth");
  ConfigReader section = reader.section("kangaroo");
  return making<KangarooConnection>(readKangarooConfig(section, drive));
}

MakeMotorController sabertooth(ConfigReader& reader, const DriveDescription& drive) {
  if (drive.kind != CommandKind::kPower)
    throw reader.error("controller",
                       "sabertooth accepts only power, but the robot's drive is track_speed");
  ConfigReader section = reader.section("sabertooth");
  return making<SabertoothConnection>(readSabertoothConfig(section, drive));
}

template <class Connection>
MakeMotorController vesc(ConfigReader section, const DriveDescription& drive) {
  return making<Connection>(readVescConfig(section, drive));
}

/// A new controller needs one line here and a folder of its own.
const std::map<std::string, MakeMotorController (*)(ConfigReader&, const DriveDescription&)>
    kControllers{{"kangaroo", kangaroo},
                 {"line_protocol", lineProtocol},
                 {"roboteq", roboteq},
                 {"sabertooth", sabertooth},
                 {"vesc",
                  [](ConfigReader& reader, const DriveDescription& drive) {
                    return vesc<VescUart>(reader.section("vesc"), drive);
                  }},
                 {"vesc_can", [](ConfigReader& reader, const DriveDescription& drive) {
                    return vesc<VescCan>(reader.section("vesc_can"), drive);
                  }}};

}  // namespace

MakeMotorController readMotorController(ConfigReader& reader, const DriveDescription& drive,
                                        std::string& name) {
  std::vector<std::string> known;
  for (const auto& [each, read] : kControllers) known.push_back(each);
  reader.choice("controller", name, known);
  // Over CAN a VESC has no command for its servo output.
  if (drive.isCar() && name != "vesc" && name != "line_protocol")
    throw reader.error(
        "controller",
        name +
            " cannot steer a car (drive.layout: "
            "throttle_steering); take vesc, which has a servo output, or line_protocol");
  if (drive.isOmni() && name != "vesc" && name != "vesc_can" && name != "line_protocol")
    throw reader.error("controller", name + " drives two tracks (drive.layout: omni has " +
                                         std::to_string(drive.wheels.size()) +
                                         " wheels); take vesc, vesc_can or line_protocol");
  return kControllers.at(name)(reader, drive);
}

}  // namespace tread::motor
