// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/carmen/carmen_player.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace tread::lidar {
namespace {

constexpr size_t kMostBeams = 4000;
constexpr size_t kLongestLine = 100'000;
constexpr double kLongestPause = 5.0;  // [s]
constexpr const char* kWhichFile =
    "is this a CARMEN log? Its scans are lines of FLASER or ROBOTLASER1";

/// Ranges after their number; false if one is missing or no number.
bool readRanges(std::istream& words, std::vector<float>& ranges) {
  size_t count = 0;
  if (!(words >> count) || count < 2 || count > kMostBeams) return false;
  ranges.resize(count);
  for (float& range : ranges)
    if (!(words >> range) || !std::isfinite(range)) return false;
  return true;
}

/// The last word of a line as a time.
std::optional<double> loggedAt(const std::string& line) {
  const size_t end = line.find_last_not_of(" \r\t");
  if (end == std::string::npos) return std::nullopt;
  const size_t begin = line.find_last_of(" \t", end);
  const std::string word = line.substr(begin + 1, end - begin);
  char* stop = nullptr;
  const double time = std::strtod(word.c_str(), &stop);
  const bool good = *stop == '\0' && std::isfinite(time) && time >= 0.0 && time < 1e10;
  return good ? std::optional(time) : std::nullopt;
}

bool readNumber(std::istream& words, double& value) {
  return (words >> value) && std::isfinite(value);
}

bool skipNumbers(std::istream& words, size_t count) {
  double value = 0.0;
  for (size_t i = 0; i < count; ++i)
    if (!readNumber(words, value)) return false;
  return true;
}

/// Laser and robot follow the ranges, x, y and heading of each: a line without them was truncated.
bool readPoses(std::istream& words, Pose2& laser) {
  return readNumber(words, laser.x) && readNumber(words, laser.y) && readNumber(words, laser.yaw) &&
         skipNumbers(words, 3);
}

bool readFlaser(std::istream& words, CarmenScan& read) {
  RangeScan& scan = read.scan;
  if (!readRanges(words, scan.ranges) || !readPoses(words, read.T_map_laser)) return false;
  const size_t count = scan.ranges.size();
  // 181 beams end on both sides, 180 omit the last one.
  scan.angle_first = -kPi / 2.0;
  scan.angle_step = kPi / static_cast<double>(count % 2 == 1 ? count - 1 : count);
  return true;
}

bool readRobotLaser(std::istream& words, CarmenScan& read) {
  RangeScan& scan = read.scan;
  double type = 0.0, field = 0.0, accuracy = 0.0, remission_mode = 0.0;
  if (!(words >> type >> scan.angle_first >> field >> scan.angle_step >> scan.range_max >>
        accuracy >> remission_mode))
    return false;
  std::vector<float> remissions;
  if (!readRanges(words, scan.ranges)) return false;
  size_t count = 0;
  if (!(words >> count) || count > kMostBeams) return false;
  if (!skipNumbers(words, count) || !readPoses(words, read.T_map_laser)) return false;
  const double sweep = scan.angle_step * static_cast<double>(scan.ranges.size() - 1);
  return std::abs(scan.angle_first) <= 2 * kPi && scan.angle_step > 0.0 && sweep <= 2 * kPi &&
         scan.range_max > 0.0;
}

}  // namespace

CarmenScan parseCarmenLine(const std::string& line, std::string& problem) {
  CarmenScan result;
  std::istringstream words(line);
  std::string keyword;
  words >> keyword;
  const bool flaser = keyword == "FLASER";
  if (!flaser && keyword != "ROBOTLASER1") {
    problem = kOtherCarmenLine;
    return result;
  }
  const bool good = flaser ? readFlaser(words, result) : readRobotLaser(words, result);
  problem = good ? "" : "lines of a scan that are damaged";
  result.logged = loggedAt(line);
  return result;
}

CarmenConfig readCarmenConfig(ConfigReader& reader) {
  CarmenConfig config;
  reader.number("rate", config.rate, {0.1, 100.0}, "Hz");
  reader.number("range_max", config.range_max, {1.0, 300.0}, "m");
  return config;
}

void CarmenPlayer::open(int64_t now) {
  line_.clear();
  waiting_.clear();
  logged_.reset();
  due_ = now;
  reasons().note(Rank::kStarting, "no scan read yet", now);
}

void CarmenPlayer::receive(std::string_view bytes, int64_t now) {
  if (due_ < now && waiting_.empty()) due_ = now;
  for (const char byte : bytes) {
    if (byte == '\n') {
      if (overlong_)
        skipUnreadable("overlong lines", now, kWhichFile, 1);
      else
        takeLine(line_, now);
      line_.clear();
      overlong_ = false;
    } else if (line_.size() < kLongestLine) {
      line_ += byte;
    } else {
      overlong_ = true;
    }
  }
}

void CarmenPlayer::takeLine(const std::string& line, int64_t now) {
  if (line.empty()) return;
  std::string problem;
  CarmenScan read = parseCarmenLine(line, problem);
  if (!problem.empty()) {
    if (problem == kOtherCarmenLine) return skipUnreadable(problem, now, kWhichFile, 1);
    return refuse(problem, now, "was the log cut, or edited?");
  }
  double pause = 1.0 / config_.rate;
  if (logged_ && read.logged && *read.logged > *logged_)
    pause = std::min(*read.logged - *logged_, kLongestPause);
  else
    count("scans without a time of their own");
  logged_ = read.logged;
  due_ += std::max<int64_t>(1000, std::llround(1e6 * pause));
  read.scan.utime = due_;
  if (read.scan.range_max <= 0.0) read.scan.range_max = config_.range_max;
  waiting_.push_back(std::move(read.scan));
  count("scans read");
  reasons().clear();
}

std::vector<RangeScan> CarmenPlayer::take(int64_t now) {
  std::vector<RangeScan> due;
  for (; !waiting_.empty() && waiting_.front().utime <= now; waiting_.pop_front())
    due.push_back(std::move(waiting_.front()));
  return due;
}

}  // namespace tread::lidar
