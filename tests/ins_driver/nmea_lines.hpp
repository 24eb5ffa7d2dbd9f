// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "modules/ins_driver/nmea/nmea_framer.hpp"

namespace tread::ins {

/// A complete sentence from the text between '$' and '*'.
inline std::string line(const std::string& body) {
  char checksum[8];
  std::snprintf(checksum, sizeof checksum, "*%02X\r\n", nmeaChecksum(body));
  return "$" + body + checksum;
}

/// hhmmss.sss of a time of day [s].
inline std::string hhmmss(double time_of_day) {
  const int64_t ms = std::llround(time_of_day * 1000.0);
  char text[32];
  std::snprintf(text, sizeof text, "%02d%02d%02d.%03d", static_cast<int>(ms / 3600000 % 24),
                static_cast<int>(ms / 60000 % 60), static_cast<int>(ms / 1000 % 60),
                static_cast<int>(ms % 1000));
  return text;
}

/// Start of the tests' vehicle: 42.0955622 N, 88.0340185 W.
inline constexpr double kStartLatitude = 42.0955622;
inline constexpr double kStartLongitude = -88.0340185;

/// A GGA with RTK fix at a small distance east and north of the start [m].
inline std::string gga(double time_of_day, double east = 0.0, double north = 0.0, int quality = 4,
                       double altitude = 221.0) {
  const double latitude = kStartLatitude + north / 111070.0;
  const double longitude = kStartLongitude + east / (111412.0 * std::cos(latitude * M_PI / 180.0));
  const double lat_minutes = (latitude - 42.0) * 60.0;
  const double lon_minutes = (-longitude - 88.0) * 60.0;
  char body[160];
  std::snprintf(body, sizeof body,
                "GPGGA,%s,42%010.7f,N,088%010.7f,W,%d,12,1.0,%.3f,M,-33.0,M,1.0,0138",
                hhmmss(time_of_day).c_str(), lat_minutes, lon_minutes, quality, altitude);
  return line(body);
}

/// Heading clockwise from north, roll right side down, pitch nose up [deg].
inline std::string pashr(double time_of_day, double heading, double roll = 0.0,
                         double pitch = 0.0) {
  char body[160];
  std::snprintf(body, sizeof body, "PASHR,%s,%.3f,T,%+.3f,%+.3f,+0.00,0.100,0.200,0.300,2,1",
                hhmmss(time_of_day).c_str(), heading, roll, pitch);
  return line(body);
}

/// Course clockwise from north [deg], speed [km/h].
inline std::string vtg(double course, double speed_kmh) {
  char body[120];
  std::snprintf(body, sizeof body, "GPVTG,%.2f,T,,M,%.3f,N,%.3f,K,D", course, speed_kmh / 1.852,
                speed_kmh);
  return line(body);
}

/// A recording; nullopt if it is absent.
inline std::optional<std::string> recording(const std::string& path) {
  const char* folder = std::getenv("TREAD_RECORDINGS");
  std::ifstream file(std::string(folder ? folder : TREAD_SOURCE_DIR "/../shared/data") + "/" + path,
                     std::ios::binary);
  if (!file) return std::nullopt;
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

}  // namespace tread::ins
