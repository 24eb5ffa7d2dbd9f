// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/fill_in.hpp"

#include <algorithm>
#include <cmath>

namespace tread::ins {
namespace {

constexpr int64_t kMaxGap = 300'000;  // [us] between poses of the device around one of a scan
constexpr int64_t kScansMissing = 1'000'000;  // [us] without one, after which nothing is filled in
constexpr int64_t kCarried =
    150'000;  // [us] for which a scan's pose is extrapolated with its twist

double square(double value) {
  return value * value;
}

/// A deviation that the device does not report adds nothing: its own is then unknown, not the
/// drift.
double told(double std) {
  return std::isfinite(std) ? std : 0.0;
}

}  // namespace

std::optional<int64_t> FillIn::newestScan() const {
  return scan_ ? std::optional<int64_t>(scan_->utime) : std::nullopt;
}

void FillIn::observe(const ScanPose& pose) {
  if (scan_ && pose.utime <= scan_->utime) return;
  if (pose.new_track) {
    scans_.clear();
    anchor_.reset();
  }
  scan_ = pose;
  scans_.push(pose.utime, pose.T_scan_body);
  anchor();
}

/// Either of the two may arrive later.
void FillIn::anchor() {
  if (!scan_ || (anchor_ && anchor_->scan.utime == scan_->utime)) return;
  const auto T_map_body = device_.at(scan_->utime, kMaxGap);
  if (T_map_body) anchor_ = Anchor{*T_map_body, device_std_, device_z_, *scan_};
}

std::optional<FillIn::Filled> FillIn::at(int64_t utime) const {
  if (!anchor_ || utime > scan_->utime + kCarried) return std::nullopt;
  auto T_scan_body = scans_.at(utime, kMaxGap);
  if (!T_scan_body) {
    if (utime < scan_->utime) return std::nullopt;
    T_scan_body = scan_->T_scan_body *
                  integrate(scan_->v_body, 1e-6 * static_cast<double>(utime - scan_->utime));
  }
  Filled filled;
  const Pose2 moved = between(anchor_->scan.T_scan_body, *T_scan_body);
  filled.T_map_body = anchor_->T_map_body * moved;
  filled.v_body = scan_->v_body;
  Eigen::Vector3d drift;
  for (int i = 0; i < 3; ++i)
    drift[i] = std::sqrt(std::max(0.0, square(scan_->std[i]) - square(anchor_->scan.std[i])));
  // The two frames are rotated relative to each other by an unknown angle.
  drift[0] = drift[1] = std::max(drift[0], drift[1]);
  if (drift[0] > config_.max_drift || drift[2] > config_.max_yaw_drift) return std::nullopt;
  const double swing = moved.position().norm() * told(anchor_->device_std[2]);
  filled.std = {std::sqrt(square(anchor_->device_std[0]) + square(drift[0]) + square(swing)),
                std::sqrt(square(anchor_->device_std[1]) + square(drift[1]) + square(swing)),
                std::hypot(anchor_->device_std[2], drift[2])};
  return filled;
}

void FillIn::markFilled(int64_t utime) {
  if (!since_) since_ = utime;
  ++filled_;
}

/// A complete pose of the device: the scan track is aligned with it or, after an outage, it is
/// checked against the scan track.
void FillIn::measured(InsEstimate& estimate) {
  const Pose2 T_map_body{estimate.p_map_body.x(), estimate.p_map_body.y(),
                         yawPitchRoll(estimate.R_map_body).yaw};
  if (since_) {
    const auto expected = at(estimate.utime);
    const bool far =
        expected &&
        (distanceBetween(expected->T_map_body, T_map_body) > config_.jump ||
         std::abs(wrapAngle(expected->T_map_body.yaw - T_map_body.yaw)) > config_.yaw_jump);
    if (far) estimate.status |= InsStatus::kJump;
    since_.reset();
  }
  if (estimate.status & InsStatus::kJump) {
    device_.clear();
    anchor_.reset();
  }
  device_.push(estimate.utime, T_map_body);
  device_std_ = {estimate.position_std.x(), estimate.position_std.y(), estimate.attitude_std.z()};
  device_z_ = estimate.p_map_body.z();
  anchor();
}

bool FillIn::complete(InsEstimate& estimate, int64_t now) {
  heard_ = now;
  if (last_utime_ && estimate.utime <= *last_utime_) return false;
  last_utime_ = estimate.utime;
  const bool no_position = (estimate.status & InsStatus::kNoPosition) != 0;
  const bool no_heading = (estimate.status & InsStatus::kNoHeading) != 0;
  if (!no_position && !no_heading) {
    measured(estimate);
    return true;
  }
  const auto filled = at(estimate.utime);
  if (!filled) {
    since_.reset();
    return true;
  }
  if (no_heading) {
    estimate.R_map_body = Eigen::AngleAxisd(filled->T_map_body.yaw, Eigen::Vector3d::UnitZ());
    estimate.attitude_std = {kUnmeasured, kUnmeasured, filled->std[2]};
    estimate.rate_body.z() = filled->v_body.omega;
    estimate.status |= InsStatus::kNoAttitude;
  }
  if (no_position) {
    estimate.p_map_body = {filled->T_map_body.x, filled->T_map_body.y, anchor_->z};
    estimate.position_std = {filled->std[0], filled->std[1], kUnmeasured};
  } else {
    // The device's reference point was used for the body: now the direction of the lever arm is
    // known.
    estimate.p_map_body -= estimate.R_map_body * estimate.p_body_point;
    const double arm = estimate.p_body_point.head<2>().norm();
    const double gained = square(arm) * (1.0 - square(filled->std[2]));
    for (int i = 0; i < 2; ++i)
      estimate.position_std[i] =
          std::sqrt(std::max(0.0, square(estimate.position_std[i]) - gained));
  }
  if (estimate.status & InsStatus::kNoVelocity)
    estimate.v_body = {filled->v_body.v_x, filled->v_body.v_y, kUnmeasured};
  estimate.status &= ~(InsStatus::kNoPosition | InsStatus::kNoHeading | InsStatus::kNoVelocity);
  estimate.status |= InsStatus::kFilledIn;
  markFilled(estimate.utime);
  return true;
}

std::optional<InsEstimate> FillIn::next(int64_t now) {
  if (!scan_ || now < heard_ + config_.after_us) return std::nullopt;
  if (now > scan_->utime + kScansMissing) since_.reset();
  if (last_utime_ && scan_->utime <= *last_utime_) return std::nullopt;
  const auto filled = at(scan_->utime);
  if (!filled) {
    since_.reset();
    return std::nullopt;
  }
  InsEstimate estimate;
  estimate.utime = scan_->utime;
  estimate.p_map_body = {filled->T_map_body.x, filled->T_map_body.y, anchor_->z};
  estimate.R_map_body = Eigen::AngleAxisd(filled->T_map_body.yaw, Eigen::Vector3d::UnitZ());
  estimate.v_body = {filled->v_body.v_x, filled->v_body.v_y, kUnmeasured};
  estimate.rate_body.z() = filled->v_body.omega;
  estimate.position_std = {filled->std[0], filled->std[1], kUnmeasured};
  estimate.attitude_std.z() = filled->std[2];
  estimate.status = InsStatus::kNoAttitude | InsStatus::kFilledIn;
  last_utime_ = estimate.utime;
  markFilled(estimate.utime);
  return estimate;
}

}  // namespace tread::ins
