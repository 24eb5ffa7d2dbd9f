// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/replay/mapping_recording.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "common/drive/drive_reader.hpp"
#include "common/geometry/se2.hpp"
#include "common/messages/blank.hpp"
#include "common/recordings/foreign_types.hpp"
#include "common/types/message_type.hpp"
#include "modules/lidar_driver/carmen/carmen_player.hpp"

namespace tread {
namespace {

constexpr int64_t kStartUs = 2'000'000;

// CARMEN logs.
constexpr int64_t kInsPeriodUs = 20'000;
constexpr double kSpeed = 1.0;          // [m/s]
constexpr double kLongestWay = 1000.0;  // [m] between two poses; such logs have about one per metre
constexpr double kTurnRate = 0.5;       // [rad/s]
constexpr double kCarmenLaserHeight = 0.3;  // [m] not in the logs
/// Larger ranges [m] mean no echo.
constexpr double kNoReturn = 80.0;

// The MBot's logs.
constexpr int64_t kSweepUs = 200'000;
constexpr double kMbotLaserHeight = 0.15;  // [m]
constexpr double kNearest = 0.12;          // [m] closer returns hit the robot itself
constexpr double kFarthest = 6.0;          // [m]

ins_t insAt(int64_t utime, const Pose2& pose) {
  auto message = blank<ins_t>();
  message.utime = utime;
  message.position[0] = pose.x;
  message.position[1] = pose.y;
  message.position[2] = 0.0;
  message.orientation[1] = message.orientation[2] = 0.0;
  message.orientation[0] = std::cos(pose.yaw / 2.0);
  message.orientation[3] = std::sin(pose.yaw / 2.0);
  message.ins_status = ins_t::STATUS_NO_VELOCITY | ins_t::STATUS_NO_ATTITUDE;
  return message;
}

scan_t scanFrom(int64_t utime, double laser_height) {
  auto message = blank<scan_t>();
  message.utime = utime;
  const double position[3] = {0.0, 0.0, laser_height};
  const double level[4] = {1.0, 0.0, 0.0, 0.0};
  std::copy(std::begin(position), std::end(position), message.sensor_position);
  std::copy(std::begin(level), std::end(level), message.sensor_orientation);
  return message;
}

/// `problem`: one clear line if the file is truncated.
std::vector<std::string> linesOf(const std::string& path, std::string& problem) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw std::runtime_error(path + ": cannot be opened");
  std::string text;
  char buffer[65536];
  int got = 0;
  while ((got = gzread(file.get(), buffer, sizeof(buffer))) > 0)
    text.append(buffer, static_cast<size_t>(got));
  if (got < 0)
    throw std::runtime_error(path + ": is damaged: its compressed bytes cannot be unpacked");
  // For a truncated file the existing part is returned, with this error.
  int error = Z_OK;
  gzerror(file.get(), &error);
  if (error == Z_BUF_ERROR)
    problem = path + ": ends in the middle of its compressed bytes; is the file truncated?";
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(std::move(line));
  return lines;
}

scan_t scanAt(int64_t utime, const lidar::RangeScan& scan) {
  scan_t message = scanFrom(utime, kCarmenLaserHeight);
  message.angle_step = scan.angle_step;
  message.angle_first = scan.angle_first;
  message.range_min = 0.0;
  message.range_max = scan.range_max > 0.0 ? scan.range_max : kNoReturn;
  message.ranges = scan.ranges;
  message.num_beams = static_cast<int32_t>(scan.ranges.size());
  return message;
}

/// INS messages on the arc between two poses, including the second one.
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
  config.map.obstacle.robot_height = 1.2;
  config.map.ground.slope_doubt = 0.0;  // the poses are level, slopes are unknown
  return config;
}

/// A CARMEN text log with corrected poses, plain or gzipped.
/** Such logs have a pose about every metre and no times. The times are generated for 1 m/s and at
 * most 0.5 rad/s between the poses, along arcs. */
void readCarmenLog(const std::string& path, MappingRecording& recording) {
  recording.config = outdoorConfig();
  Pose2 last;
  int64_t utime = kStartUs;
  for (const std::string& line : linesOf(path, recording.problem)) {
    std::string problem;
    const lidar::CarmenScan laser = lidar::parseCarmenLine(line, problem);
    if (problem == lidar::kOtherCarmenLine) continue;
    const bool first = recording.scans.empty();
    if (!problem.empty() || !(first || distanceBetween(last, laser.T_map_laser) <= kLongestWay)) {
      ++recording.skipped;
      continue;
    }
    if (first) {
      recording.poses.push_back(insAt(utime, laser.T_map_laser));
    } else {
      const int64_t end = utime + durationOf(last, laser.T_map_laser);
      drive(last, laser.T_map_laser, utime, end, recording.poses);
      utime = end;
    }
    last = laser.T_map_laser;
    recording.scans.push_back(scanAt(utime, laser.scan));
  }
  if (recording.scans.empty())
    throw std::runtime_error(
        path + ": contains no FLASER or ROBOTLASER1 line; is it a CARMEN log with poses?");
}

/// Fields of a message of that project; nullopt if it has another type or is damaged.
std::optional<std::map<std::string, std::vector<double>>> foreignNumbers(const LogEvent& event,
                                                                         const char* type) {
  const MessageTypes& types = recordings::foreignTypes();
  return numbersOf(types, *types.find(type), event.bytes);
}

std::optional<ins_t> poseOf(const LogEvent& event, int64_t utime) {
  const auto pose = foreignNumbers(event, "pose_xyt_t");
  if (!pose) return std::nullopt;
  return insAt(utime, {pose->at("x")[0], pose->at("y")[0], pose->at("theta")[0]});
}

/// Beams without an echo stay in the slice as NaN, because a point's index determines its time.
std::vector<float> pointOf(double range, double clockwise) {
  if (!(range > kNearest) || !(range < kFarthest)) return std::vector<float>(3, std::nanf(""));
  return {static_cast<float>(range * std::cos(clockwise)),
          static_cast<float>(-range * std::sin(clockwise)), 0.0f};
}

std::optional<scan_t> scanOf(const LogEvent& event, int64_t utime, int64_t& device_time) {
  const auto sweep = foreignNumbers(event, "lidar_t");
  if (!sweep) return std::nullopt;
  device_time = static_cast<int64_t>(sweep->at("utime")[0]);
  const std::vector<double>& ranges = sweep->at("ranges");
  if (ranges.size() < 2 || ranges.size() > 10000) return std::nullopt;
  scan_t message = scanFrom(utime, kMbotLaserHeight);
  message.duration = static_cast<int32_t>(kSweepUs);
  for (size_t i = 0; i < ranges.size(); ++i)
    message.points.push_back(pointOf(ranges[i], sweep->at("thetas")[i]));
  message.num_points = static_cast<int32_t>(ranges.size());
  return message;
}

mapping::MappingConfig indoorConfig() {
  mapping::MappingConfig config;
  config.map.voxels.cell_size = 0.05;
  config.map.marking_range = config.map.clearing_range = 5.0;
  config.map.robot = {0.1, 0.1, 0.1};
  config.map.start_free_radius = 0.2;
  config.map.obstacle = {0.05, 0.3};
  config.map.ground.slope_doubt = 0.0;  // a level floor
  config.max_ins_gap = 0.3;             // the motion capture sometimes loses the robot
  return config;
}

template <class Message>
void keep(const std::optional<Message>& message, std::vector<Message>& messages,
          MappingRecording& recording) {
  if (message)
    messages.push_back(*message);
  else
    ++recording.skipped;
}

template <class Message>
void number(std::vector<Message>& messages) {
  for (size_t i = 0; i < messages.size(); ++i) messages[i].seq = static_cast<int64_t>(i);
}

/// An LCM log of an MBot (2017): LIDAR and TRUE_POSE in their own types.
/** Its beams run clockwise with uneven spacing, so each sweep becomes a slice of points. A sweep is
 * assumed to end at its logging time: this agrees better with the poses, which are also stamped on
 * arrival, than the stamps of LIDAR. */
void readMbotLog(const std::string& path, MappingRecording& recording) {
  recording.config = indoorConfig();
  DriveReader log({path});
  std::optional<int64_t> first;
  for (DriveEvent event; log.next(event);) {
    if (!first) first = event.utime;
    const int64_t utime = kStartUs + event.utime - *first;
    if (event.channel == "TRUE_POSE") {
      keep(poseOf(event, utime), recording.poses, recording);
    } else if (event.channel == "LIDAR") {
      int64_t device_time = 0;
      const auto scan = scanOf(event, utime - kSweepUs, device_time);
      keep(scan, recording.scans, recording);
      if (scan) recording.device_times.push_back(device_time);
    }
  }
  recording.problem = log.problem();
  if (recording.scans.empty())
    throw std::runtime_error(path + ": contains no LIDAR message of the MBot's type");
}

bool endsWith(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

}  // namespace

MappingRecording readMappingRecording(const std::string& path) {
  MappingRecording recording;
  recording.name = path.substr(path.find_last_of('/') + 1);
  if (endsWith(path, ".gz") || endsWith(path, ".clf"))
    readCarmenLog(path, recording);
  else
    readMbotLog(path, recording);
  number(recording.poses);
  number(recording.scans);
  return recording;
}

}  // namespace tread
