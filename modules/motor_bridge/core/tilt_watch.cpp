// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/tilt_watch.hpp"

#include <cmath>

#include "common/geometry/degrees.hpp"

namespace tread::motor {
namespace {

constexpr int64_t kBump = 100'000;           // [us] for which a limit may be exceeded
constexpr int kBumpMeasurements = 3;         // fewest measurements that must exceed it
constexpr int64_t kWithin = 500'000;         // [us] of good measurements that end it
constexpr double kRelief = 0.05;             // [rad, rad/s] below the limit that counts as good
constexpr int64_t kSilent = 300'000;         // [us] without a measurement
constexpr int64_t kFaultStands = 1'000'000;  // [us]

std::string whole(double angle) {
  return std::to_string(std::lround(toDegrees(angle)));
}

}  // namespace

std::array<TiltWatch::Check, 4> TiltWatch::checks(const InsTilt& tilt) const {
  return {{{"rolled", " deg", tilt.roll, limits_->roll},
           {"pitched", " deg", tilt.pitch, limits_->pitch},
           {"rolling", " deg/s", tilt.roll_rate, limits_->roll_rate},
           {"pitching", " deg/s", tilt.pitch_rate, limits_->pitch_rate}}};
}

Reason TiltWatch::worst(const InsTilt& tilt, double relief) const {
  if (!std::isfinite(tilt.roll) || !std::isfinite(tilt.pitch)) return StopReason::kTiltUnknown;
  for (const Check& check : checks(tilt)) {
    if (std::abs(check.value) > check.limit - relief)
      return {StopReason::kTilt, std::string(check.what) + " " + whole(std::abs(check.value)) +
                                     check.unit + ", limit " + whole(check.limit)};
  }
  return {};
}

void TiltWatch::receive(const InsTilt& tilt, int64_t now) {
  if (!limits_ || (newest_ && tilt.utime <= *newest_)) return;
  newest_ = tilt.utime;
  heard_at_ = now;
  const Reason worst_now = worst(tilt, beyond_.empty() ? 0.0 : kRelief);
  if (worst_now.empty()) {
    bad_ = {};
    good_since_ = good_since_.value_or(tilt.utime);
    if (tilt.utime - *good_since_ >= kWithin) beyond_ = {};
    return;
  }
  good_since_.reset();
  bad_.utime = bad_.utime.value_or(tilt.utime);
  ++bad_.count;
  if (!beyond_.empty()) {
    // Just below the limit the message keeps the excess.
    const Reason passed = worst(tilt, 0.0);
    if (!passed.empty()) beyond_ = passed;
  } else if (bad_.count >= kBumpMeasurements && tilt.utime - *bad_.utime >= kBump) {
    tell(worst_now, now);
  }
}

void TiltWatch::tell(const Reason& what, int64_t now) {
  beyond_ = what;
  began_ = now;
}

Reason TiltWatch::fault(int64_t now) {
  heard_at_ = heard_at_.value_or(now);
  if (limits_ && now - *heard_at_ > kSilent) {
    bad_ = {};
    good_since_.reset();
    if (beyond_.empty()) tell(StopReason::kTiltUnknown, now);
  }
  return !beyond_.empty() && now - began_ <= kFaultStands ? beyond_ : Reason();
}

}  // namespace tread::motor
