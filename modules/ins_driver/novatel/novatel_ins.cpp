// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/novatel/novatel_ins.hpp"

#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include "modules/ins_driver/core/bytes.hpp"

namespace tread::ins {
namespace {

// Inertial solution status (manual, "Inertial Solution Status"); the others are not trusted.
constexpr uint32_t kSolutionGood = 3;
constexpr uint32_t kSolutionFree = 6;
constexpr uint32_t kAlignmentComplete = 7;
// Position or velocity type (manual, "Position or Velocity Type").
constexpr uint32_t kSingle = 16;  // below: none, entered manually, or Doppler alone
constexpr uint32_t kL1Int = 48;
constexpr uint32_t kNarrowInt = 50;
/// GPS time is known to a second or better from COARSE on (manual, "GPS Reference Time Status").
constexpr int kCoarse = 100;
constexpr int64_t kInertialHoldUs = 1'000'000;
constexpr double kMaxSpeed = 600.0;     // [m/s], limit of civil receivers
constexpr double kMaxHeight = 20000.0;  // [m]
constexpr double kMaxPerSample = 0.2;   // [rad]: 20 rad/s at 100 Hz

constexpr const char* kUsed = "";
constexpr const char* kOutOfRange = "out of range";
constexpr const char* kNotAligned = "inertial solution not good";

bool goodInertial(uint32_t status) {
  return status == kSolutionGood || status == kSolutionFree || status == kAlignmentComplete;
}

/// North, east, up from an offset on [m/s].
bool setVelocity(std::string_view body, size_t offset, double std, int rank, DeviceEpoch& part) {
  const auto north = numberAt<double>(body, offset);
  const auto east = numberAt<double>(body, offset + 8);
  const auto up = numberAt<double>(body, offset + 16);
  if (!within(north, kMaxSpeed) || !within(east, kMaxSpeed) || !within(up, kMaxSpeed)) return false;
  part.velocity = groundVelocity(north, east, up, std, rank);
  return true;
}

/// Roll (right side down), pitch (nose up), azimuth (clockwise from north) from an offset on [deg].
bool setAttitude(std::string_view body, size_t offset, DeviceEpoch& part) {
  const auto roll = numberAt<double>(body, offset);
  const auto pitch = numberAt<double>(body, offset + 8);
  const std::optional<double> yaw = yawFromAzimuth(numberAt<double>(body, offset + 16));
  if (!yaw || !within(roll, 180.0) || !within(pitch, 90.0)) return false;
  part.heading(HeadingSource::kAttitude) = Heading{*yaw};
  part.roll = roll * kRadPerDeg;
  part.pitch = -pitch * kRadPerDeg;
  return true;
}

/// Three floats, NaN if they are no valid standard deviations.
Eigen::Vector3d stdAt(std::string_view body, size_t first, size_t second, size_t third,
                      double unit) {
  const auto one = [&](size_t offset) {
    const double std = numberAt<float>(body, offset);
    return std > 0.0 && std < 1e6 ? std * unit : kUnmeasured;
  };
  return {one(first), one(second), one(third)};
}

}  // namespace

NovatelIns::NovatelIns(const InsConfig& config)
    : BinaryIns(config, lookForNovatel, 0),
      imu_rate_(config.imu_rate),
      geoid_(config.geoid_separation) {}

InsAdvice NovatelIns::advice() const {
  return {"is the receiver powered, and does it log to this port?", "no good message",
          "does the receiver have a fix, and does it log BESTPOS or INSPVAX?",
          "is SPAN aligned (drive a little), and does it log INSPVAX, INSATT or HEADING?"};
}

NamedCounts NovatelIns::counters() const {
  NamedCounts all = BinaryIns::counters();
  if (weeks_.rollovers() > 0) all.emplace_back("week roll-overs", weeks_.rollovers());
  return all;
}

Reading NovatelIns::read(std::string_view bytes, int64_t arrival) {
  const NovatelFrame frame = frameOf(bytes);
  const NovatelType* type = typeOfId(frame.id);
  if (frame.time_status >= 0) time_status_ = frame.time_status;
  if (!type) return {"messages", "not known"};
  if (frame.body.size() != type->length) return {type->name, "length"};
  return {type->name, use(frame, type->kind, arrival)};
}

bool NovatelIns::inertialIsGood(int64_t time) const {
  return last_inertial_ && std::abs(time - *last_inertial_) < kInertialHoldUs;
}

const char* NovatelIns::use(const NovatelFrame& frame, NovatelKind kind, int64_t arrival) {
  if (time_status_ >= 0 && time_status_ < kCoarse) return "GPS time not known";
  if (frame.week == 0xFFFF || frame.time_of_week >= kWeekUs) return kOutOfRange;
  const int64_t time = weeks_.timeOf(frame.week, frame.time_of_week);
  DeviceEpoch part;
  const char* refusal = kUsed;
  switch (kind) {
    case NovatelKind::kBestpos:
      refusal = readBestpos(frame.body, part);
      break;
    case NovatelKind::kBestvel:
      refusal = readBestvel(frame.body, part);
      break;
    case NovatelKind::kInspva:
      refusal = readInspva(frame.body, part);
      break;
    case NovatelKind::kInspvax:
      refusal = readInspvax(frame.body, part);
      break;
    case NovatelKind::kInsatt:
      refusal = readInsatt(frame.body, part);
      break;
    case NovatelKind::kHeading:
      refusal = readHeading(frame.body, part);
      break;
    case NovatelKind::kCorrimu:
      return readCorrimu(frame.body, time);
  }
  if (refusal[0] != '\0') return refusal;
  const bool inertial = kind == NovatelKind::kInspva || kind == NovatelKind::kInspvax;
  if (inertial) last_inertial_ = time;
  const bool satellite = kind == NovatelKind::kBestpos || kind == NovatelKind::kBestvel;
  if (satellite && inertialIsGood(time)) return kUsed;
  if (const auto& attitude = part.heading(HeadingSource::kAttitude))
    imu_rate_.addYaw(time, attitude->yaw);
  part.device_utc = utcOfGps(time, config_.leap_seconds);
  const bool in_time = pipeline_.collector().push(part, static_cast<size_t>(kind), time, arrival);
  return in_time ? kUsed : "late";
}

const char* NovatelIns::readBestpos(std::string_view body, DeviceEpoch& part) {
  PositionReport report;
  report.at_antenna = true;
  const bool fixed = numberAt<uint32_t>(body, 0) == 0 && numberAt<uint32_t>(body, 4) >= kSingle;
  if (fixed) {
    const auto height = numberAt<double>(body, 16 + 8);
    report.point = pointFromDegrees(numberAt<double>(body, 8), numberAt<double>(body, 16));
    if (!report.point || !within(height, kMaxHeight)) return kOutOfRange;
    report.altitude = height;
    const double geoid = numberAt<float>(body, 32);
    if (within(geoid, 200.0)) geoid_ = geoid;
    const Eigen::Vector3d std = stdAt(body, 44, 40, 48, 1.0);  // latitude's stands first
    report.std = bestpos_std_ = std;
    report.starts_map = std.head<2>().maxCoeff() <= config_.origin_max_std;
    satellites_ = numberAt<uint8_t>(body, 65);
  } else {
    satellites_ = -1;
    bestpos_std_.setConstant(kUnmeasured);
  }
  part.position = report;
  part.satellites = satellites_;
  return kUsed;
}

const char* NovatelIns::readBestvel(std::string_view body, DeviceEpoch& part) const {
  if (numberAt<uint32_t>(body, 0) != 0) return "no solution";
  const auto speed = numberAt<double>(body, 16);
  const std::optional<double> course = yawFromAzimuth(numberAt<double>(body, 24));
  const auto up = numberAt<double>(body, 32);
  if (!within(speed, kMaxSpeed) || speed < 0.0 || !course || !within(up, kMaxSpeed))
    return kOutOfRange;
  part.velocity = GroundVelocity{speed, course, up};
  return kUsed;
}

const char* NovatelIns::readInspva(std::string_view body, DeviceEpoch& part) const {
  if (!goodInertial(numberAt<uint32_t>(body, 84))) return kNotAligned;
  PositionReport report;
  report.point = pointFromDegrees(numberAt<double>(body, 12), numberAt<double>(body, 20));
  const auto height = numberAt<double>(body, 28);  // above the ellipsoid
  if (!report.point || !within(height, kMaxHeight) ||
      !setVelocity(body, 36, kUnmeasured, 1, part) || !setAttitude(body, 60, part))
    return kOutOfRange;
  if (geoid_) report.altitude = height - *geoid_;
  report.complete = geoid_.has_value();
  report.std = bestpos_std_;
  report.rank = 1;
  part.position = report;
  part.satellites = satellites_;
  return kUsed;
}

const char* NovatelIns::readInspvax(std::string_view body, DeviceEpoch& part) {
  if (!goodInertial(numberAt<uint32_t>(body, 0))) return kNotAligned;
  PositionReport report;
  report.point = pointFromDegrees(numberAt<double>(body, 8), numberAt<double>(body, 16));
  const auto height = numberAt<double>(body, 24);  // above mean sea level
  const Eigen::Vector3d velocity_std = stdAt(body, 100, 96, 104, 1.0);
  const double std = std::max(velocity_std.x(), velocity_std.y());
  if (!report.point || !within(height, kMaxHeight) || !setVelocity(body, 36, std, 2, part) ||
      !setAttitude(body, 60, part))
    return kOutOfRange;
  const double geoid = numberAt<float>(body, 32);
  if (within(geoid, 200.0)) geoid_ = geoid;
  report.altitude = height;
  report.std = stdAt(body, 88, 84, 92, 1.0);
  report.starts_map = report.std.head<2>().maxCoeff() <= config_.origin_max_std;
  report.rank = 2;
  part.position = report;
  const Eigen::Vector3d attitude_std = stdAt(body, 108, 112, 116, kRadPerDeg);
  part.roll_std = attitude_std.x();
  part.pitch_std = attitude_std.y();
  part.heading(HeadingSource::kAttitude)->std = attitude_std.z();
  part.satellites = satellites_;
  return kUsed;
}

const char* NovatelIns::readInsatt(std::string_view body, DeviceEpoch& part) const {
  if (!goodInertial(numberAt<uint32_t>(body, 36))) return kNotAligned;
  return setAttitude(body, 12, part) ? kUsed : kOutOfRange;
}

const char* NovatelIns::readHeading(std::string_view body, DeviceEpoch& part) const {
  const auto type = numberAt<uint32_t>(body, 4);
  if (numberAt<uint32_t>(body, 0) != 0) return "no solution";
  if (type < kL1Int || type > kNarrowInt) return "ambiguities not fixed";
  const std::optional<double> yaw = yawFromAzimuth(numberAt<float>(body, 12));
  if (!yaw) return kOutOfRange;
  const double std = stdAt(body, 24, 24, 24, kRadPerDeg).x();
  part.heading(HeadingSource::kDualAntenna) = Heading{wrapAngle(*yaw - config_.baseline_yaw), std};
  return kUsed;
}

const char* NovatelIns::readCorrimu(std::string_view body, int64_t time) {
  // About right (the manual calls it pitch), forward (roll) and up (yaw) [rad per sample].
  const auto right = numberAt<double>(body, 12);
  const auto forward = numberAt<double>(body, 20);
  const auto up = numberAt<double>(body, 28);
  if (!within(right, kMaxPerSample) || !within(forward, kMaxPerSample) ||
      !within(up, kMaxPerSample))
    return kOutOfRange;
  imu_rate_.addSample(time, up);
  if (!imu_rate_.rate()) return "samples a second not known yet; configure imu_rate";
  pipeline_.assembler().addRate(time, *imu_rate_.rate() * Eigen::Vector3d(forward, -right, up));
  return kUsed;
}

}  // namespace tread::ins
