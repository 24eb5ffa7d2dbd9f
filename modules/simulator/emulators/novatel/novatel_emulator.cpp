// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/novatel/novatel_emulator.hpp"

#include <cmath>

namespace tread::sim {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr int64_t kWeek = int64_t{7} * 86400 * 1000;  // [ms]
constexpr double kSamples = 200.0;                    // of the IMU per second

uint32_t crc32Of(const std::string& bytes) {
  uint32_t crc = 0;
  for (const char c : bytes) {
    crc ^= static_cast<uint8_t>(c);
    for (int i = 0; i < 8; ++i) crc = (crc & 1) != 0 ? (crc >> 1) ^ 0xEDB88320U : crc >> 1;
  }
  return crc;
}

std::string withCrc(const Bytes& header, const std::string& body) {
  Bytes whole;
  whole.append(header.str());
  whole.append(body);
  whole.put(crc32Of(whole.str()));
  return whole.str();
}

std::string bestpos(const EarthFix& fix, double geoid, bool valid) {
  Bytes body;
  body.put<uint32_t>(valid ? 0 : 1);   // computed, insufficient observations
  body.put<uint32_t>(valid ? 50 : 0);  // NARROW_INT, NONE
  body.put(fix.latitude);
  body.put(fix.longitude);
  body.put(fix.height - geoid);
  body.put(static_cast<float>(geoid));
  body.put<uint32_t>(61);  // WGS84
  for (const float std : {0.01F, 0.012F, 0.02F}) body.put(std);
  body.append("0001");
  body.put(1.0F);
  body.put(0.0F);
  body.put<uint8_t>(18);
  body.put<uint8_t>(14);
  body.zeros(6);
  return body.str();
}

std::string inspvax(const InsMeasurement& sample, const EarthFix& fix, double geoid, bool valid) {
  Bytes body;
  body.put<uint32_t>(valid ? 3 : 1);   // INS_SOLUTION_GOOD, INS_ALIGNING
  body.put<uint32_t>(valid ? 56 : 0);  // INS_RTKFIXED
  body.put(fix.latitude);
  body.put(fix.longitude);
  body.put(fix.height - geoid);
  body.put(static_cast<float>(geoid));
  for (const double v : {fix.north, fix.east, sample.v_body.z()}) body.put(v);
  body.put(sample.roll / kDegree);
  body.put(-sample.pitch / kDegree);
  body.put(fix.azimuth);
  for (const float std : {0.01F, 0.012F, 0.02F, 0.01F, 0.01F, 0.02F, 0.02F, 0.02F, 0.1F})
    body.put(std);
  body.put<uint32_t>(0);
  body.put<uint16_t>(0);
  return body.str();
}

std::string corrimudata(const InsMeasurement& sample, const EarthFix& fix) {
  Bytes body;
  const int64_t ms = fix.gps / 1000;
  body.put(static_cast<uint32_t>(ms / kWeek));
  body.put(static_cast<double>(ms % kWeek) * 1e-3);
  body.put(-sample.rate_body.y() / kSamples);
  body.put(sample.rate_body.x() / kSamples);
  body.put(sample.rate_body.z() / kSamples);
  body.zeros(24);
  return body.str();
}

}  // namespace

void NovatelEmulator::sendLong(uint16_t id, const EarthFix& fix, const std::string& body) {
  const int64_t ms = fix.gps / 1000;
  Bytes header;
  header.append(std::string_view("\xAA\x44\x12\x1C", 4));
  header.put(id);
  header.put<uint8_t>(0);
  header.put<uint8_t>(0x20);
  header.put(static_cast<uint16_t>(body.size()));
  header.put<uint16_t>(0);
  header.put<uint8_t>(120);
  header.put<uint8_t>(180);  // FINESTEERING
  header.put(static_cast<uint16_t>(ms / kWeek));
  header.put(static_cast<uint32_t>(ms % kWeek));
  header.zeros(8);
  send(withCrc(header, body));
}

void NovatelEmulator::sendShort(uint16_t id, const EarthFix& fix, const std::string& body) {
  const int64_t ms = fix.gps / 1000;
  Bytes header;
  header.append(std::string_view("\xAA\x44\x13", 3));
  header.put(static_cast<uint8_t>(body.size()));
  header.put(id);
  header.put(static_cast<uint16_t>(ms / kWeek));
  header.put(static_cast<uint32_t>(ms % kWeek));
  send(withCrc(header, body));
}

void NovatelEmulator::say(const InsMeasurement& sample, const EarthFix& fix, bool valid) {
  const double geoid = map().geoid_separation;
  sendLong(42, fix, bestpos(fix, geoid, valid));
  if (valid) sendShort(813, fix, corrimudata(sample, fix));
  sendLong(1465, fix, inspvax(sample, fix, geoid, valid));
}

}  // namespace tread::sim
