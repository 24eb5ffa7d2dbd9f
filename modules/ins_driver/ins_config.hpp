// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

/// Read the keys that each kind of device adds to the driver's configuration; the mounting is the
/// robot's.
InsConfig readNmeaConfig(ConfigReader& reader, const RobotDescription& robot);
InsConfig readNovatelConfig(ConfigReader& reader, const RobotDescription& robot);
InsConfig readUbloxConfig(ConfigReader& reader, const RobotDescription& robot);
/// Of a VectorNav or an Xsens, which send each epoch in one message.
InsConfig readSingleMessageConfig(ConfigReader& reader, const RobotDescription& robot);

}  // namespace tread::ins
