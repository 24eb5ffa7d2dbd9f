// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/omni_wheels_file.hpp"

#include <cmath>

#include "common/config/config_reader.hpp"
#include "common/geometry/degrees.hpp"

namespace tread {
namespace {

constexpr Range kDegrees{-360.0, 360.0};
constexpr Range kPlace{-10.0, 10.0};  // [m]

/// Wheels are never within a few degrees of each other, but in radians they would all be.
constexpr double kFullTurn = 6.3;

OmniWheel readWheel(ConfigReader& reader, double& angle) {
  OmniWheel wheel;
  if (reader.has("angle") == reader.has("position"))
    throw reader.error(reader.has("angle") ? "position" : "angle",
                       "a wheel's place is an angle [deg] and a distance [m], or a position [x, y] "
                       "[m]: give one of them");
  if (reader.has("angle")) {
    double distance = 0.0;
    reader.number("angle", angle, kDegrees, "deg, from ahead to the left", true);
    reader.number("distance", distance, {0.02, 10.0}, "m, from the body's origin", true);
    wheel.x = distance * std::cos(toRadians(angle));
    wheel.y = distance * std::sin(toRadians(angle));
    wheel.heading = toRadians(angle + 90.0);
  } else {
    std::vector<double> position;
    reader.numbers("position", position, 2, kPlace, "m", true);
    wheel.x = position[0];
    wheel.y = position[1];
  }
  double heading = toDegrees(wheel.heading), rollers = 0.0;
  reader.number("heading", heading, {-720.0, 720.0}, "deg, from ahead to the left");
  reader.number("rollers", rollers, {-75.0, 75.0}, "deg, from the heading");
  wheel.heading = toRadians(heading);
  wheel.rollers = toRadians(rollers);
  return wheel;
}

}  // namespace

OmniWheels readOmniWheels(ConfigReader& reader, std::vector<bool>* inverted) {
  std::vector<OmniWheel> wheels;
  double widest = 0.0;
  for (ConfigReader& section : reader.sections("wheels", true)) {
    double angle = 0.0;
    wheels.push_back(readWheel(section, angle));
    widest = std::max(widest, std::abs(angle));
    if (inverted == nullptr) continue;
    bool invert = false;
    section.flag("invert", invert);
    inverted->push_back(invert);
  }
  std::string why;
  const std::optional<OmniWheels> omni = OmniWheels::make(wheels, why);
  if (omni) return *omni;
  if (wheels.size() >= 3 && widest > 0.0 && widest < kFullTurn)
    why += "; angles are in degrees, these look like radians";
  throw reader.error("wheels", why);
}

}  // namespace tread
