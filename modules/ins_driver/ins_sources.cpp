// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/ins_sources.hpp"

#include "modules/ins_driver/nmea/nmea_ins.hpp"

namespace tread::ins {
namespace {

MakeInsSource nmea(ConfigReader& reader, const RobotDescription& robot) {
  return nmeaSource(readNmeaConfig(reader, robot));
}

/// A new INS is one line here and a folder of its own.
const std::map<std::string, MakeInsSource (*)(ConfigReader&, const RobotDescription&)> kSources{
    {"nmea", nmea}};

}  // namespace

MakeInsSource readInsSource(ConfigReader& reader, const RobotDescription& robot) {
  std::vector<std::string> known;
  for (const auto& [name, read] : kSources) known.push_back(name);
  std::string name = "nmea";
  reader.choice("source", name, known);
  return kSources.at(name)(reader, robot);
}

}  // namespace tread::ins
