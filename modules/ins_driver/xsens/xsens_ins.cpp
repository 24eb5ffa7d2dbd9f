// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/xsens/xsens_ins.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "common/geometry/se3.hpp"
#include "modules/ins_driver/core/bytes.hpp"
#include "modules/ins_driver/core/device_clock.hpp"

namespace tread::ins {
namespace {

constexpr const char* kUsed = "";
constexpr const char* kOutOfRange = "out of range";
constexpr const char* kName = "MTData2";
constexpr double kMaxSpeed = 600.0;     // [m/s]
constexpr double kMaxHeight = 20000.0;  // [m]
constexpr double kMaxRate = 50.0;       // [rad/s], the sensor's limit is 35
constexpr int64_t kTick = 100;          // [us] of SampleTimeFine
constexpr int64_t kCycle = (int64_t{1} << 32) * kTick;
constexpr int64_t kAccuracyAge =
    2'000'000;  // [us] after which a reported accuracy no longer counts
constexpr size_t kPvtLength = 94;

/// Filter mode of StatusWord, bits 23 and 24.
enum Mode : unsigned { kWithoutGnss = 0, kCoasting = 1, kWithGnss = 3 };

/// From UtcTime [us]; -1 if it is absent or not fully valid.
int64_t utcOf(const XbusFields& fields) {
  const std::string_view field = fields.bytes(XbusData::kUtcTime, 12);
  if (field.empty() || (bigEndianAt<uint8_t>(field, 11) & 7U) != 7U) return -1;
  const CivilDate date{bigEndianAt<uint16_t>(field, 4), bigEndianAt<uint8_t>(field, 6),
                       bigEndianAt<uint8_t>(field, 7)};
  if (date.year < 2010 || !exists(date)) return -1;
  const int64_t seconds = bigEndianAt<uint8_t>(field, 8) * 3600 +
                          bigEndianAt<uint8_t>(field, 9) * 60 + bigEndianAt<uint8_t>(field, 10);
  return daysSinceEpoch(date) * kDayUs + seconds * 1'000'000 +
         int64_t{bigEndianAt<uint32_t>(field, 0)} / 1000;
}

/// Yaw, pitch and roll of the device over the map's axes; nullopt if they are absent or no valid
/// attitude.
std::optional<YawPitchRoll> attitudeOf(const XbusFields& fields) {
  const std::vector<double> q = fields.numbers(XbusData::kQuaternion, 4);  // w, x, y, z
  if (!q.empty()) {
    const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
    if (!within(turn.norm() - 1.0, 0.01)) return std::nullopt;
    return yawPitchRoll(turn.normalized());
  }
  const std::vector<double> degrees = fields.numbers(XbusData::kEulerAngles, 3);
  if (degrees.empty() || !within(degrees[0], 180.0) || !within(degrees[1], 90.0) ||
      !within(degrees[2], 360.0))
    return std::nullopt;
  return YawPitchRoll{degrees[2] * kRadPerDeg, degrees[1] * kRadPerDeg, degrees[0] * kRadPerDeg};
}

bool holdsAttitude(const XbusFields& fields) {
  return fields.holds(XbusData::kQuaternion) || fields.holds(XbusData::kEulerAngles);
}

}  // namespace

XsensIns::XsensIns(const InsConfig& config) : BinaryIns(config, lookForXbus, kCycle) {}

InsAdvice XsensIns::advice() const {
  return {"is the device powered, and does it measure (not in its configuration state)?",
          "no good message", "has it GNSS (StatusWord), and does it send LatLon and StatusWord?",
          "has it GNSS (StatusWord), and does it send Quaternion or EulerAngles?"};
}

Reading XsensIns::read(std::string_view frame, int64_t arrival) {
  const std::optional<XbusFields> fields = XbusFields::of(frame);
  if (!fields) return {"messages", "not known"};
  const std::string_view fine = fields->bytes(XbusData::kSampleTimeFine, 4);
  if (fine.empty()) return {kName, "without SampleTimeFine"};
  const int64_t time = int64_t{bigEndianAt<uint32_t>(fine, 0)} * kTick;
  if (const auto pvt = fields->bytes(XbusData::kGnssPvt, kPvtLength); !pvt.empty())
    readGnss(pvt, time);
  const std::string_view status = fields->bytes(XbusData::kStatusWord, 4);
  if (status.empty()) return {kName, "without StatusWord"};
  if (!fields->eastNorthUp()) return {kName, "axes are not east, north, up"};
  const unsigned word = bigEndianAt<uint32_t>(status, 0);
  const unsigned mode = (word & 2U) == 0 ? kWithoutGnss : word >> 23U & 3U;

  DeviceEpoch part;
  const std::vector<double> rate = fields->numbers(XbusData::kRateOfTurn, 3);
  if (!rate.empty()) {
    part.rate_device = Eigen::Vector3d(rate[0], rate[1], rate[2]);
    if (!within(part.rate_device->norm(), kMaxRate)) return {kName, kOutOfRange};
  }
  if (const auto attitude = attitudeOf(*fields)) {
    part.pitch = attitude->pitch;
    part.roll = attitude->roll;
    if (mode == kWithGnss || mode == kCoasting)
      part.heading(HeadingSource::kAttitude) = Heading{wrapAngle(attitude->yaw), kUnmeasured};
  } else if (holdsAttitude(*fields)) {
    return {kName, kOutOfRange};
  }
  if (fields->holds(XbusData::kLatLon)) part.position.emplace();
  if (mode == kWithGnss) {
    const char* refusal = readPlace(*fields, time, part);
    if (refusal[0] != '\0') return {kName, refusal};
  }
  part.device_utc = utcOf(*fields);
  return {kName, pipeline_.collector().push(part, 0, time, arrival) ? kUsed : "late"};
}

void XsensIns::readGnss(std::string_view pvt, int64_t time) {
  const auto metres = [pvt](size_t at) { return bigEndianAt<uint32_t>(pvt, at) * 1e-3; };
  accuracy_ = {time, metres(40), metres(44), metres(68), bigEndianAt<uint8_t>(pvt, 22)};
}

const char* XsensIns::readPlace(const XbusFields& fields, int64_t time, DeviceEpoch& part) const {
  const bool told = accuracy_.time >= 0 && std::abs(time - accuracy_.time) < kAccuracyAge;
  if (part.position) {
    PositionReport& report = *part.position;
    const std::vector<double> place = fields.numbers(XbusData::kLatLon, 2);
    if (place.empty()) return kOutOfRange;
    report.point = pointFromDegrees(place[0], place[1]);
    if (!report.point) return kOutOfRange;
    const std::vector<double> height = fields.numbers(XbusData::kAltitudeEllipsoid, 1);
    if (!height.empty() && !within(height[0], kMaxHeight)) return kOutOfRange;
    if (!height.empty() && config_.geoid_separation)
      report.altitude = height[0] - *config_.geoid_separation;
    if (told) {
      // GNSS reports the radius of a circle; it is divided between two axes.
      const double horizontal = accuracy_.horizontal / std::sqrt(2.0);
      report.std = {horizontal, horizontal, accuracy_.vertical};
      report.starts_map = !(accuracy_.horizontal > config_.origin_max_std);
      part.satellites = accuracy_.satellites;
    }
  }
  const std::vector<double> v = fields.numbers(XbusData::kVelocity, 3);
  if (v.empty()) return fields.holds(XbusData::kVelocity) ? kOutOfRange : kUsed;
  if (!within(std::hypot(v[0], v[1], v[2]), kMaxSpeed)) return kOutOfRange;
  part.velocity = groundVelocity(v[1], v[0], v[2], told ? accuracy_.speed : kUnmeasured, 0);
  return kUsed;
}

}  // namespace tread::ins
