// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/heading_choice.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/se2.hpp"

namespace tread::ins {
namespace {

/// A longer gap between two velocities can hide a stop and a turn.
constexpr int64_t kMaxPauseUs = 500'000;
/// Within this angle of nose or tail the course is along the axis [rad].
constexpr double kMaxOffAxis = kPi / 3.0;
/// Sideslip angle of straight driving, one sigma [rad].
constexpr double kSideslip = 0.05;
/// A better heading up to this age excludes worse ones [us].
constexpr int64_t kRankHoldUs = 1'000'000;

}  // namespace

void CourseHeading::advance(int64_t utime, const std::optional<GroundVelocity>& velocity,
                            const std::optional<double>& yaw_rate) {
  const int64_t elapsed = utime - utime_;
  utime_ = utime;
  const bool moves = velocity && velocity->speed >= config_.course_min_speed;
  const bool slow = velocity && !moves;
  const bool kept =
      yaw_rate ? elapsed <= kMaxPauseUs : !slow && utime - known_utime_ <= kMaxPauseUs;
  if (!kept) reference_.reset();
  if (reference_ && yaw_rate)
    reference_ = wrapAngle(*reference_ + *yaw_rate * static_cast<double>(elapsed) * 1e-6);
  if (reference_ && (yaw_rate || moves)) known_utime_ = utime;
}

void CourseHeading::learn(double yaw) {
  reference_ = yaw;
  known_utime_ = utime_;
}

std::optional<Heading> CourseHeading::of(const GroundVelocity& velocity, double yaw_rate) {
  if (!velocity.course || velocity.speed < config_.course_min_speed) return std::nullopt;
  const double swing = yaw_rate * config_.p_body_antenna.x();
  const double along = std::sqrt(std::max(0.0, velocity.speed * velocity.speed - swing * swing));
  const double nose_first = wrapAngle(*velocity.course - std::atan2(swing, along));
  const double tail_first = wrapAngle(*velocity.course - std::atan2(swing, -along));
  double yaw = nose_first;
  if (config_.drives_backward) {
    const auto off = [this](double angle) {
      return reference_ ? std::abs(wrapAngle(angle - *reference_)) : kPi;
    };
    if (off(tail_first) < off(nose_first)) yaw = tail_first;
    if (off(yaw) > kMaxOffAxis) {
      ++refused_;
      return std::nullopt;
    }
  }
  learn(yaw);
  const double noise = std::isfinite(velocity.std) ? velocity.std / velocity.speed : 0.0;
  return Heading{yaw, std::hypot(noise, kSideslip)};
}

std::optional<Heading> HeadingChoice::headingOf(const DeviceEpoch& epoch, HeadingSource source,
                                                const std::optional<double>& yaw_rate) {
  if (source != HeadingSource::kCourse) return epoch.headings[static_cast<size_t>(source)];
  return epoch.velocity ? course_.of(*epoch.velocity, yaw_rate.value_or(0.0)) : std::nullopt;
}

bool HeadingChoice::outranked(const DeviceEpoch& epoch, size_t rank, int64_t utime) const {
  const bool better_lately = last_rank_ && *last_rank_ < rank && utime - last_utime_ < kRankHoldUs;
  return better_lately && (!epoch.position || order_[rank] == HeadingSource::kCourse);
}

std::optional<Attitude> HeadingChoice::attitudeOf(const DeviceEpoch& epoch, int64_t utime,
                                                  const std::optional<double>& yaw_rate) {
  course_.advance(utime, epoch.velocity, yaw_rate);
  for (size_t rank = 0; rank < order_.size(); ++rank) {
    const HeadingSource source = order_[rank];
    const bool later = outranked(epoch, rank, utime);
    if (later && source == HeadingSource::kCourse) break;  // the better one is extrapolated instead
    const std::optional<Heading> heading = headingOf(epoch, source, yaw_rate);
    if (!heading) continue;
    if (later) {
      ++counts_.outranked;
      continue;
    }
    ++counts_.used[static_cast<size_t>(source)];
    last_rank_ = rank;
    last_utime_ = utime;
    if (source != HeadingSource::kCourse) course_.learn(heading->yaw);
    return Attitude{heading->yaw, epoch.pitch,     epoch.roll,
                    heading->std, epoch.pitch_std, epoch.roll_std};
  }
  return std::nullopt;
}

void HeadingChoice::clear() {
  course_.clear();
  last_rank_.reset();
}

}  // namespace tread::ins
