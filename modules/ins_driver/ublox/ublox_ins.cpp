// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/ublox/ublox_ins.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "modules/ins_driver/core/bytes.hpp"
#include "modules/ins_driver/core/device_clock.hpp"

namespace tread::ins {
namespace {

constexpr std::string_view kSync("\xB5\x62", 2);
constexpr size_t kHeader = 6;
constexpr size_t kChecksum = 2;

// F9 Interface Description: the section of each message.
struct UbxType {
  uint16_t id;  ///< class and id as in the frame, low byte first
  size_t length;
  size_t time_at;  ///< offset of iTOW
  UbxKind kind;
  const char* name() const { return kUbxKindNames[static_cast<size_t>(kind)]; }
};
constexpr UbxType kTypes[] = {{0x0701, 92, 0, UbxKind::kNavPvt},
                              {0x3C01, 64, 4, UbxKind::kNavRelposned},
                              {0x0501, 32, 0, UbxKind::kNavAtt},
                              {0x1510, 36, 8, UbxKind::kEsfIns}};

constexpr const char* kUsed = "";
constexpr const char* kOutOfRange = "out of range";
constexpr double kMaxSpeed = 600.0;     // [m/s]
constexpr double kMaxHeight = 20000.0;  // [m]
constexpr double kAngle = 1e-5 * kRadPerDeg;

uint16_t fletcher(std::string_view bytes) {
  uint8_t a = 0;
  uint8_t b = 0;
  for (const char byte : bytes) {
    a = static_cast<uint8_t>(a + static_cast<uint8_t>(byte));
    b = static_cast<uint8_t>(b + a);
  }
  return static_cast<uint16_t>(a | b << 8);
}

/// UTC of NAV-PVT [us]; -1 unless date and time are valid and fully resolved.
int64_t utcOf(std::string_view payload) {
  if ((numberAt<uint8_t>(payload, 11) & 7) != 7) return -1;
  const CivilDate date{numberAt<uint16_t>(payload, 4), numberAt<uint8_t>(payload, 6),
                       numberAt<uint8_t>(payload, 7)};
  if (!exists(date)) return -1;
  const int64_t seconds = numberAt<uint8_t>(payload, 8) * 3600 +
                          numberAt<uint8_t>(payload, 9) * 60 + numberAt<uint8_t>(payload, 10);
  const int64_t nanoseconds = numberAt<int32_t>(payload, 16);  // may be negative
  return daysSinceEpoch(date) * kDayUs + seconds * 1'000'000 +
         static_cast<int64_t>(std::floor(static_cast<double>(nanoseconds) * 1e-3 + 0.5));
}

const char* readAtt(std::string_view payload, DeviceEpoch& part) {
  const double heading_std = numberAt<uint32_t>(payload, 28) * kAngle;
  if (heading_std == 0.0) return "no heading";  // the accuracy is null where there is none
  const auto yaw = yawFromAzimuth(numberAt<int32_t>(payload, 16) * 1e-5);
  const double roll = numberAt<int32_t>(payload, 8) * kAngle;
  const double pitch = numberAt<int32_t>(payload, 12) * kAngle;
  if (!yaw || !within(roll, kPi) || !within(pitch, kPi / 2.0)) return kOutOfRange;
  part.heading(HeadingSource::kAttitude) = Heading{*yaw, heading_std};
  part.roll_std = numberAt<uint32_t>(payload, 20) * kAngle;
  part.pitch_std = numberAt<uint32_t>(payload, 24) * kAngle;
  if (part.roll_std > 0.0) part.roll = roll;
  if (part.pitch_std > 0.0) part.pitch = -pitch;
  return kUsed;
}

const char* readEsfIns(std::string_view payload, DeviceEpoch& part) {
  constexpr uint32_t kRatesValid = 7U << 8;
  if ((numberAt<uint32_t>(payload, 0) & kRatesValid) != kRatesValid) return "rates not valid";
  const Eigen::Vector3d rate(numberAt<int32_t>(payload, 12), -numberAt<int32_t>(payload, 16),
                             -numberAt<int32_t>(payload, 20));
  if (!within(rate.norm(), 4e6)) return kOutOfRange;
  part.rate_device = rate * 1e-3 * kRadPerDeg;
  return kUsed;
}

}  // namespace

FrameLook lookForUbx(std::string_view bytes) {
  using Verdict = FrameLook::Verdict;
  const size_t compared = std::min(bytes.size(), kSync.size());
  if (bytes.substr(0, compared) != kSync.substr(0, compared)) return {Verdict::kNoStart};
  if (bytes.size() < kHeader) return {Verdict::kNeedMore};
  const size_t summed = kHeader + numberAt<uint16_t>(bytes, 4);
  const size_t size = summed + kChecksum;
  if (size > kMaxFrame) return {Verdict::kRefused, 0, "too long"};
  if (bytes.size() < size) return {Verdict::kNeedMore};
  if (fletcher(bytes.substr(2, summed - 2)) != numberAt<uint16_t>(bytes, summed))
    return {Verdict::kRefused, 0, "wrong checksum"};
  return {Verdict::kFrame, size};
}

UbloxIns::UbloxIns(const InsConfig& config) : BinaryIns(config, lookForUbx, kWeekUs) {}

InsAdvice UbloxIns::advice() const {
  return {"is the receiver powered, and is UBX output on for this port?", "no good message",
          "does the receiver have a fix, and does it send NAV-PVT?",
          "does it send NAV-RELPOSNED of a moving base, or NAV-ATT?"};
}

Reading UbloxIns::read(std::string_view frame, int64_t arrival) {
  const auto id = numberAt<uint16_t>(frame, 2);
  const auto* type = std::find_if(std::begin(kTypes), std::end(kTypes),
                                  [id](const UbxType& known) { return known.id == id; });
  if (type == std::end(kTypes)) return {"messages", "not known"};
  const std::string_view payload = frame.substr(kHeader, frame.size() - kHeader - kChecksum);
  if (payload.size() != type->length) return {type->name(), "length"};
  const int64_t time_of_week = int64_t{numberAt<uint32_t>(payload, type->time_at)} * 1000;
  if (time_of_week >= kWeekUs) return {type->name(), kOutOfRange};
  DeviceEpoch part;
  const char* refusal = kUsed;
  if (type->kind == UbxKind::kNavPvt) refusal = readPvt(payload, part);
  if (type->kind == UbxKind::kNavRelposned) refusal = readRelposned(payload, part);
  if (type->kind == UbxKind::kNavAtt) refusal = readAtt(payload, part);
  if (type->kind == UbxKind::kEsfIns) {
    refusal = readEsfIns(payload, part);
    const int64_t time = pipeline_.collector().timeOf(time_of_week);
    if (refusal[0] == '\0') pipeline_.assembler().addRate(time, *part.rate_device);
    return {type->name(), refusal};
  }
  if (refusal[0] != '\0') return {type->name(), refusal};
  const bool in_time =
      pipeline_.collector().push(part, static_cast<size_t>(type->kind), time_of_week, arrival);
  return {type->name(), in_time ? kUsed : "late"};
}

const char* UbloxIns::readPvt(std::string_view payload, DeviceEpoch& part) const {
  PositionReport report;
  const auto fix = numberAt<uint8_t>(payload, 20);
  const bool fixed = fix >= 2 && fix <= 4 && (numberAt<uint8_t>(payload, 21) & 1) != 0 &&
                     (numberAt<uint16_t>(payload, 78) & 1) == 0;
  part.device_utc = utcOf(payload);
  part.satellites = numberAt<uint8_t>(payload, 23);
  if (fixed) {
    report.point = pointFromDegrees(numberAt<int32_t>(payload, 28) * 1e-7,
                                    numberAt<int32_t>(payload, 24) * 1e-7);
    const double height = numberAt<int32_t>(payload, 36) * 1e-3;  // above mean sea level
    const Eigen::Vector3d velocity =
        Eigen::Vector3d(numberAt<int32_t>(payload, 48), numberAt<int32_t>(payload, 52),
                        -numberAt<int32_t>(payload, 56)) *
        1e-3;
    if (!report.point || !within(height, kMaxHeight) || !within(velocity.norm(), kMaxSpeed))
      return kOutOfRange;
    if (fix != 2) report.altitude = height;
    // The accuracies cover both horizontal axes.
    const double horizontal = numberAt<uint32_t>(payload, 40) * 1e-3 / std::sqrt(2.0);
    report.std = {horizontal, horizontal, numberAt<uint32_t>(payload, 44) * 1e-3};
    report.starts_map = horizontal <= config_.origin_max_std;
    const double std = numberAt<uint32_t>(payload, 68) * 1e-3 / std::sqrt(2.0);
    part.velocity = groundVelocity(velocity.x(), velocity.y(), velocity.z(), std, 0);
  }
  part.position = report;
  return kUsed;
}

const char* UbloxIns::readRelposned(std::string_view payload, DeviceEpoch& part) const {
  if (numberAt<uint8_t>(payload, 0) != 1) return "version";
  const auto flags = numberAt<uint32_t>(payload, 60);
  constexpr uint32_t kNeeded = 1U << 0 | 1U << 2 | 1U << 5 | 1U << 8;
  constexpr uint32_t kFixed = 2;
  if ((flags & kNeeded) != kNeeded) return "heading not valid";
  if ((flags >> 3 & 3U) != kFixed) return "ambiguities not fixed";
  const auto yaw = yawFromAzimuth(numberAt<int32_t>(payload, 24) * 1e-5);
  if (!yaw) return kOutOfRange;
  part.heading(HeadingSource::kDualAntenna) =
      Heading{wrapAngle(*yaw - config_.baseline_yaw), numberAt<uint32_t>(payload, 52) * kAngle};
  return kUsed;
}

}  // namespace tread::ins
