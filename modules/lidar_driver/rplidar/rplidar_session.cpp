// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/rplidar/rplidar_session.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::lidar {
namespace {

constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;
constexpr int64_t kPatience = 200'000;  // [us]
constexpr double kRangeMin = 0.15;      // [m]
constexpr double kCover = 350.0;        // [deg] minimum of a revolution
/// [deg] by which an angle may fall behind the largest before. Source: Slamtec's public SDK
/// corrects the angles of its express modes by -8 degrees at far ranges, by 1 degree at the
/// nearest; those without echo not at all.
constexpr double kBackwards = 12.0;
constexpr double kMostAhead = 15.0;      // [deg] largest step between samples
constexpr size_t kMostSamples = 10'000;  // of a turn
constexpr size_t kDescriptor = 7;
constexpr const char* kWhichLine = "check baud rate and line; is this an RPLIDAR?";
constexpr const char* kTurns = "check that it turns freely, its supply, cable and baud rate";
constexpr size_t kSample = 5;

std::vector<StartUpStep> startUp() {
  return {{"stop", "\xA5\x25", false, true},
          {"health", "\xA5\x52"},
          // 660 of 1023: the motor's usual speed; models whose plug drives it ignore this.
          {"motor", std::string("\xA5\xF0\x02\x94\x02\xC1", 6), false, true},
          {"scan", "\xA5\x20"}};
}

unsigned byteAt(const std::string& bytes, size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}

/// Start, length and kind of an answer. Longer answers are never requested.
const std::string kHealth("\xA5\x5A\x03\x00\x00\x00\x06", kDescriptor);
const std::string kScan("\xA5\x5A\x05\x00\x00\x40\x81", kDescriptor);

}  // namespace

RplidarConfig readRplidarConfig(ConfigReader& reader) {
  RplidarConfig config;
  reader.number("step", config.step, {0.5, 1.0}, "deg");
  if (config.step != 0.5 && config.step != 1.0)
    throw reader.error("step", "samples are sorted into 0.5 or 1 deg");
  reader.number("range_max", config.range_max, {1.0, 100.0}, "m");
  return config;
}

RplidarSession::RplidarSession(const RplidarConfig& config)
    : StartedDevice(startUp(), kPatience), config_(config) {}

void RplidarSession::forget() {
  buffer_.clear();
  in_turn_ = false;
}

void RplidarSession::receive(std::string_view bytes, int64_t now) {
  for (const char byte : bytes) {
    buffer_ += byte;
    while (streaming() ? takeSample(now) : takeAnswer(now)) {
    }
  }
}

bool RplidarSession::takeAnswer(int64_t now) {
  const std::string& name = awaited().name;
  const std::string& expected = name == "health" ? kHealth : kScan;
  const bool waits = name == "health" || name == "scan";
  // Skips bytes in transit from an earlier stream, and the banner after a reboot.
  const size_t length = std::min(buffer_.size(), kDescriptor);
  if (!waits || buffer_.compare(0, length, expected, 0, length) != 0) {
    buffer_.erase(0, 1);
    skipUnreadable("bytes outside of answers", now, kWhichLine, 1);
    return !buffer_.empty();
  }
  const size_t whole = name == "health" ? kDescriptor + 3 : kDescriptor;
  if (buffer_.size() < whole) return false;
  const bool broken = name == "health" && byteAt(buffer_, kDescriptor) == 2;
  buffer_.erase(0, whole);
  if (broken)
    refused("work: its health is error; unplug it and plug it in", now);
  else
    answered(now);
  return true;
}

bool RplidarSession::takeSample(int64_t now) {
  if (buffer_.size() < kSample) return false;
  const unsigned head = byteAt(buffer_, 0);
  const unsigned angle = byteAt(buffer_, 1) >> 1 | byteAt(buffer_, 2) << 7;
  const bool start = (head & 1) != 0;
  const bool inverse = (head & 2) != 0;
  if (start == inverse || (byteAt(buffer_, 1) & 1) == 0 || angle >= (360 + kBackwards) * 64) {
    spoilTurn("samples with wrong check bits", now);
    buffer_.erase(0, 1);
    return true;
  }
  const unsigned range = byteAt(buffer_, 3) | byteAt(buffer_, 4) << 8;
  buffer_.erase(0, kSample);
  add({start, angle / 64.0, range / 4000.0}, now);
  return true;
}

void RplidarSession::add(const Sample& sample, int64_t now) {
  if (sample.start) {
    if (in_turn_) finishTurn(now);
    if (sample.angle > kMostAhead && sample.angle < 360.0 - kBackwards)
      return refuse("refused: start flags away from ahead", now, kTurns);
    in_turn_ = true;
    turn_began_ = now;
    samples_ = 0;
    // A revolution may begin just before the forward direction.
    last_angle_ = sample.angle > 180.0 ? sample.angle - 360.0 : sample.angle;
    echoes_.clear();
  }
  if (!in_turn_) return;
  const double angle = sample.angle - 360.0 * std::round((sample.angle - last_angle_) / 360.0);
  if (angle < last_angle_ - kBackwards || angle > last_angle_ + kMostAhead ||
      ++samples_ > kMostSamples)
    return spoilTurn("revolutions with discontinuous angles", now);
  last_angle_ = std::max(last_angle_, angle);
  if (sample.range > 0.0) echoes_.push_back({false, angle, sample.range});
}

/// Sorts the echoes into beams starting at the first one's angle, so that a beam's index gives its
/// time.
void RplidarSession::sortEchoes(RangeScan& scan) const {
  const auto beams = std::lround(360.0 / config_.step);
  const auto stepOf = [&](const Sample& echo) { return std::lround(echo.angle / config_.step); };
  long first = 0;
  for (const Sample& echo : echoes_) first = std::min(first, stepOf(echo));
  scan.ranges.assign(static_cast<size_t>(beams), std::numeric_limits<float>::quiet_NaN());
  for (const Sample& echo : echoes_) {
    float& nearest = scan.ranges[static_cast<size_t>((stepOf(echo) - first) % beams)];
    const auto range = static_cast<float>(echo.range);
    if (!(nearest <= range)) nearest = range;
  }
  // Clockwise; the last beam is one step before the first.
  scan.angle_first = -static_cast<double>(first) * config_.step * kRadPerDeg;
  scan.angle_step = -config_.step * kRadPerDeg;
}

void RplidarSession::finishTurn(int64_t now) {
  const int64_t duration = now - turn_began_;
  if (last_angle_ < kCover) return spoilTurn("incomplete revolutions", now);
  if (duration > 1'000'000) return spoilTurn("turns of more than 1 s", now);
  RangeScan scan;
  sortEchoes(scan);
  scan.duration_us = std::llround(static_cast<double>(duration) * (1.0 - config_.step / 360.0));
  scan.utime = turn_began_ - std::llround(1e6 * config_.latency);
  scan.range_min = kRangeMin;
  scan.range_max = config_.range_max;
  count("turns");
  deliver(std::move(scan), now);
}

void RplidarSession::spoilTurn(const std::string& why, int64_t now) {
  if (in_turn_)
    refuse("refused: " + why, now, kTurns);
  else
    skipUnreadable("bytes outside of turns", now, kWhichLine, 1);
  in_turn_ = false;
}

}  // namespace tread::lidar
