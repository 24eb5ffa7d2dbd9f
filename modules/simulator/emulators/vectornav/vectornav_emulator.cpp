// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/vectornav/vectornav_emulator.hpp"

#include <algorithm>
#include <cmath>

namespace tread::sim {
namespace {

constexpr double kDegree = kPi / 180.0;

/// CRC16 of the manual, byte by byte without a table.
uint16_t crc16Of(std::string_view bytes) {
  uint16_t crc = 0;
  for (const char c : bytes) {
    crc = static_cast<uint16_t>(crc >> 8 | crc << 8);
    crc = static_cast<uint16_t>(crc ^ static_cast<uint8_t>(c));
    crc = static_cast<uint16_t>(crc ^ (crc & 0xFF) >> 4);
    crc = static_cast<uint16_t>(crc ^ crc << 12);
    crc = static_cast<uint16_t>(crc ^ (crc & 0xFF) << 5);
  }
  return crc;
}

}  // namespace

void VectornavEmulator::say(const InsMeasurement& sample, const EarthFix& fix, bool valid) {
  Bytes m;
  m.put<uint8_t>(0xFA);
  m.put<uint8_t>(0x01 | 0x10 | 0x20);         // common, attitude, INS
  m.put<uint16_t>(0x0001 | 0x0002 | 0x0020);  // TimeStartup, TimeGps, AngularRate
  m.put<uint16_t>(0x0002 | 0x0100);           // Ypr, YprU
  m.put<uint16_t>(0x0001 | 0x0002 | 0x0010 | 0x0200 |
                  0x0400);  // InsStatus, PosLla, VelNed, PosU, VelU
  m.put(static_cast<uint64_t>((sample.utime - std::max<int64_t>(started(), 0)) * 1000));
  m.put(static_cast<uint64_t>(fix.gps * 1000));
  for (const double rate : {sample.rate_body.x(), -sample.rate_body.y(), -sample.rate_body.z()})
    m.put(static_cast<float>(rate));
  const double yaw = fix.azimuth > 180.0 ? fix.azimuth - 360.0 : fix.azimuth;
  for (const double angle : {yaw, -sample.pitch / kDegree, sample.roll / kDegree})
    m.put(static_cast<float>(angle));
  for (const float std : {0.2F, 0.1F, 0.1F}) m.put(std);
  m.put<uint16_t>(valid ? 0x0006 : 0x0000);
  for (const double place : {fix.latitude, fix.longitude, fix.height}) m.put(valid ? place : 0.0);
  for (const double v : {fix.north, fix.east, -sample.v_body.z()})
    m.put(static_cast<float>(valid ? v : 0.0));
  m.put(0.02F);
  m.put(0.03F);
  const uint16_t crc = crc16Of(std::string_view(m.str()).substr(1));
  m.put(static_cast<uint8_t>(crc >> 8));
  m.put(static_cast<uint8_t>(crc));
  send(m.str());
}

}  // namespace tread::sim
