// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

/// Makes the source; the origin of the map is given where it is known.
using MakeInsSource =
    std::function<std::unique_ptr<InsSource>(const std::optional<GeoOrigin>& origin)>;

/// Reads what every kind of device adds to the driver's configuration; its mounting is the robot's.
InsConfig readInsConfig(ConfigReader& reader, const RobotDescription& robot);

/// Reads the place of the base line of two antennas, for devices that measure it.
void readBaseline(ConfigReader& reader, InsConfig& ins);

/// Reads what turns GPS time and heights above the ellipsoid into UTC and heights above the sea.
void readGpsConventions(ConfigReader& reader, InsConfig& ins);

/// Makes sources of a kind; the origin that is given replaces that of the configuration.
template <class Source>
MakeInsSource sourceOf(const InsConfig& config) {
  return [config](const std::optional<GeoOrigin>& origin) {
    InsConfig with_origin = config;
    if (origin) with_origin.origin = origin;
    return std::make_unique<Source>(with_origin);
  };
}

}  // namespace tread::ins
