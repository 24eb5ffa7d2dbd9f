// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/vectornav/vectornav_ins.hpp"

#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "common/geometry/se3.hpp"
#include "modules/ins_driver/core/bytes.hpp"
#include "modules/ins_driver/core/device_clock.hpp"

namespace tread::ins {
namespace {

constexpr const char* kUsed = "";
constexpr const char* kOutOfRange = "out of range";
constexpr const char* kName = "binary output";
constexpr double kMaxSpeed = 600.0;     // [m/s]
constexpr double kMaxHeight = 20000.0;  // [m]
constexpr double kMaxRate = 50.0;       // [rad/s], the sensor's limit is 35
constexpr int64_t kYear2010Us =
    int64_t{30} * 365 * kDayUs;  // of GPS time: no earlier time is valid

/// Mode of InsStatus, bits 0 and 1.
enum Mode : unsigned { kNotTracking = 0, kAligning = 1, kTracking = 2, kOutage = 3 };

/// The field of one group, otherwise of another.
std::string_view either(const VectornavFields& fields, VnGroup group, size_t bit, VnGroup other,
                        size_t other_bit) {
  const std::string_view field = fields.field(group, bit);
  return field.empty() ? fields.field(other, other_bit) : field;
}

/// Three numbers of a field.
template <class Number>
Eigen::Vector3d vectorAt(std::string_view field) {
  return {static_cast<double>(numberAt<Number>(field, 0)),
          static_cast<double>(numberAt<Number>(field, sizeof(Number))),
          static_cast<double>(numberAt<Number>(field, 2 * sizeof(Number)))};
}

std::optional<int64_t> gpsTime(const VectornavFields& fields) {
  const std::string_view field = either(fields, VnGroup::kCommon, 1, VnGroup::kTime, 1);
  if (field.empty()) return std::nullopt;
  const auto time = static_cast<int64_t>(numberAt<uint64_t>(field, 0) / 1000);
  if (time < kYear2010Us || time > 4 * kYear2010Us) return std::nullopt;
  return time;
}

/// From TimeUTC [us]; -1 if it is absent or invalid.
int64_t toldUtc(const VectornavFields& fields) {
  const std::string_view field = either(fields, VnGroup::kTime, 6, VnGroup::kGnss, 0);
  const CivilDate date{2000 + numberAt<int8_t>(field, 0), numberAt<uint8_t>(field, 1),
                       numberAt<uint8_t>(field, 2)};
  if (field.empty() || date.year < 2010 || !exists(date)) return -1;
  const int64_t seconds = numberAt<uint8_t>(field, 3) * 3600 + numberAt<uint8_t>(field, 4) * 60 +
                          numberAt<uint8_t>(field, 5);
  return daysSinceEpoch(date) * kDayUs + seconds * 1'000'000 +
         int64_t{numberAt<uint16_t>(field, 6)} * 1000;
}

/// Yaw, pitch, roll in our convention, from the quaternion, otherwise from the angles.
/** False if a field is present but no valid attitude. */
bool setAttitude(const VectornavFields& fields, DeviceEpoch& part) {
  YawPitchRoll ned;  // yaw clockwise from north, pitch nose up, roll right side down [rad]
  const std::string_view quaternion = either(fields, VnGroup::kAttitude, 2, VnGroup::kCommon, 4);
  const std::string_view angles = either(fields, VnGroup::kAttitude, 1, VnGroup::kCommon, 3);
  if (!quaternion.empty()) {
    const Eigen::Vector3d v = vectorAt<float>(quaternion);  // x, y, z, then w
    const Eigen::Quaterniond q(numberAt<float>(quaternion, 12), v.x(), v.y(), v.z());
    if (!within(q.norm() - 1.0, 0.01)) return false;
    ned = yawPitchRoll(q.normalized());
  } else if (!angles.empty()) {
    const Eigen::Vector3d degrees = vectorAt<float>(angles);
    if (!within(degrees.x(), 360.0) || !within(degrees.y(), 90.0) || !within(degrees.z(), 180.0))
      return false;
    ned = {degrees.x() * kRadPerDeg, degrees.y() * kRadPerDeg, degrees.z() * kRadPerDeg};
  } else {
    return true;
  }
  const Eigen::Vector3d std = vectorAt<float>(fields.field(VnGroup::kAttitude, 8)) * kRadPerDeg;
  const auto told = [](double value) { return value > 0.0 ? value : kUnmeasured; };
  part.heading(HeadingSource::kAttitude) = Heading{wrapAngle(kPi / 2.0 - ned.yaw), told(std.x())};
  part.pitch = -ned.pitch;
  part.roll = ned.roll;
  part.pitch_std = told(std.y());
  part.roll_std = told(std.z());
  return true;
}

bool setRate(const VectornavFields& fields, DeviceEpoch& part) {
  const std::string_view field = either(fields, VnGroup::kImu, 10, VnGroup::kCommon, 5);
  if (field.empty()) return true;
  const Eigen::Vector3d rate = vectorAt<float>(field);
  if (!within(rate.norm(), kMaxRate)) return false;
  part.rate_device = Eigen::Vector3d(rate.x(), -rate.y(), -rate.z());
  return true;
}

}  // namespace

VectornavIns::VectornavIns(const InsConfig& config) : BinaryIns(config, lookForVectornav, 0) {}

InsAdvice VectornavIns::advice() const {
  return {"is the device powered, and is binary output on for this port?", "no good message",
          "does it track (InsStatus), and does its message hold PosLla and InsStatus?",
          "does it track (InsStatus), and does its message hold Quaternion or Ypr?"};
}

Reading VectornavIns::read(std::string_view frame, int64_t arrival) {
  const VectornavFields fields(frame);
  const std::string_view status = either(fields, VnGroup::kIns, 0, VnGroup::kCommon, 12);
  const std::string_view startup = either(fields, VnGroup::kCommon, 0, VnGroup::kTime, 0);
  const std::optional<int64_t> gps = gpsTime(fields);
  if (status.empty()) return {kName, "without InsStatus"};
  if (startup.empty() && !gps) return {kName, "without a time"};
  DeviceEpoch part;
  const unsigned mode = numberAt<uint16_t>(status, 0) & 3U;
  if (!setRate(fields, part)) return {kName, kOutOfRange};
  if ((mode == kTracking || mode == kOutage) && !setAttitude(fields, part))
    return {kName, kOutOfRange};
  if (!either(fields, VnGroup::kIns, 1, VnGroup::kCommon, 6).empty()) part.position.emplace();
  if (mode == kTracking || mode == kAligning) {
    const char* refusal = readPlace(fields, part);
    if (refusal[0] != '\0') return {kName, refusal};
  }
  part.device_utc = gps ? utcOfGps(*gps, config_.leap_seconds) : toldUtc(fields);
  const auto since_start = static_cast<int64_t>(numberAt<uint64_t>(startup, 0) / 1000 % INT64_MAX);
  const int64_t time = startup.empty() ? *gps : since_start;
  return {kName, pipeline_.collector().push(part, 0, time, arrival) ? kUsed : "late"};
}

const char* VectornavIns::readPlace(const VectornavFields& fields, DeviceEpoch& part) const {
  const std::string_view place = either(fields, VnGroup::kIns, 1, VnGroup::kCommon, 6);
  const std::string_view velocity = either(fields, VnGroup::kIns, 4, VnGroup::kCommon, 7);
  if (!place.empty()) {
    PositionReport& report = *part.position;
    const Eigen::Vector3d lla = vectorAt<double>(place);
    report.point = pointFromDegrees(lla.x(), lla.y());
    if (!report.point || !within(lla.z(), kMaxHeight)) return kOutOfRange;
    if (config_.geoid_separation) report.altitude = lla.z() - *config_.geoid_separation;
    const double std = numberAt<float>(fields.field(VnGroup::kIns, 9), 0);
    if (std > 0.0) report.std.setConstant(std);
    report.starts_map = !(std > config_.origin_max_std);
  }
  if (!velocity.empty()) {
    const Eigen::Vector3d ned = vectorAt<float>(velocity);
    if (!within(ned.norm(), kMaxSpeed)) return kOutOfRange;
    const double std = numberAt<float>(fields.field(VnGroup::kIns, 10), 0);
    part.velocity = groundVelocity(ned.x(), ned.y(), -ned.z(), std > 0.0 ? std : kUnmeasured, 0);
  }
  if (const auto count = fields.field(VnGroup::kGnss, 3); !count.empty())
    part.satellites = numberAt<uint8_t>(count, 0);
  return kUsed;
}

}  // namespace tread::ins
