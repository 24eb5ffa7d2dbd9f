// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

/// Makes the source; the origin of the map is given where it is known.
using MakeInsSource =
    std::function<std::unique_ptr<InsSource>(const std::optional<GeoOrigin>& origin)>;

/// Reads which INS the robot has (key `source`) and what that one's reader wants to know.
MakeInsSource readInsSource(ConfigReader& reader, const RobotDescription& robot);

/// Configuration of ins_driver, with its defaults.
struct InsDriverConfig {
  std::string address = "tty:/dev/ttyUSB0?baud=115200";  ///< of the device
  std::string store = "state/ins_driver";                ///< folder that keeps the map's origin
  MakeInsSource make_source;        ///< of the kind that the configuration names
  std::optional<GeoOrigin> origin;  ///< of the map; absent: stored, or the first good fix
  double silence = 1.0;             ///< [s] without what is expected after which health says so
  int64_t period_us = 5'000;        ///< [us] between looks at the link
  std::string effective;            ///< the whole as YAML, for CONFIG
};

/// Reads the configuration; throws ConfigError with file:line.
InsDriverConfig readInsDriverConfig(ConfigReader& reader);

/// Where the map frame lies on Earth, as text for the Store, and back.
std::string originText(const GeoOrigin& origin);
/// Throws ConfigError if the text is no origin.
GeoOrigin originFrom(const std::string& text);

}  // namespace tread::ins
