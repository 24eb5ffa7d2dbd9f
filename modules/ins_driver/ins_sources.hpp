// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

/// Makes the source; the origin of the map is given where it is known.
using MakeInsSource =
    std::function<std::unique_ptr<InsSource>(const std::optional<GeoOrigin>& origin)>;

/// Reads which INS the robot has (key `source`) and what that one's reader wants to know.
MakeInsSource readInsSource(ConfigReader& reader, const RobotDescription& robot);

}  // namespace tread::ins
