// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/ins_config.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "modules/ins_driver/nmea/nmea_parser.hpp"
#include "modules/ins_driver/novatel/novatel_message.hpp"
#include "modules/ins_driver/ublox/ublox_ins.hpp"

namespace tread::ins {
namespace {

void readTiming(ConfigReader& reader, InsConfig& ins) {
  reader.seconds("latency", ins.latency_us, {0.0, 1.0});
  reader.seconds("quiet", ins.quiet_us, {0.001, 0.2});
  reader.seconds("attitude_hold", ins.attitude_hold_us, {0.0, 0.5});
  reader.seconds("position_hold", ins.position_hold_us, {0.0, 0.5});
  reader.seconds("offset_window", ins.offset_window_us, {1.0, 600.0});
  double rate = 0.0;
  reader.number("rate", rate, {0.0, 200.0}, "Hz");
  ins.period_us = rate > 0.0 ? std::llround(1e6 / rate) : 0;
}

void readHeadings(ConfigReader& reader, InsConfig& ins) {
  const std::vector<std::string> known{"attitude", "dual_antenna", "course"};
  std::vector<std::string> names{"attitude", "dual_antenna"};
  reader.texts("headings", names);
  ins.headings.clear();
  for (const std::string& name : names) {
    const auto at = std::find(known.begin(), known.end(), name);
    if (at == known.end())
      throw reader.error("headings", "'" + name + "'; allowed attitude, dual_antenna, course");
    const auto source = static_cast<HeadingSource>(at - known.begin());
    if (std::count(ins.headings.begin(), ins.headings.end(), source) > 0)
      throw reader.error("headings", name + " twice; name each source once");
    ins.headings.push_back(source);
  }
  reader.number("course_min_speed", ins.course_min_speed, {0.2, 20.0}, "m/s");
  reader.flag("drives_backward", ins.drives_backward);
}

/// The kind of message that ends each epoch; "none" if the order is unknown.
template <size_t count>
void readLastKind(ConfigReader& reader, const std::string& key, const char* const (&kinds)[count],
                  InsConfig& ins) {
  std::string last = "none";
  std::vector<std::string> allowed{"none"};
  allowed.insert(allowed.end(), std::begin(kinds), std::end(kinds));
  reader.choice(key, last, allowed);
  for (size_t i = 0; i < count; ++i) {
    if (last == kinds[i]) ins.last_type = i;
  }
}

void readOriginStd(ConfigReader& reader, InsConfig& ins) {
  reader.number("origin_max_std", ins.origin_max_std, {0.01, 100.0}, "m");
}

InsConfig readInsConfig(ConfigReader& reader, const RobotDescription& robot) {
  InsConfig ins;
  ins.p_body_antenna = robot.ins.p_body;
  ins.body_device = robot.ins.angles;
  ins.max_speed = robot.max_speed;
  readTiming(reader, ins);
  readHeadings(reader, ins);
  reader.number("standstill_speed", ins.standstill_speed, {0.0, 1.0}, "m/s");
  reader.number("jump_slack", ins.jump_slack, {0.01, 100.0}, "m");
  reader.flag("attitude_epochs", ins.attitude_epochs);
  reader.number("max_distance", ins.max_distance, {100.0, 100000.0}, "m");
  return ins;
}

void readBaseline(ConfigReader& reader, InsConfig& ins) {
  reader.number("baseline_yaw", ins.baseline_yaw, {-kPi, kPi}, "rad");
}

void readGpsConventions(ConfigReader& reader, InsConfig& ins) {
  reader.integer("leap_seconds", ins.leap_seconds, {0.0, 60.0}, "s");
  if (!reader.has("geoid_separation")) return;
  double separation = 0.0;
  reader.number("geoid_separation", separation, {-120.0, 120.0}, "m");
  ins.geoid_separation = separation;
}

}  // namespace

InsConfig readNmeaConfig(ConfigReader& reader, const RobotDescription& robot) {
  InsConfig ins = readInsConfig(reader, robot);
  readLastKind(reader, "last_sentence", kSentenceNames, ins);
  reader.number("origin_max_hdop", ins.origin_max_hdop, {0.5, 100.0}, "1");
  return ins;
}

InsConfig readNovatelConfig(ConfigReader& reader, const RobotDescription& robot) {
  InsConfig ins = readInsConfig(reader, robot);
  readBaseline(reader, ins);
  readOriginStd(reader, ins);
  readGpsConventions(reader, ins);
  readLastKind(reader, "last_message", kNovatelKindNames, ins);
  reader.number("imu_rate", ins.imu_rate, {0.0, 4000.0}, "Hz");
  if (reader.has("antenna")) {
    std::vector<double> antenna;
    reader.numbers("antenna", antenna, 3, {-20.0, 20.0}, "m");
    ins.p_body_gnss = Eigen::Vector3d(antenna[0], antenna[1], antenna[2]);
  }
  return ins;
}

InsConfig readUbloxConfig(ConfigReader& reader, const RobotDescription& robot) {
  InsConfig ins = readInsConfig(reader, robot);
  readBaseline(reader, ins);
  readOriginStd(reader, ins);
  readLastKind(reader, "last_message", kUbxKindNames, ins);
  return ins;
}

InsConfig readSingleMessageConfig(ConfigReader& reader, const RobotDescription& robot) {
  InsConfig ins = readInsConfig(reader, robot);
  readOriginStd(reader, ins);
  readGpsConventions(reader, ins);
  ins.last_type = 0;  // each message is an epoch
  return ins;
}

}  // namespace tread::ins
