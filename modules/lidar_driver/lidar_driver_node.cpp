// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/lidar_driver_node.hpp"

#include <sstream>

#include "common/messages/blank.hpp"

namespace tread::lidar {
namespace {

constexpr int64_t kCounterPeriodUs = 200'000;

}  // namespace

LidarDriverConfig readLidarDriverConfig(ConfigReader& reader) {
  LidarDriverConfig config;
  int64_t max_beams = config.limits.max_beams;
  int64_t stride = config.limits.beam_stride;
  reader.text("address", config.address);
  reader.number("latency", config.latency, {0.0, 0.5}, "s");
  config.device = readScanDevice(reader, config.latency);
  reader.number("silence", config.silence, {0.1, 60.0}, "s");
  reader.number("range_min", config.limits.range_min, {0.0, 10.0}, "m");
  reader.number("range_max", config.limits.range_max, {0.5, 300.0}, "m");
  if (config.limits.range_min >= config.limits.range_max)
    throw reader.error("range_max", "must be above range_min");
  reader.integer("max_beams", max_beams, {2, 10000}, "beams");
  reader.integer("beam_stride", stride, {1, 20}, "beams");
  const RobotDescription robot = readRobot(reader);
  config.mounting = robot.range_finder;
  config.ground_mounting = robot.ground_finder;
  reader.text("ground_address", config.ground_address, robot.ground_finder.has_value());
  reader.finish();
  config.limits.max_beams = static_cast<int>(max_beams);
  config.limits.beam_stride = static_cast<int>(stride);
  config.effective = reader.effective();
  return config;
}

LidarDriverNode::LidarDriverNode(const LidarDriverConfig& config, Bus& bus, Link& line,
                                 Link* ground_line, Say say)
    : config_(config),
      bus_(bus),
      say_(std::move(say)),
      health_(bus, "lidar_driver", config.effective) {
  const auto add = [&](const std::string& address, const Mounting& mounting, Link& link) {
    finders_.push_back({address, mounting, ScanConnection(link, config.device.make()),
                        ScanCheck(config.limits), bus.now()});
  };
  add(config.address, config.mounting, line);
  if (config.ground_mounting) add(config.ground_address, *config.ground_mounting, *ground_line);
  health_.watchNamesakes();
  // Both are of the same kind.
  const std::string shortcomings = finders_.front().connection.shortcomings();
  if (shortcomings.empty()) return;
  health_.setCounter("not promised by " + shortcomings, 1);
  if (say_) say_("not promised by " + shortcomings);
}

void LidarDriverNode::step(int64_t utime) {
  for (Finder& finder : finders_) take(finder, utime);
  reportHealth(utime);
  health_.step(utime);
}

void LidarDriverNode::take(Finder& finder, int64_t utime) {
  for (const RangeScan& raw : finder.connection.take(utime)) {
    const auto scan = finder.check.accept(raw);
    if (scan) {
      finder.last_scan = utime;
      finder.reasons.clear();
      publish(*scan, finder.mounting);
    } else {
      const std::string refusal = "refused: " + finder.check.refusal();
      health_.addToCounter(refusal);
      finder.reasons.note(Rank::kRefused, refusal, utime);
    }
  }
}

void LidarDriverNode::publish(const RangeScan& scan, const Mounting& mounting) {
  auto message = blank<scan_t>();
  message.utime = scan.utime;
  message.seq = seq_++;
  const Eigen::Quaterniond R_body_sensor(isometryFrom(mounting.p_body, mounting.angles).linear());
  for (int i = 0; i < 3; ++i) message.sensor_position[i] = mounting.p_body[i];
  message.sensor_orientation[0] = R_body_sensor.w();
  message.sensor_orientation[1] = R_body_sensor.x();
  message.sensor_orientation[2] = R_body_sensor.y();
  message.sensor_orientation[3] = R_body_sensor.z();
  message.duration = static_cast<int32_t>(scan.duration_us);
  message.angle_first = scan.angle_first;
  message.angle_step = scan.angle_step;
  message.range_min = scan.range_min;
  message.range_max = scan.range_max;
  message.ranges = scan.ranges;
  message.num_beams = static_cast<int32_t>(scan.ranges.size());
  for (const auto& point : scan.points) message.points.emplace_back(point.begin(), point.end());
  message.num_points = static_cast<int32_t>(scan.points.size());
  bus_.publish(kScan, message);
  health_.addToCounter("scans");
}

void LidarDriverNode::reportHealth(int64_t utime) {
  NotedReason problem;
  for (const Finder& finder : finders_)
    if (problem.rank == Rank::kNone) problem = silenceOf(finder, utime);
  health_.setState(problem.rank == Rank::kNone ? health_t::HEALTH_OK : health_t::HEALTH_FAILED,
                   problem.words);
  sayOnce(problem);
  if (utime < next_counters_) return;
  next_counters_ = utime + kCounterPeriodUs;
  for (const Finder& finder : finders_) {
    const char* const prefix = &finder == &finders_.front() ? "" : "ground: ";
    for (const auto& [name, number] : finder.connection.counters())
      health_.setCounter(prefix + name, number);
  }
}

/// The line of a problem changes every second with its age: it is reported when it begins, when its
/// reason becomes more significant, and when it ends.
void LidarDriverNode::sayOnce(const NotedReason& problem) {
  const bool ended = problem.rank == Rank::kNone && said_.rank != Rank::kNone;
  if (!ended && problem.rank <= said_.rank) return;
  if (say_) say_(ended ? "scans again after: " + said_.words : problem.words);
  said_ = problem;
}

/// Why a range finder sends no scans, in one line; kNone if it does.
NotedReason LidarDriverNode::silenceOf(const Finder& finder, int64_t utime) const {
  const double silent = static_cast<double>(utime - finder.last_scan) * 1e-6;
  if (silent < config_.silence) return {};
  NotedReason reason = finder.connection.reason(utime);
  const NotedReason refused = finder.reasons.best(utime);
  if (refused.rank > reason.rank) reason = refused;
  if (reason.rank == Rank::kNone) reason = {Rank::kSilent, "is the device powered and scanning?"};
  std::ostringstream line;
  line << finder.address << ": no " << (reason.rank == Rank::kRefused ? "good " : "") << "scan for "
       << static_cast<int64_t>(silent) << " s; " << reason.words;
  return {reason.rank, line.str()};
}

}  // namespace tread::lidar
