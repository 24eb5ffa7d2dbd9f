// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "common/geometry/se2.hpp"
#include "common/log/event_log.hpp"
#include "tools/replay/mapping_recording.hpp"

namespace tread {
namespace {

constexpr int64_t kStartUs = 2'000'000;
constexpr int64_t kSweepUs = 200'000;
constexpr uint64_t kLidarType = 0x89dc5b879a5056cf;  // lidar_t of that project
constexpr uint64_t kPoseType = 0x1f317af1246276ac;   // pose_xyt_t of that project
constexpr double kLaserHeight = 0.15;
constexpr float kNearest = 0.12f;  // [m] nearer returns are the robot's own
constexpr float kFarthest = 6.0f;

/// Takes big-endian fields from a message's bytes; ok() turns false where they end.
class Fields {
 public:
  explicit Fields(const std::vector<uint8_t>& bytes) : bytes_(bytes) {}

  template <class Value>
  Value take() {
    uint8_t reversed[sizeof(Value)] = {};
    Value value{};
    if (bytes_.size() - at_ < sizeof(Value)) {
      ok_ = false;
      return value;
    }
    for (size_t i = 0; i < sizeof(Value); ++i) reversed[sizeof(Value) - 1 - i] = bytes_[at_ + i];
    at_ += sizeof(Value);
    std::memcpy(&value, reversed, sizeof(Value));
    return value;
  }
  bool ok() const { return ok_; }

 private:
  const std::vector<uint8_t>& bytes_;
  size_t at_ = 0;
  bool ok_ = true;
};

std::optional<ins_t> poseOf(const LogEvent& event, int64_t utime) {
  Fields fields(event.bytes);
  if (fields.take<uint64_t>() != kPoseType) return std::nullopt;
  fields.take<int64_t>();
  ins_t message{};
  message.utime = utime;
  message.position[0] = double(fields.take<float>());
  message.position[1] = double(fields.take<float>());
  const auto yaw = double(fields.take<float>());
  message.orientation[0] = std::cos(yaw / 2.0);
  message.orientation[3] = std::sin(yaw / 2.0);
  message.device_utc = -1;
  message.satellites = -1;
  message.ins_status = ins_t::STATUS_NO_VELOCITY | ins_t::STATUS_NO_ATTITUDE;
  for (double& speed : message.velocity) speed = std::nan("");
  if (!fields.ok()) return std::nullopt;
  return message;
}

/// Beams that are no return stay in the slice as NaN: a point's place in it tells its time.
std::vector<float> pointOf(float range, float clockwise) {
  if (!(range > kNearest) || !(range < kFarthest)) return std::vector<float>(3, std::nanf(""));
  return {range * std::cos(clockwise), -range * std::sin(clockwise), 0.0f};
}

std::optional<scan_t> scanOf(const LogEvent& event, int64_t utime) {
  Fields fields(event.bytes);
  if (fields.take<uint64_t>() != kLidarType) return std::nullopt;
  fields.take<int64_t>();
  const auto count = fields.take<int32_t>();
  if (!fields.ok() || count < 2 || count > 10000) return std::nullopt;
  std::vector<float> ranges(static_cast<size_t>(count));
  for (float& range : ranges) range = fields.take<float>();
  scan_t message{};
  message.utime = utime;
  message.duration = static_cast<int32_t>(kSweepUs);
  message.sensor_position[2] = kLaserHeight;
  message.sensor_orientation[0] = 1.0;
  for (const float range : ranges) message.points.push_back(pointOf(range, fields.take<float>()));
  message.num_points = count;
  if (!fields.ok()) return std::nullopt;
  return message;
}

mapping::MappingConfig indoorConfig() {
  mapping::MappingConfig config;
  config.map.voxels.cell_size = 0.05;
  config.map.marking_range = config.map.clearing_range = 5.0;
  config.map.robot = {0.1, 0.1, 0.1};
  config.map.start_free_radius = 0.2;
  config.map.judge = {0.05, 0.3};
  config.map.ground.slope_doubt = 0.0;  // a level floor
  config.max_ins_gap = 0.3;             // the motion capture loses the robot now and then
  return config;
}

}  // namespace

MappingRecording readMbotLog(const std::string& path) {
  MappingRecording recording;
  recording.name = path.substr(path.find_last_of('/') + 1);
  recording.config = indoorConfig();
  LogReader log(path);
  LogEvent event;
  std::optional<int64_t> first;
  while (log.next(event)) {
    if (!first) first = event.utime;
    const int64_t utime = kStartUs + event.utime - *first;
    if (event.channel == "TRUE_POSE") {
      auto pose = poseOf(event, utime);
      if (!pose) ++recording.skipped;
      if (!pose) continue;
      pose->seq = static_cast<int64_t>(recording.poses.size());
      recording.poses.push_back(*pose);
    } else if (event.channel == "LIDAR") {
      auto scan = scanOf(event, utime - kSweepUs);
      if (!scan) ++recording.skipped;
      if (!scan) continue;
      scan->seq = static_cast<int64_t>(recording.scans.size());
      recording.scans.push_back(*scan);
    }
  }
  recording.problem = log.problem();
  if (recording.scans.empty())
    throw std::runtime_error(path + ": holds no LIDAR message of the MBot's type");
  return recording;
}

}  // namespace tread
