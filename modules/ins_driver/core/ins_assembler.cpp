// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/ins_assembler.hpp"

#include <cmath>
#include <cstdlib>
#include <utility>

#include "common/geometry/se2.hpp"

namespace tread::ins {
namespace {

/// After this time without a position message, instants with only an attitude are published, too.
constexpr int64_t kPositionsExpectedUs = 1'500'000;

/// After this many fixes without an altitude over this long, the device is assumed to send none:
/// the origin need not wait for it.
constexpr int kIncompleteFixes = 10;
constexpr int64_t kIncompleteUs = 1'200'000;

Eigen::Quaterniond rotation(const YawPitchRoll& angles) {
  return Eigen::Quaterniond(isometryFrom(Eigen::Vector3d::Zero(), angles).linear());
}

double yawOf(const std::optional<LocalFrame>& frame) {
  return frame ? frame->origin().yaw : 0.0;
}

}  // namespace

InsAssembler::InsAssembler(const InsConfig& config)
    : config_(config),
      R_body_device_(rotation(config.body_device)),
      arrival_filter_(config.offset_window_us),
      headings_(config),
      attitudes_(config.attitude_hold_us),
      positions_(config.position_hold_us),
      monitor_(config) {
  if (config.origin) frame_.emplace(*config.origin);
}

std::optional<GeoOrigin> InsAssembler::origin() const {
  if (!frame_) return std::nullopt;
  return frame_->origin();
}

void InsAssembler::observe(const DeviceEpoch& epoch) {
  if (epoch.device_time) arrival_filter_.add(*epoch.device_time, epoch.arrival);
}

void InsAssembler::addRate(int64_t device_time, const Eigen::Vector3d& rate_device) {
  rate_ = {device_time, rate_device};
}

int64_t InsAssembler::measurementTime(const DeviceEpoch& epoch) const {
  const int64_t without_delay =
      epoch.device_time ? arrival_filter_.hostTime(*epoch.device_time) : epoch.arrival;
  return without_delay - config_.latency_us;
}

bool InsAssembler::positionsAreExpected(int64_t utime) const {
  return last_position_utime_ && utime - *last_position_utime_ < kPositionsExpectedUs;
}

bool InsAssembler::isPublished(const DeviceEpoch& epoch, int64_t utime) {
  if (epoch.position) {
    last_position_utime_ = utime;
  } else if (positionsAreExpected(utime)) {
    const bool turned = epoch.headings[0] || epoch.headings[1];
    if (!config_.attitude_epochs || !turned || !positions_.at(utime)) {
      ++counts_.attitude_only;
      return false;
    }
  }
  if (last_utime_ && utime <= *last_utime_) {
    ++counts_.not_newer;
    return false;
  }
  last_utime_ = utime;
  return true;
}

void InsAssembler::countInputs(const DeviceEpoch& epoch, int64_t utime) {
  if (epoch.position) counts_.positions.add(utime, config_.position_hold_us);
  if (epoch.velocity) counts_.velocities.add(utime, config_.position_hold_us);
  if (epoch.headings[0] || epoch.headings[1]) counts_.headings.add(utime, config_.attitude_hold_us);
}

void InsAssembler::forget() {
  ++counts_.clock_steps;
  new_track_ = true;
  monitor_.restart();
  attitudes_.clear();
  positions_.clear();
  headings_.clear();
  velocity_.reset();
}

std::optional<InsEstimate> InsAssembler::solve(const DeviceEpoch& epoch) {
  ++counts_.epochs;
  if (epoch.clock_was_set) forget();
  InsEstimate estimate;
  estimate.utime = measurementTime(epoch);
  countInputs(epoch, estimate.utime);
  estimate.device_utc = epoch.device_utc;
  setRate(epoch, estimate);
  const double turn = estimate.rate_body.z();
  std::optional<Attitude> attitude = headings_.attitudeOf(
      epoch, estimate.utime, std::isfinite(turn) ? std::optional<double>(turn) : std::nullopt);
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
  if (epoch.velocity) {
    velocity_ = epoch.velocity;
    velocity_utime_ = estimate.utime;
  }
  setVelocity(epoch.position ? epoch.velocity : velocityAt(estimate), armOf(epoch), estimate);
  if (!setPosition(epoch, estimate)) {
    ++counts_.doubted;
    return std::nullopt;
  }
  watchTrack(estimate);
  ++counts_.published;
  if (estimate.status & InsStatus::kNoHeading) ++counts_.without_heading;
  // Without a heading a velocity has no direction in the body.
  if ((estimate.status & (InsStatus::kNoVelocity | InsStatus::kNoHeading)) ==
      InsStatus::kNoVelocity)
    ++counts_.without_velocity;
  return estimate;
}

void InsAssembler::setRate(const DeviceEpoch& epoch, InsEstimate& estimate) const {
  if (epoch.rate_device) {
    estimate.rate_body = R_body_device_ * *epoch.rate_device;
  } else if (rate_ && epoch.device_time &&
             std::abs(*epoch.device_time - rate_->device_time) <= config_.attitude_hold_us) {
    estimate.rate_body = R_body_device_ * rate_->rate_device;
  }
  if (epoch.yaw_rate) estimate.rate_body.z() = *epoch.yaw_rate;
}

void InsAssembler::setOrientation(const std::optional<Attitude>& attitude,
                                  InsEstimate& estimate) const {
  if (!attitude) {
    estimate.status |= InsStatus::kNoHeading | InsStatus::kNoAttitude;
    return;
  }
  const Eigen::Quaterniond R_map_device = rotation(
      {attitude->yaw - yawOf(frame_), attitude->pitch.value_or(0.0), attitude->roll.value_or(0.0)});
  estimate.R_map_body = R_map_device * R_body_device_.conjugate();
  estimate.attitude_std = {attitude->roll_std, attitude->pitch_std, attitude->yaw_std};
  if (!attitude->pitch || !attitude->roll) estimate.status |= InsStatus::kNoAttitude;
}

double InsAssembler::yawRateOf(const InsEstimate& estimate) const {
  const double measured = estimate.rate_body.z();
  return std::isfinite(measured) ? measured : attitudes_.yawRate(estimate.utime).value_or(0.0);
}

std::optional<GroundVelocity> InsAssembler::velocityAt(const InsEstimate& estimate) const {
  const int64_t age_us = estimate.utime - velocity_utime_;
  if (!velocity_ || age_us > config_.position_hold_us) return std::nullopt;
  GroundVelocity velocity = *velocity_;
  if (velocity.course) *velocity.course += yawRateOf(estimate) * static_cast<double>(age_us) * 1e-6;
  return velocity;
}

void InsAssembler::setVelocity(const std::optional<GroundVelocity>& ground,
                               const Eigen::Vector3d& arm, InsEstimate& estimate) const {
  const bool stands = ground && ground->speed < config_.standstill_speed;
  if (stands) {
    estimate.v_body.head<2>().setZero();
    return;
  }
  if (!ground || !ground->course || (estimate.status & InsStatus::kNoHeading)) {
    estimate.status |= InsStatus::kNoVelocity;
    return;
  }
  const double course_in_map = *ground->course - yawOf(frame_);
  const double angle = course_in_map - yawPitchRoll(estimate.R_map_body).yaw;
  const double rate = yawRateOf(estimate);
  // The reference point swings about the body's origin: v_origin = v_point - omega x arm.
  estimate.v_body.x() = ground->speed * std::cos(angle) + rate * arm.y();
  estimate.v_body.y() = ground->speed * std::sin(angle) - rate * arm.x();
  // Up only where roll and pitch rates are measured: NaN in them stays NaN.
  estimate.v_body.z() =
      ground->up - (estimate.rate_body.x() * arm.y() - estimate.rate_body.y() * arm.x());
}

std::optional<Eigen::Vector2d> InsAssembler::velocityInMap(const GroundVelocity& ground) const {
  if (ground.speed < config_.standstill_speed) return Eigen::Vector2d::Zero();
  if (!ground.course) return std::nullopt;
  const double angle = *ground.course - yawOf(frame_);
  return Eigen::Vector2d(ground.speed * std::cos(angle), ground.speed * std::sin(angle));
}

void InsAssembler::adoptOrigin(const PositionReport& report, int64_t utime) {
  if (frame_ || !report.point) return;
  if (report.complete) {
    if (report.starts_map)
      frame_.emplace(GeoOrigin{*report.point, report.altitude.value_or(0.0), 0.0});
    return;
  }
  if (incomplete_fixes_++ == 0) first_incomplete_ = utime;
  const bool waited = utime - first_incomplete_ >= kIncompleteUs;
  if (incomplete_fixes_ >= kIncompleteFixes && waited && report.starts_map)
    frame_.emplace(GeoOrigin{*report.point, 0.0, 0.0});
}

Eigen::Vector3d InsAssembler::armOf(const DeviceEpoch& epoch) const {
  const bool at_antenna = epoch.position && epoch.position->at_antenna;
  return at_antenna ? config_.p_body_gnss.value_or(config_.p_body_antenna) : config_.p_body_antenna;
}

std::optional<PointInMap> InsAssembler::pointOf(const DeviceEpoch& epoch) {
  const PositionReport& report = *epoch.position;
  if (!report.point || !frame_) return std::nullopt;
  PointInMap point;
  point.p_map = frame_->toMap(*report.point, report.altitude.value_or(frame_->origin().altitude));
  const double distance = point.p_map.head<2>().norm();
  if (distance > config_.max_distance) {
    ++counts_.too_far;
    far_distance_ = distance;
    return std::nullopt;
  }
  if (!report.altitude) point.p_map.z() = kUnmeasured;
  const double c = std::cos(frame_->origin().yaw);
  const double s = std::sin(frame_->origin().yaw);
  point.std = {std::hypot(c * report.std.x(), s * report.std.y()),
               std::hypot(s * report.std.x(), c * report.std.y()), report.std.z()};
  point.p_body = armOf(epoch);
  point.satellites = epoch.satellites;
  return point;
}

bool InsAssembler::setPosition(const DeviceEpoch& epoch, InsEstimate& estimate) {
  estimate.satellites = epoch.satellites;
  std::optional<PointInMap> point;
  if (epoch.position) {
    adoptOrigin(*epoch.position, estimate.utime);
    point = pointOf(epoch);
    if (!point) positions_.clear();
  } else {
    point = positions_.at(estimate.utime);
    if (point) ++counts_.positions_carried;
  }
  if (!point) {
    estimate.status |= InsStatus::kNoPosition;
    return true;
  }
  place(*point, estimate);
  const TrackStep step = monitor_.judge(estimate.utime, estimate.p_map_body);
  if (step == TrackStep::kDoubted) return false;
  if (epoch.position) remember(epoch, *point, estimate.utime);
  if (step == TrackStep::kJump) new_track_ = true;
  return true;
}

void InsAssembler::remember(const DeviceEpoch& epoch, const PointInMap& point, int64_t utime) {
  if (epoch.velocity) {
    positions_.add(utime, point, velocityInMap(*epoch.velocity), epoch.velocity->std);
  } else {
    positions_.add(utime, point, std::nullopt, kUnmeasured);
  }
}

void InsAssembler::place(const PointInMap& point, InsEstimate& estimate) const {
  const bool has_heading = !(estimate.status & InsStatus::kNoHeading);
  estimate.p_map_body = point.p_map;
  estimate.p_body_point = point.p_body;
  if (has_heading) estimate.p_map_body -= estimate.R_map_body * point.p_body;
  estimate.satellites = point.satellites;
  const double arm = point.p_body.head<2>().norm();
  // Without a heading the lever arm's direction is unknown; with one its end moves by the heading's
  // error.
  const double yaw_std = estimate.attitude_std.z();
  const double told_std = std::isfinite(yaw_std) ? arm * yaw_std : 0.0;
  const double arm_std = has_heading ? told_std : arm;
  estimate.position_std = {std::hypot(point.std.x(), arm_std), std::hypot(point.std.y(), arm_std),
                           point.std.z()};
}

void InsAssembler::watchTrack(InsEstimate& estimate) {
  if (monitor_.isGap(estimate.utime)) {
    estimate.status |= InsStatus::kGap;
    ++counts_.gaps;
  }
  if (std::exchange(new_track_, false)) {
    estimate.status |= InsStatus::kJump;
    ++counts_.jumps;
  }
}

}  // namespace tread::ins
