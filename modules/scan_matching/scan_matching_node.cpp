// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/scan_matching/scan_matching_node.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/geometry/se2.hpp"
#include "common/messages/blank.hpp"
#include "common/messages/pattern_messages.hpp"

namespace tread::scan_matching {
namespace {

/// A message stamped further in the future comes from another clock [us].
constexpr int64_t kFarthestAhead = 200'000;
/// Scans that may wait at the same time; more means that this computer is too slow.
constexpr size_t kMostWaiting = 4;
/// Own messages return within this many.
constexpr size_t kMostOwn = 100;
/// An older MOTOR is uninformative about the present [us].
constexpr int64_t kMotorAge = 300'000;
constexpr double kUsual = 0.1;  // [1] weight of a new interval in the usual one

int64_t microseconds(double seconds) {
  return std::llround(seconds * 1e6);
}

void readMatching(ConfigReader& reader, ScanMatcherConfig& matcher) {
  std::vector<double> start{0.0, 0.0, 0.0};
  reader.numbers("start", start, 3, {-1e5, 1e5}, "m, m, rad");
  matcher.start = {start[0], start[1], start[2]};
  reader.number("range_noise", matcher.points.range_noise, {0.001, 0.2}, "m");
  matcher.registration.range_noise = matcher.points.range_noise;
  reader.number("surface_noise", matcher.registration.surface_noise, {0.0, 0.5}, "m");
  reader.number("range_max", matcher.points.range_max, {1.0, 100.0}, "m");
  reader.number("spacing", matcher.points.spacing, {0.01, 0.5}, "m");
  int64_t min_points = matcher.min_points;
  reader.integer("min_points", min_points, {10, 1000}, "points");
  matcher.min_points = static_cast<int>(min_points);
  reader.number("min_overlap", matcher.min_overlap, {0.05, 0.95}, "");
  reader.number("max_position_std", matcher.max_position_std, {0.02, 5.0}, "m");
  reader.number("max_yaw_std", matcher.max_yaw_std, {0.01, 1.0}, "rad");
  reader.number("new_map_after", matcher.new_map_after, {0.1, 60.0}, "s");
}

void readMotion(ConfigReader reader, MotionConfig& motion) {
  reader.number("acceleration", motion.acceleration, {0.05, 20.0}, "m/s2");
  reader.number("yaw_acceleration", motion.yaw_acceleration, {0.05, 50.0}, "rad/s2");
  reader.number("lateral_speed", motion.lateral_speed, {0.005, 20.0}, "m/s");
  reader.number("speed", motion.speed, {0.05, 20.0}, "m/s");
  reader.number("yaw_rate", motion.yaw_rate, {0.05, 20.0}, "rad/s");
  reader.number("correlation", motion.correlation, {0.05, 5.0}, "s");
}

void readKeyScans(ConfigReader reader, ScanMatcherConfig& matcher) {
  reader.number("distance", matcher.key_distance, {0.05, 10.0}, "m");
  reader.number("turn", matcher.key_turn, {0.05, 3.0}, "rad");
  int64_t count = matcher.key_scans;
  reader.integer("count", count, {1, 100}, "scans");
  matcher.key_scans = static_cast<int>(count);
}

const char* wordsOf(MatchOutcome outcome) {
  switch (outcome) {
    case MatchOutcome::kFirst:
      return "maps begun";
    case MatchOutcome::kMatched:
      return "scans matched";
    case MatchOutcome::kUndetermined:
      return "scans matched: motion undetermined in some direction";
    case MatchOutcome::kTooFew:
      return "matches refused: too few points in sight";
    case MatchOutcome::kNoFit:
      return "matches refused: does not fit the map";
    case MatchOutcome::kNotNewer:
      break;
  }
  return "scans refused: not newer than the scan before";
}

const char* remedyOf(MatchOutcome outcome) {
  switch (outcome) {
    case MatchOutcome::kUndetermined:
      return "the visible surroundings look the same along some direction (a corridor, a round "
             "room); drive where something is across it";
    case MatchOutcome::kTooFew:
      return "too little is in sight of the range finder (an open field?); drive nearer to walls, "
             "trees or posts, or use an INS";
    case MatchOutcome::kNoFit:
      return "scans do not fit the local map; is the range finder loose, blocked, or the ground "
             "too "
             "uneven?";
    default:
      return "the next scans decide";
  }
}

void setPose(const MatchedPose& pose, ins_t& message) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  message.ins_status = ins_t::STATUS_NO_ATTITUDE;
  if (pose.position_known) {
    message.position[0] = pose.T_map_body.x;
    message.position[1] = pose.T_map_body.y;
    message.position[2] = 0.0;
    message.position_std[0] = std::sqrt(pose.covariance(0, 0));
    message.position_std[1] = std::sqrt(pose.covariance(1, 1));
  } else {
    message.ins_status |= ins_t::STATUS_NO_POSITION;
  }
  if (!pose.heading_known) {
    message.ins_status |= ins_t::STATUS_NO_HEADING;
    return;
  }
  message.orientation[0] = std::cos(pose.T_map_body.yaw / 2.0);
  message.orientation[1] = message.orientation[2] = 0.0;
  message.orientation[3] = std::sin(pose.T_map_body.yaw / 2.0);
  message.attitude_std[0] = message.attitude_std[1] = nan;
  message.attitude_std[2] = std::sqrt(pose.covariance(2, 2));
  message.rate[2] = pose.v_body.omega;
}

}  // namespace

ScanMatchingConfig readScanMatchingConfig(ConfigReader& reader) {
  ScanMatchingConfig config;
  readMatching(reader, config.matcher);
  readMotion(reader.section("motion"), config.matcher.motion);
  readKeyScans(reader.section("key_scans"), config.matcher);
  std::string channel = kIns.name;
  reader.choice("channel", channel, {kIns.name, kScanMatching.name});
  config.fills_in = channel == kScanMatching.name;
  reader.number("lowest", config.lowest, {-1.0, 5.0}, "m");
  reader.number("ground_tilt", config.ground_tilt, {0.0, 0.5}, "rad");
  reader.number("ground_noise", config.matcher.registration.ground_noise, {0.0, 10.0}, "m");
  reader.number("max_tilt", config.max_tilt, {0.0, 1.0}, "rad");
  reader.number("standing_after", config.standing_after, {0.1, 60.0}, "s");
  reader.number("silence", config.silence, {0.1, 60.0}, "s");
  reader.finish();
  config.effective = reader.effective();
  return config;
}

std::optional<Sweep> sweepOf(const ReceivedScan& scan, const ScanMatchingConfig& config,
                             std::string& refusal) {
  const Eigen::Isometry3d& T_body_sensor = scan.T_body_sensor;
  if (T_body_sensor.linear()(2, 2) < std::cos(config.max_tilt)) {
    refusal = "its plane is too steep";
    return std::nullopt;
  }
  Sweep sweep;
  sweep.first = scan.first;
  sweep.last = scan.last;
  sweep.p_body_sensor = T_body_sensor.translation().head<2>();
  if (config.ground_tilt > 0.0)
    sweep.trusted_range = T_body_sensor.translation().z() / config.ground_tilt;
  for (const Beam& beam : scan.beams) {
    if (!beam.hit) continue;
    const Eigen::Vector3d p_body = T_body_sensor * beam.end;
    if (p_body.z() < config.lowest) continue;
    sweep.returns.push_back({p_body.head<2>(), beam.share});
  }
  return sweep;
}

ins_t messageOf(const MatchedPose& pose, int64_t seq) {
  auto message = blank<ins_t>();
  message.utime = pose.utime;
  message.seq = seq;
  setPose(pose, message);
  if (pose.position_known && pose.heading_known) {
    message.velocity[0] = pose.v_body.v_x;
    message.velocity[1] = pose.v_body.v_y;
  } else {
    message.ins_status |= ins_t::STATUS_NO_VELOCITY;
  }
  if (pose.new_track) message.ins_status |= ins_t::STATUS_JUMP;
  return message;
}

ScanMatchingNode::ScanMatchingNode(const ScanMatchingConfig& config, Bus& bus)
    : config_(config),
      bus_(bus),
      health_(bus, "scan_matching", config.effective),
      matcher_(config.matcher),
      last_scan_(bus.now()),
      last_pose_(bus.now()) {
  health_.watchNamesakes();
  bus.subscribe<scan_t>(kScan, [this](const scan_t& message) { hear(message); });
  bus.subscribe<motor_t>(kMotor, [this](const motor_t& message) { hear(message); });
  if (config.fills_in) return;
  // Its own messages also arrive here, and are no input.
  bus.overhear<ins_t>(kIns, [this](const ins_t& message) { hear(message); });
}

void ScanMatchingNode::hear(const scan_t& message) {
  if (!heard_) last_pose_ = bus_.now();
  heard_ = true;
  last_scan_ = bus_.now();
  std::string reason;
  const auto scan = readScan(message, reason);
  if (!scan) return refuse(reason);
  if (scan->last > bus_.now() + kFarthestAhead) return refuse("time is ahead");
  auto sweep = sweepOf(*scan, config_, reason);
  if (!sweep) return refuse(reason);
  sweep->standing = standsAt(sweep->last);
  waiting_.push_back(std::move(*sweep));
  if (waiting_.size() <= kMostWaiting) return;
  waiting_.pop_front();
  refuse("too many at a time");
}

void ScanMatchingNode::hear(const ins_t& message) {
  if (!isOwn(message.utime)) foreign_ = bus_.now();
}

void ScanMatchingNode::hear(const motor_t& message) {
  if (message.utime <= last_motor_) return;
  last_motor_ = message.utime;
  const bool off = commandFrom(message) == Command{};
  if (!off) off_since_.reset();
  if (off && !off_since_) off_since_ = message.utime;
}

/// Motors without MOTOR messages may be on.
bool ScanMatchingNode::standsAt(int64_t utime) const {
  return off_since_ && utime - *off_since_ >= microseconds(config_.standing_after) &&
         utime - last_motor_ <= kMotorAge;
}

bool ScanMatchingNode::isOwn(int64_t utime) const {
  return std::find(own_.begin(), own_.end(), utime) != own_.end();
}

void ScanMatchingNode::refuse(const std::string& reason) {
  last_refusal_ = reason;
  health_.addToCounter("scans refused: " + reason);
}

void ScanMatchingNode::step(int64_t utime) {
  for (; !waiting_.empty(); waiting_.pop_front()) match(waiting_.front());
  reportHealth(utime);
  health_.step(utime);
}

void ScanMatchingNode::match(const Sweep& sweep) {
  const MatchedPose pose = matcher_.take(sweep);
  count(pose);
  if (pose.outcome == MatchOutcome::kNotNewer) return;
  ins_t message = messageOf(pose, seq_++);
  if (last_published_ > 0) {
    const auto interval = static_cast<double>(message.utime - last_published_);
    if (interval_ > 0.0 && interval > 3.0 * interval_) message.ins_status |= ins_t::STATUS_GAP;
    interval_ += (interval_ > 0.0 ? kUsual : 1.0) * (interval - interval_);
  }
  last_published_ = message.utime;
  own_.push_back(message.utime);
  if (own_.size() > kMostOwn) own_.pop_front();
  if (pose.position_known && pose.heading_known) last_pose_ = bus_.now();
  bus_.publish(config_.fills_in ? kScanMatching : kIns, message);
}

void ScanMatchingNode::count(const MatchedPose& pose) {
  health_.addToCounter(wordsOf(pose.outcome));
  if (!pose.position_known) health_.addToCounter("poses without position");
  if (!pose.heading_known) health_.addToCounter("poses without heading");
  if (pose.new_track) health_.addToCounter("new tracks");
  if (pose.outcome != MatchOutcome::kMatched) last_refusal_ = remedyOf(pose.outcome);
}

std::string ScanMatchingNode::problem(int64_t utime) const {
  const int64_t silence = microseconds(config_.silence);
  if (foreign_ && utime - *foreign_ < silence)
    return "another process publishes INS, too; stop ins_driver or scan_matching: the robot takes "
           "its pose from one of them";
  std::ostringstream line;
  if (utime - last_scan_ >= silence) {
    line << "no SCAN for " << (utime - last_scan_) / 1'000'000
         << " s; is lidar_driver running, and its range finder level?";
  } else if (utime - last_pose_ >= silence) {
    line << "no pose for " << (utime - last_pose_) / 1'000'000 << " s: " << last_refusal_;
  }
  return line.str();
}

void ScanMatchingNode::reportHealth(int64_t utime) {
  const std::string line = problem(utime);
  health_.setState(line.empty() ? health_t::HEALTH_OK : health_t::HEALTH_DEGRADED, line);
}

}  // namespace tread::scan_matching
