// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/ins_driver_config.hpp"

#include <cmath>
#include <iomanip>
#include <iterator>
#include <sstream>

#include "common/vehicle/robot_file.hpp"

namespace tread::ins {
namespace {

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

void readTiming(ConfigReader& reader, InsConfig& ins) {
  reader.seconds("latency", ins.latency_us, {0.0, 1.0});
  reader.seconds("quiet", ins.quiet_us, {0.001, 0.2});
  reader.seconds("attitude_hold", ins.attitude_hold_us, {0.0, 0.5});
  reader.seconds("offset_window", ins.offset_window_us, {1.0, 600.0});
  double rate = 0.0;
  reader.number("rate", rate, {0.0, 200.0}, "Hz");
  ins.period_us = rate > 0.0 ? std::llround(1e6 / rate) : 0;
}

/// The sentence that ends each epoch; "none" where the order is not known.
void readLastType(ConfigReader& reader, InsConfig& ins) {
  std::string last = "none";
  std::vector<std::string> allowed{"none"};
  allowed.insert(allowed.end(), std::begin(kSentenceNames), std::end(kSentenceNames));
  reader.choice("last_sentence", last, allowed);
  for (size_t i = 0; i < kSentenceTypes; ++i) {
    if (last == kSentenceNames[i]) ins.last_type = i;
  }
}

}  // namespace

InsDriverConfig readInsDriverConfig(ConfigReader& reader) {
  InsDriverConfig config;
  InsConfig& ins = config.ins;
  reader.choice("source", config.source, {"nmea"});
  reader.text("address", config.address);
  reader.text("store", config.store);
  const RobotDescription robot = readRobot(reader);
  ins.p_body_antenna = robot.ins.p_body;
  ins.body_device = robot.ins.angles;
  ins.max_speed = robot.max_speed;
  readTiming(reader, ins);
  readLastType(reader, ins);
  reader.number("standstill_speed", ins.standstill_speed, {0.0, 1.0}, "m/s");
  reader.number("jump_slack", ins.jump_slack, {0.01, 100.0}, "m");
  reader.flag("attitude_epochs", ins.attitude_epochs);
  reader.number("origin_max_hdop", ins.origin_max_hdop, {0.5, 100.0}, "1");
  reader.number("max_distance", ins.max_distance, {100.0, 100000.0}, "m");
  if (reader.has("origin")) {
    ConfigReader origin = reader.section("origin");
    ins.origin = readOrigin(origin);
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
