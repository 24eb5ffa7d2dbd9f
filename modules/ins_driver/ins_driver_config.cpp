// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/ins_driver_config.hpp"

#include <iomanip>
#include <sstream>

#include "common/vehicle/robot_file.hpp"
#include "modules/ins_driver/nmea/nmea_ins.hpp"

namespace tread::ins {
namespace {

MakeInsSource nmea(ConfigReader& reader, const RobotDescription& robot) {
  return nmeaSource(readNmeaConfig(reader, robot));
}

/// A new INS is one line here and a folder of its own.
const std::map<std::string, MakeInsSource (*)(ConfigReader&, const RobotDescription&)> kSources{
    {"nmea", nmea}};

constexpr double kDegPerRad = 180.0 / kPi;

GeoOrigin readOrigin(ConfigReader& reader) {
  double latitude = 0.0;
  double longitude = 0.0;
  GeoOrigin origin;
  // Degrees, because this is what people copy from maps and receivers.
  reader.number("latitude", latitude, {-90.0, 90.0}, "deg", true);
  reader.number("longitude", longitude, {-180.0, 180.0}, "deg", true);
  reader.number("altitude", origin.altitude, {-1000.0, 20000.0}, "m", true);
  reader.number("yaw", origin.yaw, {-kPi, kPi}, "rad");
  origin.point = {latitude / kDegPerRad, longitude / kDegPerRad};
  return origin;
}

}  // namespace

MakeInsSource readInsSource(ConfigReader& reader, const RobotDescription& robot) {
  std::vector<std::string> known;
  for (const auto& [name, read] : kSources) known.push_back(name);
  std::string name = "nmea";
  reader.choice("source", name, known);
  return kSources.at(name)(reader, robot);
}

InsDriverConfig readInsDriverConfig(ConfigReader& reader) {
  InsDriverConfig config;
  reader.text("address", config.address);
  reader.text("store", config.store);
  config.make_source = readInsSource(reader, readRobot(reader));
  if (reader.has("origin")) {
    ConfigReader origin = reader.section("origin");
    config.origin = readOrigin(origin);
  }
  reader.number("silence", config.silence, {0.1, 60.0}, "s");
  reader.seconds("period", config.period_us, {0.001, 0.1});
  reader.finish();
  config.effective = reader.effective();
  return config;
}

std::string originText(const GeoOrigin& origin) {
  std::ostringstream text;
  text << std::setprecision(17) << "latitude: " << origin.point.latitude * kDegPerRad
       << "\nlongitude: " << origin.point.longitude * kDegPerRad
       << "\naltitude: " << origin.altitude << "\nyaw: " << origin.yaw << "\n";
  return text.str();
}

GeoOrigin originFrom(const std::string& text) {
  ConfigReader reader = ConfigReader::fromText(text, "stored map origin");
  const GeoOrigin origin = readOrigin(reader);
  reader.finish();
  return origin;
}

}  // namespace tread::ins
