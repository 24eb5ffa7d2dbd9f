// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/sick_cola/cola_telegram.hpp"

#include <charconv>
#include <cmath>
#include <cstring>

namespace tread::lidar {
namespace {

constexpr double kTurn = 6.28318530717958647692;
constexpr double kRadPerDigit = kTurn / 3'600'000.0;  // angles come in 1/10000 degree
constexpr uint32_t kMostBeams = 4000;
constexpr uint32_t kMostChannels = 5;

/// Extracts consecutive fields in either dialect; ok() becomes false at the first bad one.
class ColaFields {
 public:
  ColaFields(ColaDialect dialect, std::string_view fields) : dialect_(dialect), rest_(fields) {}

  /// An unsigned number of this many bits.
  uint32_t number(int bits) {
    return dialect_ == ColaDialect::kA ? hexadecimal(bits) : bigEndian(bits / 8);
  }
  int32_t signedNumber() { return static_cast<int32_t>(number(32)); }
  double real() {
    const uint32_t bits = number(32);
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) ok_ = false;
    return static_cast<double>(value);
  }
  /// A channel's name: five characters in the binary dialect.
  std::string_view name() {
    if (dialect_ == ColaDialect::kA) return word();
    return cut(5);
  }
  void skip(int bits, uint32_t times) {
    for (uint32_t i = 0; i < times && ok_; ++i) number(bits);
  }
  bool ok() const { return ok_; }

 private:
  std::string_view cut(size_t bytes) {
    if (rest_.size() < bytes) {
      ok_ = false;
      bytes = rest_.size();
    }
    const std::string_view taken = rest_.substr(0, bytes);
    rest_.remove_prefix(bytes);
    return taken;
  }
  std::string_view word() {
    const std::string_view taken = cut(std::min(rest_.find(' '), rest_.size()));
    if (!rest_.empty()) rest_.remove_prefix(1);
    if (taken.empty()) ok_ = false;
    return taken;
  }
  uint32_t hexadecimal(int bits) {
    const std::string_view digits = word();
    uint32_t value = 0;
    const char* end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, value, 16);
    const bool fits = result.ec == std::errc() && result.ptr == end && digits.size() <= 8 &&
                      (bits == 32 || value >> bits == 0);
    if (!fits) ok_ = false;
    return fits ? value : 0;
  }
  uint32_t bigEndian(int bytes) {
    uint32_t value = 0;
    for (const char byte : cut(static_cast<size_t>(bytes)))
      value = value << 8 | static_cast<unsigned char>(byte);
    return ok_ ? value : 0;
  }

  ColaDialect dialect_;
  std::string_view rest_;
  bool ok_ = true;
};

void readHead(ColaFields& fields, ColaScan& scan) {
  fields.skip(16, 2);  // version, device number
  fields.skip(32, 1);  // serial number
  scan.device_status = static_cast<uint16_t>(fields.number(8) << 8);
  scan.device_status = static_cast<uint16_t>(scan.device_status | fields.number(8));
  scan.telegram_counter = static_cast<uint16_t>(fields.number(16));
  fields.skip(16, 1);  // scan counter
  scan.started_us = fields.number(32);
  scan.sent_us = fields.number(32);
  fields.skip(8, 4);  // digital inputs and outputs
  scan.layer = static_cast<uint16_t>(fields.number(16));
  scan.scan_frequency = fields.number(32) / 100.0;
  fields.skip(32, 1);  // measuring frequency
  const uint32_t encoders = fields.number(16);
  for (uint32_t i = 0; i < encoders && fields.ok(); ++i) {
    fields.skip(32, 1);
    fields.skip(16, 1);
  }
}

/// Reads one channel of 8 or 16 bit values; true if it was the ranges.
bool readChannel(ColaFields& fields, int bits, ColaScan& scan) {
  const bool ranges = fields.name() == "DIST1" && bits == 16;
  const double scale = fields.real();
  const double offset = fields.real();
  const int32_t first = fields.signedNumber();
  const uint32_t step = fields.number(16);
  const uint32_t count = fields.number(16);
  if (!ranges || count > kMostBeams) {
    fields.skip(bits, count);
    return false;
  }
  scan.scale = scale;
  scan.angle_first = first * kRadPerDigit;
  scan.angle_step = step * kRadPerDigit;
  scan.ranges.clear();
  for (uint32_t i = 0; i < count && fields.ok(); ++i) {
    const uint32_t value = fields.number(16);
    scan.ranges.push_back(value == 0 ? 0.0F : static_cast<float>(0.001 * (value * scale + offset)));
  }
  return true;
}

/// False if there is no channel of ranges, or more than one.
bool readChannels(ColaFields& fields, ColaScan& scan) {
  int of_ranges = 0;
  for (const int bits : {16, 8}) {
    const uint32_t channels = fields.number(16);
    if (channels > kMostChannels) return false;
    for (uint32_t i = 0; i < channels && fields.ok(); ++i)
      of_ranges += readChannel(fields, bits, scan);
  }
  return of_ranges == 1;
}

std::string implausible(const ColaScan& scan) {
  if (scan.ranges.size() < 2) return "fewer than two beams";
  const double sweep = scan.angle_step * static_cast<double>(scan.ranges.size() - 1);
  if (scan.angle_step <= 0.0 || sweep > kTurn || std::abs(scan.angle_first) > kTurn)
    return "angles that are none of a scanner";
  if (scan.scale < 0.1 || scan.scale > 100.0) return "scale factor outside 0.1..100 mm";
  if (scan.scan_frequency < 1.0 || scan.scan_frequency > 200.0)
    return "scan frequency outside 1..200 Hz";
  if (scan.layer != 0) return "a layer outside of the scan plane";
  return {};
}

}  // namespace

ColaScan parseColaScan(ColaDialect dialect, std::string_view bytes, std::string& problem) {
  ColaFields fields(dialect, bytes);
  ColaScan scan;
  readHead(fields, scan);
  const bool channels = readChannels(fields, scan);
  // Position, name and comment follow: a telegram without them was truncated.
  fields.skip(16, 3);
  if (!fields.ok())
    problem = "a field is missing or no number";
  else if (!channels)
    problem = "no channel DIST1 of 16 bits";
  else
    problem = implausible(scan);
  return scan;
}

}  // namespace tread::lidar
