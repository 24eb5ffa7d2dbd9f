// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/lidar_driver_node.hpp"

#include <sstream>

#include "common/messages/blank.hpp"

namespace tread::lidar {

LidarDriverConfig readLidarDriverConfig(ConfigReader& reader) {
  LidarDriverConfig config;
  int64_t max_beams = config.limits.max_beams;
  int64_t stride = config.limits.beam_stride;
  reader.choice("device", config.device, kScanDevices);
  reader.text("address", config.address);
  reader.number("latency", config.latency, {0.0, 0.5}, "s");
  reader.number("silence", config.silence, {0.1, 60.0}, "s");
  reader.number("range_min", config.limits.range_min, {0.0, 10.0}, "m");
  reader.number("range_max", config.limits.range_max, {0.5, 300.0}, "m");
  if (config.limits.range_min >= config.limits.range_max)
    throw reader.error("range_max", "must be above range_min");
  reader.integer("max_beams", max_beams, {2, 10000}, "beams");
  reader.integer("beam_stride", stride, {1, 20}, "beams");
  config.mounting = readRobot(reader).range_finder;
  reader.finish();
  config.limits.max_beams = static_cast<int>(max_beams);
  config.limits.beam_stride = static_cast<int>(stride);
  config.effective = reader.effective();
  return config;
}

LidarDriverNode::LidarDriverNode(const LidarDriverConfig& config, Bus& bus, ScanSource& source)
    : config_(config),
      bus_(bus),
      source_(source),
      check_(config.limits),
      health_(bus, "lidar_driver", config.effective),
      R_body_sensor_(isometryFrom(config.mounting.p_body, config.mounting.angles).linear()),
      last_scan_(bus.now()) {
  health_.watchNamesakes();
}

void LidarDriverNode::step(int64_t utime) {
  for (const RangeScan& raw : source_.take(utime)) {
    const auto scan = check_.accept(raw);
    last_refusal_ = check_.refusal();
    if (scan) {
      last_scan_ = utime;
      publish(*scan);
    } else {
      health_.addToCounter("refused: " + last_refusal_);
    }
  }
  reportHealth(utime);
  health_.step(utime);
}

void LidarDriverNode::publish(const RangeScan& scan) {
  auto message = blank<scan_t>();
  message.utime = scan.utime;
  message.seq = seq_++;
  const Eigen::Vector3d& position = config_.mounting.p_body;
  for (int i = 0; i < 3; ++i) message.sensor_position[i] = position[i];
  message.sensor_orientation[0] = R_body_sensor_.w();
  message.sensor_orientation[1] = R_body_sensor_.x();
  message.sensor_orientation[2] = R_body_sensor_.y();
  message.sensor_orientation[3] = R_body_sensor_.z();
  message.duration = static_cast<int32_t>(scan.duration_us);
  message.angle_first = scan.angle_first;
  message.angle_step = scan.angle_step;
  message.range_min = scan.range_min;
  message.range_max = scan.range_max;
  message.ranges = scan.ranges;
  message.num_beams = static_cast<int32_t>(scan.ranges.size());
  bus_.publish(kScan, message);
  health_.addToCounter("scans");
}

void LidarDriverNode::reportHealth(int64_t utime) {
  const double silent = static_cast<double>(utime - last_scan_) * 1e-6;
  if (silent < config_.silence) return health_.setState(health_t::HEALTH_OK, "");
  std::ostringstream line;
  const bool refused = !last_refusal_.empty();
  line << config_.address << ": no " << (refused ? "good " : "") << "scan for "
       << static_cast<int64_t>(silent) << " s";
  const std::string problem = source_.problem();
  if (!problem.empty()) {
    line << "; " << problem;
  } else if (refused) {
    line << "; the last one was refused: " << last_refusal_;
  } else {
    line << "; is the device powered and scanning?";
  }
  health_.setState(health_t::HEALTH_FAILED, line.str());
}

}  // namespace tread::lidar
