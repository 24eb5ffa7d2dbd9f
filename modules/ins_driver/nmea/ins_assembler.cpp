// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/nmea/ins_assembler.hpp"

#include <cmath>

#include "common/geometry/se2.hpp"

namespace tread::ins {
namespace {

/// Two headings further apart than this tell no rate: a tracked vehicle can have turned either way.
constexpr int64_t kMaxRateBaseUs = 250'000;

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

/// After this time without a position sentence, instants with attitude alone are published, too.
constexpr int64_t kPositionsExpectedUs = 1'500'000;

/// So many RMC fixes without a GGA in between: this device tells no altitude, the origin need not
/// wait for it.
constexpr int kFixesWithoutGga = 10;

Eigen::Quaterniond rotation(const YawPitchRoll& angles) {
  return Eigen::Quaterniond(isometryFrom(Eigen::Vector3d::Zero(), angles).linear());
}

struct GroundVelocity {
  std::optional<double> speed;
  std::optional<double> course;
};

/// VTG, else RMC: VTG also tells km/h, which are finer than knots.
GroundVelocity groundVelocity(const Epoch& epoch) {
  if (epoch.vtg && epoch.vtg->speed) return {epoch.vtg->speed, epoch.vtg->course};
  if (epoch.rmc && epoch.rmc->speed) return {epoch.rmc->speed, epoch.rmc->course};
  return {};
}

std::optional<GeoPoint> fixOf(const Epoch& epoch) {
  if (epoch.gga) return epoch.gga->position;
  return epoch.rmc ? epoch.rmc->position : std::nullopt;
}

std::optional<double> altitudeOf(const Epoch& epoch) {
  return epoch.gga ? epoch.gga->altitude : std::nullopt;
}

}  // namespace

std::optional<Attitude> attitudeOf(const Epoch& epoch) {
  const Pashr pashr = epoch.pashr.value_or(Pashr{});
  const bool inertial = pashr.yaw.has_value();
  const std::optional<double> yaw = inertial ? pashr.yaw : epoch.hdt.value_or(Hdt{}).yaw;
  if (!yaw) return std::nullopt;
  Attitude attitude;
  attitude.yaw = *yaw;
  attitude.pitch = pashr.pitch;
  attitude.roll = pashr.roll;
  attitude.yaw_std = inertial ? pashr.yaw_std.value_or(kUnmeasured) : kUnmeasured;
  attitude.pitch_std = pashr.pitch ? pashr.pitch_std.value_or(kUnmeasured) : kUnmeasured;
  attitude.roll_std = pashr.roll ? pashr.roll_std.value_or(kUnmeasured) : kUnmeasured;
  return attitude;
}

void AttitudeMemory::add(int64_t utime, const Attitude& attitude) {
  const int64_t base = utime - newest_utime_;
  rate_.reset();
  if (newest_ && base > 0 && base <= kMaxRateBaseUs)
    rate_ = wrapAngle(attitude.yaw - newest_->yaw) / (static_cast<double>(base) * 1e-6);
  newest_ = attitude;
  newest_utime_ = utime;
}

std::optional<Attitude> AttitudeMemory::at(int64_t utime) const {
  const int64_t age = utime - newest_utime_;
  if (!newest_ || age < 0 || age > hold_us_) return std::nullopt;
  if (age == 0) return newest_;
  Attitude attitude = *newest_;
  if (!rate_) return attitude;
  const double turned = *rate_ * static_cast<double>(age) * 1e-6;
  attitude.yaw = wrapAngle(attitude.yaw + turned);
  attitude.yaw_std = std::hypot(attitude.yaw_std, turned);
  return attitude;
}

void AttitudeMemory::complete(int64_t utime, Attitude& attitude) const {
  const int64_t age = utime - newest_utime_;
  if (attitude.pitch || attitude.roll || !newest_ || age < 0 || age > hold_us_) return;
  attitude.pitch = newest_->pitch;
  attitude.roll = newest_->roll;
  attitude.pitch_std = newest_->pitch_std;
  attitude.roll_std = newest_->roll_std;
}

std::optional<double> AttitudeMemory::yawRate(int64_t utime) const {
  const int64_t age = utime - newest_utime_;
  return age >= 0 && age <= hold_us_ ? rate_ : std::nullopt;
}

void AttitudeMemory::clear() {
  newest_.reset();
  rate_.reset();
}

Eigen::Vector3d positionStd(const Gga& gga) {
  const double horizontal =
      rangeError(gga.quality) * gga.hdop.value_or(kUnmeasured) / std::sqrt(2.0);
  return {horizontal, horizontal, 2.0 * horizontal};
}

InsAssembler::InsAssembler(const InsConfig& config)
    : config_(config),
      R_body_device_(rotation(config.body_device)),
      arrival_filter_(config.offset_window_us),
      attitudes_(config.attitude_hold_us),
      monitor_(config) {
  if (config.origin) frame_.emplace(*config.origin);
}

std::optional<GeoOrigin> InsAssembler::origin() const {
  if (!frame_) return std::nullopt;
  return frame_->origin();
}

void InsAssembler::observe(const Epoch& epoch) {
  if (epoch.device_time) arrival_filter_.add(*epoch.device_time, epoch.arrival);
}

int64_t InsAssembler::measurementTime(const Epoch& epoch) const {
  const int64_t without_delay =
      epoch.device_time ? arrival_filter_.hostTime(*epoch.device_time) : epoch.arrival;
  return without_delay - config_.latency_us;
}

bool InsAssembler::positionsAreExpected(int64_t utime) const {
  return last_position_utime_ && utime - *last_position_utime_ < kPositionsExpectedUs;
}

bool InsAssembler::isPublished(const Epoch& epoch, int64_t utime) {
  if (epoch.speaksOfPosition()) {
    last_position_utime_ = utime;
  } else if (!config_.attitude_epochs && positionsAreExpected(utime)) {
    ++counts_.attitude_only;
    return false;
  }
  if (last_utime_ && utime <= *last_utime_) {
    ++counts_.not_newer;
    return false;
  }
  last_utime_ = utime;
  return true;
}

std::optional<InsEstimate> InsAssembler::solve(const Epoch& epoch) {
  ++counts_.epochs;
  if (epoch.clock_was_set) {
    ++counts_.clock_steps;
    new_track_ = true;
    attitudes_.clear();
  }
  InsEstimate estimate;
  estimate.utime = measurementTime(epoch);
  estimate.device_utc = epoch.device_utc;
  std::optional<Attitude> attitude = attitudeOf(epoch);
  if (attitude) {
    attitudes_.complete(estimate.utime, *attitude);
    attitudes_.add(estimate.utime, *attitude);
  }
  if (!isPublished(epoch, estimate.utime)) return std::nullopt;
  if (!attitude) {
    attitude = attitudes_.at(estimate.utime);
    if (attitude) ++counts_.carried;
  }
  setOrientation(attitude, estimate);
  setVelocity(epoch, estimate);
  setPosition(epoch, estimate);
  watchTrack(estimate);
  ++counts_.published;
  return estimate;
}

void InsAssembler::setOrientation(const std::optional<Attitude>& attitude,
                                  InsEstimate& estimate) const {
  if (!attitude) {
    estimate.status |= kNoHeading | kNoAttitude;
    return;
  }
  const double yaw_in_map = attitude->yaw - (frame_ ? frame_->origin().yaw : 0.0);
  const Eigen::Quaterniond R_map_device =
      rotation({yaw_in_map, attitude->pitch.value_or(0.0), attitude->roll.value_or(0.0)});
  estimate.R_map_body = R_map_device * R_body_device_.conjugate();
  estimate.attitude_std = {attitude->roll_std, attitude->pitch_std, attitude->yaw_std};
  if (!attitude->pitch || !attitude->roll) estimate.status |= kNoAttitude;
}

void InsAssembler::setVelocity(const Epoch& epoch, InsEstimate& estimate) const {
  if (epoch.rot && epoch.rot->yaw_rate) estimate.rate_body.z() = *epoch.rot->yaw_rate;
  const GroundVelocity ground = groundVelocity(epoch);
  const bool stands = ground.speed && *ground.speed < config_.standstill_speed;
  if (stands) {
    estimate.v_body.head<2>().setZero();
    return;
  }
  if (!ground.speed || !ground.course || (estimate.status & kNoHeading)) {
    estimate.status |= kNoVelocity;
    return;
  }
  const double course_in_map = *ground.course - (frame_ ? frame_->origin().yaw : 0.0);
  const double angle = course_in_map - yawPitchRoll(estimate.R_map_body).yaw;
  const double measured_rate = estimate.rate_body.z();
  const double rate = std::isfinite(measured_rate)
                          ? measured_rate
                          : attitudes_.yawRate(estimate.utime).value_or(0.0);
  // The device's point swings about the body's origin: v_origin = v_point - omega x p_body_antenna.
  estimate.v_body.x() = *ground.speed * std::cos(angle) + rate * config_.p_body_antenna.y();
  estimate.v_body.y() = *ground.speed * std::sin(angle) - rate * config_.p_body_antenna.x();
}

void InsAssembler::adoptOrigin(const Epoch& epoch) {
  const std::optional<GeoPoint> fix = fixOf(epoch);
  if (frame_ || !fix) return;
  if (epoch.gga) {
    const bool precise = epoch.gga->hdop.value_or(0.0) <= config_.origin_max_hdop;
    if (precise) frame_.emplace(GeoOrigin{*fix, epoch.gga->altitude.value_or(0.0), 0.0});
  } else if (++fixes_without_gga_ >= kFixesWithoutGga) {
    frame_.emplace(GeoOrigin{*fix, 0.0, 0.0});
  }
}

void InsAssembler::setPosition(const Epoch& epoch, InsEstimate& estimate) {
  if (epoch.gga) estimate.satellites = epoch.gga->satellites.value_or(-1);
  adoptOrigin(epoch);
  const std::optional<GeoPoint> fix = fixOf(epoch);
  if (!fix || !frame_) {
    estimate.status |= kNoPosition;
    return;
  }
  const std::optional<double> altitude = altitudeOf(epoch);
  Eigen::Vector3d p_map = frame_->toMap(*fix, altitude.value_or(frame_->origin().altitude));
  if (p_map.head<2>().norm() > config_.max_distance) {
    ++counts_.too_far;
    far_distance_ = p_map.head<2>().norm();
    estimate.status |= kNoPosition;
    return;
  }
  if (!(estimate.status & kNoHeading)) p_map -= estimate.R_map_body * config_.p_body_antenna;
  if (!altitude) p_map.z() = kUnmeasured;
  estimate.p_map_body = p_map;
  setAccuracy(epoch, estimate);
}

void InsAssembler::setAccuracy(const Epoch& epoch, InsEstimate& estimate) const {
  if (!epoch.gga) return;
  const Eigen::Vector3d antenna_std = positionStd(*epoch.gga);
  const double arm = config_.p_body_antenna.head<2>().norm();
  // Without a heading the lever arm points anywhere; with one its end moves by the error of the
  // heading.
  const double yaw_std = estimate.attitude_std.z();
  double arm_std = 0.0;
  if (estimate.status & kNoHeading) {
    arm_std = arm;
  } else if (std::isfinite(yaw_std)) {
    arm_std = arm * yaw_std;
  }
  estimate.position_std = {std::hypot(antenna_std.x(), arm_std),
                           std::hypot(antenna_std.y(), arm_std), antenna_std.z()};
}

void InsAssembler::watchTrack(InsEstimate& estimate) {
  if (monitor_.isGap(estimate.utime)) {
    estimate.status |= kGap;
    ++counts_.gaps;
  }
  bool jump = new_track_;
  new_track_ = false;
  if (!(estimate.status & kNoPosition))
    jump = monitor_.isJump(estimate.utime, estimate.p_map_body) || jump;
  if (jump) {
    estimate.status |= kJump;
    ++counts_.jumps;
  }
}

}  // namespace tread::ins
