// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "common/geometry/se2.hpp"
#include "tools/replay/mapping_recording.hpp"

namespace tread {
namespace {

constexpr int64_t kStartUs = 2'000'000;
constexpr int64_t kInsPeriodUs = 20'000;
constexpr double kSpeed = 1.0;        // [m/s]
constexpr double kTurnRate = 0.5;     // [rad/s]
constexpr double kLaserHeight = 0.3;  // [m] the logs do not tell
/// Ranges from here on are the device's way to say that nothing came back [m].
constexpr double kNoReturn = 80.0;

/// One FLASER line: ranges over the half turn ahead, and the pose of the laser.
struct LaserLine {
  std::vector<float> ranges;
  Pose2 T_map_laser;
};

std::optional<LaserLine> parse(const std::string& line) {
  std::istringstream words(line);
  std::string keyword;
  size_t count = 0;
  LaserLine laser;
  if (!(words >> keyword >> count) || count < 2 || count > 10000) return std::nullopt;
  laser.ranges.resize(count);
  for (float& range : laser.ranges) words >> range;
  Pose2& pose = laser.T_map_laser;
  words >> pose.x >> pose.y >> pose.yaw;
  if (!words || !std::isfinite(pose.x + pose.y + pose.yaw)) return std::nullopt;
  return laser;
}

/// `problem`: one clear line if the file ends too early.
std::vector<std::string> linesOf(const std::string& path, std::string& problem) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw std::runtime_error(path + ": cannot be opened");
  std::string text;
  char buffer[65536];
  int got = 0;
  while ((got = gzread(file.get(), buffer, sizeof(buffer))) > 0)
    text.append(buffer, static_cast<size_t>(got));
  if (got < 0) throw std::runtime_error(path + ": is damaged: its compressed bytes do not unpack");
  // A file that is cut off gives what it has, and this error.
  int error = Z_OK;
  gzerror(file.get(), &error);
  if (error == Z_BUF_ERROR)
    problem = path + ": ends in the middle of its compressed bytes; is the file truncated?";
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(std::move(line));
  return lines;
}

ins_t insAt(int64_t utime, const Pose2& pose) {
  ins_t message{};
  message.utime = utime;
  message.device_utc = -1;
  message.position[0] = pose.x;
  message.position[1] = pose.y;
  message.orientation[0] = std::cos(pose.yaw / 2.0);
  message.orientation[3] = std::sin(pose.yaw / 2.0);
  message.ins_status = ins_t::STATUS_NO_VELOCITY | ins_t::STATUS_NO_ATTITUDE;
  message.satellites = -1;
  for (double& speed : message.velocity) speed = std::nan("");
  return message;
}

scan_t scanAt(int64_t utime, const std::vector<float>& ranges) {
  scan_t message{};
  message.utime = utime;
  message.sensor_position[2] = kLaserHeight;
  message.sensor_orientation[0] = 1.0;
  message.angle_step = kPi / static_cast<double>(ranges.size());
  message.angle_first = -kPi / 2.0;
  message.range_max = kNoReturn;
  message.ranges = ranges;
  message.num_beams = static_cast<int32_t>(ranges.size());
  return message;
}

/// INS messages on the arc between two poses, the second one included.
void drive(const Pose2& from, const Pose2& to, int64_t start, int64_t end,
           std::vector<ins_t>& poses) {
  const Pose2 step = between(from, {to.x, to.y, from.yaw + wrapAngle(to.yaw - from.yaw)});
  const double duration = static_cast<double>(end - start);
  const Twist2 twist = twistTo(step, 1.0);
  for (int64_t utime = start + kInsPeriodUs; utime < end; utime += kInsPeriodUs)
    poses.push_back(
        insAt(utime, from * integrate(twist, static_cast<double>(utime - start) / duration)));
  poses.push_back(insAt(end, to));
}

int64_t durationOf(const Pose2& from, const Pose2& to) {
  const double way = (to.position() - from.position()).norm() / kSpeed;
  const double turn = std::abs(wrapAngle(to.yaw - from.yaw)) / kTurnRate;
  return std::max<int64_t>(100'000, std::llround(1e6 * std::max(way, turn)));
}

mapping::MappingConfig outdoorConfig() {
  mapping::MappingConfig config;
  config.map.marking_range = config.map.clearing_range = 20.0;
  config.map.window_tiles = 14;
  config.map.robot = {0.25, 0.25, 0.21};
  config.map.ground.slope_doubt = 0.0;  // the poses are level: nothing is known of slopes
  return config;
}

}  // namespace

MappingRecording readCarmenLog(const std::string& path) {
  MappingRecording recording;
  recording.name = path.substr(path.find_last_of('/') + 1);
  recording.config = outdoorConfig();
  Pose2 last;
  int64_t utime = kStartUs;
  for (const std::string& line : linesOf(path, recording.problem)) {
    if (line.compare(0, 7, "FLASER ") != 0) continue;
    const auto laser = parse(line);
    if (!laser) {
      ++recording.skipped;
      continue;
    }
    if (recording.scans.empty()) {
      recording.poses.push_back(insAt(utime, laser->T_map_laser));
    } else {
      const int64_t end = utime + durationOf(last, laser->T_map_laser);
      drive(last, laser->T_map_laser, utime, end, recording.poses);
      utime = end;
    }
    last = laser->T_map_laser;
    recording.scans.push_back(scanAt(utime, laser->ranges));
  }
  if (recording.scans.empty())
    throw std::runtime_error(path + ": holds no FLASER line; is it a CARMEN log with poses?");
  for (size_t i = 0; i < recording.poses.size(); ++i)
    recording.poses[i].seq = static_cast<int64_t>(i);
  for (size_t i = 0; i < recording.scans.size(); ++i)
    recording.scans[i].seq = static_cast<int64_t>(i);
  return recording;
}

}  // namespace tread
