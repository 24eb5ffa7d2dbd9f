// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/motor_controllers.hpp"

#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"

namespace tread::motor {
namespace {

MakeMotorController roboteq(ConfigReader section, const DriveDescription& drive) {
  const RoboteqConfig config = readRoboteqConfig(section, drive);
  return [config] { return std::make_unique<RoboteqConnection>(config); };
}

/// A new controller is one line here and a folder of its own.
const std::map<std::string, MakeMotorController (*)(ConfigReader, const DriveDescription&)>
    kControllers{{"roboteq", roboteq}};

}  // namespace

MakeMotorController readMotorController(ConfigReader& reader, const DriveDescription& drive) {
  std::vector<std::string> known;
  for (const auto& [name, read] : kControllers) known.push_back(name);
  std::string name = "roboteq";
  reader.choice("controller", name, known);
  return kControllers.at(name)(reader.section(name), drive);
}

}  // namespace tread::motor
