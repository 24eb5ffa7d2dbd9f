// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/scan_devices.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/link/make_link.hpp"
#include "modules/lidar_driver/carmen/carmen_player.hpp"
#include "modules/lidar_driver/hokuyo/scip_session.hpp"
#include "modules/lidar_driver/rplidar/rplidar_session.hpp"
#include "modules/lidar_driver/sick_cola/cola_session.hpp"
#include "modules/lidar_driver/sick_lms2xx/lms_session.hpp"
#include "modules/lidar_driver/velodyne/velodyne_session.hpp"

namespace tread::lidar {
namespace {

using Kind = LinkAddress::Kind;

/// One kind of range finder.
struct DeviceKind {
  std::vector<Kind> links;  ///< where it can be
  std::string example;      ///< of its address
  void (*read)(ConfigReader& section, double latency, DeviceChoice& choice);
};

template <class Config, class Session, Config (*kRead)(ConfigReader&)>
void session(ConfigReader& section, double latency, DeviceChoice& choice) {
  Config config = kRead(section);
  config.latency = latency;
  choice.make = [config] { return std::make_unique<Session>(config); };
}

void carmen(ConfigReader& section, double /*latency*/, DeviceChoice& choice) {
  const CarmenConfig config = readCarmenConfig(section);
  choice.make = [config] { return std::make_unique<CarmenPlayer>(config); };
}

/// A new range finder needs one line here and a folder of its own.
const std::map<std::string, DeviceKind>& kinds() {
  static const std::map<std::string, DeviceKind> kKinds{
      {"carmen", {{Kind::kFile}, "file:drive.log", carmen}},
      {"hokuyo",
       {{Kind::kTcp, Kind::kTty},
        "tcp:192.168.0.10:10940 or tty:/dev/ttyACM0",
        session<ScipConfig, ScipSession, readScipConfig>}},
      {"rplidar",
       {{Kind::kTty, Kind::kTcp},
        "tty:/dev/ttyUSB0?baud=115200",
        session<RplidarConfig, RplidarSession, readRplidarConfig>}},
      {"sick_cola",
       {{Kind::kTcp}, "tcp:192.168.0.1:2111", session<ColaConfig, ColaSession, readColaConfig>}},
      {"sick_lms2xx",
       {{Kind::kTty, Kind::kTcp},
        "tty:/dev/ttyUSB0?baud=38400",
        session<LmsConfig, LmsSession, readLmsConfig>}},
      {"velodyne",
       {{Kind::kUdp, Kind::kFile},
        "udp:2368 or file:drive.pcap",
        session<VelodyneConfig, VelodyneSession, readVelodyneConfig>}}};
  return kKinds;
}

}  // namespace

DeviceChoice readScanDevice(ConfigReader& reader, double latency) {
  std::vector<std::string> names;
  for (const auto& [name, kind] : kinds()) names.push_back(name);
  DeviceChoice choice;
  reader.choice("device", choice.name, names);
  ConfigReader section = reader.section(choice.name);
  kinds().at(choice.name).read(section, latency, choice);
  return choice;
}

LinkAddress checkDeviceAddress(const std::string& device, const std::string& text) {
  const LinkAddress address = parseLinkAddress(text);
  const DeviceKind& kind = kinds().at(device);
  if (std::find(kind.links.begin(), kind.links.end(), address.kind) == kind.links.end())
    throw std::invalid_argument("'" + text + "' is not an address of a range finder " + device +
                                "; write " + kind.example);
  return address;
}

}  // namespace tread::lidar
