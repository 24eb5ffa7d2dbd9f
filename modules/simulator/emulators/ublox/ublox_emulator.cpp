// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/ublox/ublox_emulator.hpp"

#include <cmath>
#include <ctime>

namespace tread::sim {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr int64_t kWeek = int64_t{7} * 86400 * 1000;  // [ms]

uint32_t timeOfWeek(const EarthFix& fix) {
  return static_cast<uint32_t>(fix.gps / 1000 % kWeek);
}

int32_t scaled(double value, double unit) {
  return static_cast<int32_t>(std::llround(value / unit));
}

std::string navPvt(const InsMeasurement& sample, const EarthFix& fix, double geoid, bool valid) {
  const std::time_t seconds = fix.utc / 1'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  Bytes p;
  p.put(timeOfWeek(fix));
  p.put(static_cast<uint16_t>(utc.tm_year + 1900));
  for (const int part : {utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec})
    p.put(static_cast<uint8_t>(part));
  p.put<uint8_t>(7);
  p.put<uint32_t>(20);
  p.put(static_cast<int32_t>(fix.utc % 1'000'000 * 1000));
  p.put<uint8_t>(valid ? 4 : 0);
  p.put<uint8_t>(valid ? 0x83 : 0);
  p.put<uint8_t>(0);
  p.put<uint8_t>(valid ? 16 : 2);
  p.put(scaled(fix.longitude, 1e-7));
  p.put(scaled(fix.latitude, 1e-7));
  p.put(scaled(fix.height, 1e-3));
  p.put(scaled(fix.height - geoid, 1e-3));
  p.put<uint32_t>(14);
  p.put<uint32_t>(20);
  for (const double v : {fix.north, fix.east, -sample.v_body.z()}) p.put(scaled(v, 1e-3));
  p.put(scaled(std::hypot(fix.north, fix.east), 1e-3));
  p.put(scaled(std::atan2(fix.east, fix.north) / kDegree, 1e-5));
  p.put<uint32_t>(30);
  p.put<uint32_t>(50000);
  p.put<uint16_t>(90);
  p.zeros(14);
  return p.str();
}

std::string navAtt(const InsMeasurement& sample, const EarthFix& fix, bool valid) {
  Bytes p;
  p.put(timeOfWeek(fix));
  p.zeros(4);
  p.put(scaled(sample.roll / kDegree, 1e-5));
  p.put(scaled(-sample.pitch / kDegree, 1e-5));
  p.put(scaled(fix.azimuth, 1e-5));
  for (int i = 0; i < 3; ++i) p.put<uint32_t>(valid ? 20000 : 0);
  return p.str();
}

std::string navRelposned(const EarthFix& fix, bool valid) {
  constexpr uint32_t kAllValid = 1U | 1U << 1 | 1U << 2 | 2U << 3 | 1U << 5 | 1U << 8;
  Bytes p;
  p.put<uint8_t>(1);
  p.zeros(3);
  p.put(timeOfWeek(fix));
  p.put(scaled(std::cos(fix.azimuth * kDegree), 1e-2));
  p.put(scaled(std::sin(fix.azimuth * kDegree), 1e-2));
  p.put<int32_t>(0);
  p.put<int32_t>(100);
  p.put(scaled(fix.azimuth, 1e-5));
  p.zeros(8);
  for (int i = 0; i < 4; ++i) p.put<uint32_t>(50);
  p.put<uint32_t>(30000);
  p.zeros(4);
  p.put<uint32_t>(valid ? kAllValid : 1U);
  return p.str();
}

std::string esfIns(const InsMeasurement& sample, const EarthFix& fix) {
  Bytes p;
  p.put<uint32_t>(0x3F01);
  p.zeros(4);
  p.put(timeOfWeek(fix));
  for (const double rate : {sample.rate_body.x(), -sample.rate_body.y(), -sample.rate_body.z()})
    p.put(scaled(rate / kDegree, 1e-3));
  p.zeros(12);
  return p.str();
}

}  // namespace

void UbloxEmulator::sendUbx(uint8_t message_class, uint8_t id, const std::string& payload) {
  Bytes summed;
  summed.put(message_class);
  summed.put(id);
  summed.put(static_cast<uint16_t>(payload.size()));
  summed.append(payload);
  unsigned a = 0;
  unsigned b = 0;
  for (const char c : summed.str()) {
    a = (a + static_cast<uint8_t>(c)) % 256;
    b = (b + a) % 256;
  }
  send("\xB5\x62" + summed.str() + static_cast<char>(a) + static_cast<char>(b));
}

void UbloxEmulator::say(const InsMeasurement& sample, const EarthFix& fix, bool valid) {
  sendUbx(0x10, 0x15, esfIns(sample, fix));
  sendUbx(0x01, 0x07, navPvt(sample, fix, map().geoid_separation, valid));
  sendUbx(0x01, 0x05, navAtt(sample, fix, valid));
  sendUbx(0x01, 0x3C, navRelposned(fix, valid));
}

}  // namespace tread::sim
