// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/sick_lms2xx/lms_session.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::lidar {
namespace {

constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;
constexpr int64_t kPatience = 1'000'000;  // [us]: a new variant takes the scanner half a second
constexpr size_t kLongest = 812;          // of a payload: 401 values and the fields around them
constexpr double kTurnsPerSecond = 75.0;
constexpr double kRangeMin = 0.05;  // [m] nearer is the window
/// The topmost values below the largest are codes: dazzled, no echo, too far.
constexpr uint32_t kWords = 8;

unsigned byteAt(std::string_view bytes, size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}

uint32_t wordAt(std::string_view bytes, size_t at) {
  return byteAt(bytes, at) | byteAt(bytes, at + 1) << 8;
}

std::string command(std::initializer_list<int> bytes) {
  std::string text;
  for (const int byte : bytes) text += static_cast<char>(byte);
  return lmsFrame(text);
}

std::vector<StartUpStep> startUp(const LmsConfig& config) {
  const int hundredths = static_cast<int>(std::lround(100.0 * config.resolution));
  return {{"stream off", command({0x20, 0x25})},
          {"configuration", command({0x74})},
          {"variant", command({0x3B, 180, 0, hundredths, 0}), true},
          {"stream on", command({0x20, 0x24})}};
}

/// First byte of the answer to a step.
unsigned answerTo(const std::string& step) {
  if (step == "configuration") return 0xF4;
  return step == "variant" ? 0xBB : 0xA0;
}

/// Field of view and resolution by the number of values, which differs for each variant.
bool geometryOf(uint32_t values, RangeScan& scan) {
  struct Variant {
    uint32_t values;
    double field, step;  // [deg]
  };
  for (const Variant& variant :
       {Variant{181, 180, 1.0}, Variant{361, 180, 0.5}, Variant{101, 100, 1.0},
        Variant{201, 100, 0.5}, Variant{401, 100, 0.25}})
    if (variant.values == values) {
      scan.angle_first = -0.5 * variant.field * kRadPerDeg;
      scan.angle_step = variant.step * kRadPerDeg;
      // Finer beams are measured over several revolutions, each between those of the last.
      scan.duration_us = std::llround(1e6 / kTurnsPerSecond * (1.0 / variant.step - 1.0 + 0.5));
      return true;
    }
  return false;
}

}  // namespace

uint16_t lmsChecksum(std::string_view bytes) {
  uint32_t sum = 0;
  uint32_t before = 0;
  for (const char byte : bytes) {
    const uint32_t now = static_cast<unsigned char>(byte);
    sum = (sum & 0x8000) ? ((sum << 1) ^ 0x8005) & 0xffff : sum << 1;
    sum ^= before << 8 | now;
    before = now;
  }
  return static_cast<uint16_t>(sum);
}

std::string lmsFrame(std::string_view command) {
  std::string frame("\x02\x00", 2);
  frame += static_cast<char>(command.size() & 0xff);
  frame += static_cast<char>(command.size() >> 8);
  frame.append(command);
  const uint16_t sum = lmsChecksum(frame);
  frame += static_cast<char>(sum & 0xff);
  return frame += static_cast<char>(sum >> 8);
}

LmsConfig readLmsConfig(ConfigReader& reader) {
  LmsConfig config;
  reader.number("resolution", config.resolution, {0.5, 1.0}, "deg");
  if (config.resolution != 0.5 && config.resolution != 1.0)
    throw reader.error("resolution", "the scanner has 0.5 and 1 deg");
  return config;
}

LmsSession::LmsSession(const LmsConfig& config)
    : StartedDevice(startUp(config), kPatience), config_(config) {}

void LmsSession::forget() {
  buffer_.clear();
  range_bits_.reset();
}

void LmsSession::receive(std::string_view bytes, int64_t now) {
  while (!bytes.empty()) {
    if (buffer_.size() < 4) frame_began_ = now;  // a lone byte may be old noise
    const size_t piece = std::min<size_t>(bytes.size(), 2048);
    buffer_.append(bytes.substr(0, piece));
    bytes.remove_prefix(piece);
    for (std::string payload; cutFrame(payload, now); frame_began_ = now) takeFrame(payload, now);
  }
}

bool LmsSession::cutFrame(std::string& payload, int64_t now) {
  for (;;) {
    size_t at = std::min(buffer_.find("\x02\x80"), buffer_.size());
    if (at == buffer_.size() && at > 0 && buffer_.back() == 0x02) --at;
    skip(at, now);
    if (buffer_.size() < 4) return false;
    const uint32_t length = wordAt(buffer_, 2);
    if (length >= 2 && length <= kLongest) {
      if (buffer_.size() < length + 6) return false;
      const std::string_view frame = std::string_view(buffer_).substr(0, length + 4);
      if (lmsChecksum(frame) == wordAt(buffer_, length + 4)) {
        payload = frame.substr(4);
        buffer_.erase(0, length + 6);
        return true;
      }
      refuse("wrong checksums", now, "check the line and its ground");
    }
    skip(1, now);
  }
}

/// The bytes after skipped ones have only just arrived, or shortly before.
void LmsSession::skip(size_t bytes, int64_t now) {
  if (bytes == 0) return;
  skipUnreadable("bytes outside of frames", now,
                 "check baud rate and line; is this a SICK LMS 2xx?", static_cast<int64_t>(bytes));
  buffer_.erase(0, bytes);
  frame_began_ = now;
}

void LmsSession::takeFrame(std::string_view payload, int64_t now) {
  const unsigned kind = byteAt(payload, 0);
  if (kind == 0xB0) {
    // A scan from a stream that is being switched off may be old.
    if (streaming()) return takeScan(payload, now);
    return count("scans before the start");
  }
  const std::string& name = awaited().name;
  if (name.empty() || kind != answerTo(name)) return count("unexpected telegrams");
  if (name == "configuration") return takeConfiguration(payload, now);
  const bool done = name == "variant" ? byteAt(payload, 1) == 1 : byteAt(payload, 1) == 0;
  if (done) return answered(now);
  refused(name, now);
}

void LmsSession::takeConfiguration(std::string_view payload, int64_t now) {
  if (payload.size() < 8) return refuse("refused: configurations cut short", now);
  const unsigned mode = byteAt(payload, 5);
  if (mode <= 2) range_bits_ = 13;
  if (mode == 3 || mode == 4) range_bits_ = 14;
  if (mode == 5 || mode == 6) range_bits_ = 15;
  if (mode == 15) range_bits_ = 16;
  if (!range_bits_) return refused("ranges: its measuring mode is that of intensities", now);
  answered(now);
}

void LmsSession::takeScan(std::string_view payload, int64_t now) {
  RangeScan scan;
  const std::string problem = convert(payload, scan);
  if (!problem.empty()) return refuse("refused: " + problem, now);
  count("telegrams");
  scan.utime = frame_began_ - std::llround(1e6 * config_.latency) - scan.duration_us;
  deliver(std::move(scan), now);
}

std::string LmsSession::convert(std::string_view payload, RangeScan& scan) const {
  if (payload.size() < 4) return "a telegram cut short";
  const uint32_t head = wordAt(payload, 1);
  const uint32_t values = head & 0x1ff;
  if (head & 0x3e00) return "a part of a scan";
  if (payload.size() != 4 + 2 * values) return "another number of values than stated";
  if (!geometryOf(values, scan)) return "a number of values that no variant has";
  if (head >> 14 > 1) return "a unit that is neither cm nor mm";
  if ((byteAt(payload, payload.size() - 1) & 7) > 2) return "the device reports an error";
  const double unit = head >> 14 == 1 ? 0.001 : 0.01;
  const uint32_t largest = (1U << *range_bits_) - 1;
  scan.range_min = kRangeMin;
  scan.range_max = unit * (largest - kWords);
  for (uint32_t i = 0; i < values; ++i) {
    const uint32_t value = wordAt(payload, 3 + 2 * i) & largest;
    scan.ranges.push_back(value > largest - kWords ? std::numeric_limits<float>::quiet_NaN()
                                                   : static_cast<float>(unit * value));
  }
  return {};
}

}  // namespace tread::lidar
