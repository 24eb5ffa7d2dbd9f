// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/nmea/nmea_epoch.hpp"

#include <cmath>

namespace tread::ins {
namespace {

double rangeError(FixQuality quality) {
  switch (quality) {
    case FixQuality::kStandard:
    case FixQuality::kPrecise:
      return 3.9;
    case FixQuality::kDifferential:
    case FixQuality::kAugmented:
      return 1.0;
    case FixQuality::kRtkFixed:
      return 0.02;
    case FixQuality::kRtkFloat:
      return 0.4;
    default:
      return kUnmeasured;
  }
}

/// Converts each sentence; the same function name for all, for std::visit.
class Translator {
 public:
  explicit Translator(const InsConfig& config) : config_(config) {}

  DeviceEpoch operator()(const Gga& gga) const {
    PositionReport report;
    report.point = gga.position;
    report.altitude = gga.altitude;
    report.std = positionStd(gga);
    report.starts_map = gga.hdop.value_or(0.0) <= config_.origin_max_hdop;
    report.rank = 1;
    DeviceEpoch part;
    part.position = report;
    part.satellites = gga.satellites.value_or(-1);
    return part;
  }
  DeviceEpoch operator()(const Rmc& rmc) const {
    DeviceEpoch part;
    part.position.emplace();
    part.position->point = rmc.position;
    part.position->complete = false;
    if (rmc.speed) part.velocity = GroundVelocity{*rmc.speed, rmc.course};
    if (rmc.date && rmc.time_of_day)
      part.device_utc = daysSinceEpoch(*rmc.date) * kDayUs + *rmc.time_of_day;
    return part;
  }
  DeviceEpoch operator()(const Vtg& vtg) const {
    DeviceEpoch part;
    if (!vtg.speed) return part;
    part.velocity = GroundVelocity{*vtg.speed, vtg.course};
    part.velocity->rank = 1;
    return part;
  }
  DeviceEpoch operator()(const Hdt& hdt) const {
    DeviceEpoch part;
    if (hdt.yaw) part.heading(HeadingSource::kDualAntenna) = Heading{*hdt.yaw};
    return part;
  }
  DeviceEpoch operator()(const Ths& ths) const { return (*this)(Hdt{ths.yaw}); }
  DeviceEpoch operator()(const Pashr& pashr) const {
    DeviceEpoch part;
    if (pashr.yaw) {
      part.heading(HeadingSource::kAttitude) =
          Heading{*pashr.yaw, pashr.yaw_std.value_or(kUnmeasured)};
    }
    part.pitch = pashr.pitch;
    part.roll = pashr.roll;
    part.pitch_std = pashr.pitch_std.value_or(kUnmeasured);
    part.roll_std = pashr.roll_std.value_or(kUnmeasured);
    return part;
  }
  DeviceEpoch operator()(const Rot& rot) const {
    DeviceEpoch part;
    part.yaw_rate = rot.yaw_rate;
    return part;
  }
  DeviceEpoch operator()(const Zda&) const { return {}; }

 private:
  const InsConfig& config_;
};

}  // namespace

Eigen::Vector3d positionStd(const Gga& gga) {
  const double horizontal =
      rangeError(gga.quality) * gga.hdop.value_or(kUnmeasured) / std::sqrt(2.0);
  return {horizontal, horizontal, 2.0 * horizontal};
}

DeviceEpoch partOf(const NmeaSentence& sentence, const InsConfig& config) {
  return std::visit(Translator(config), sentence);
}

}  // namespace tread::ins
