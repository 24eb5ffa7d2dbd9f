// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/felt_shock.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tread::learner {
namespace {

constexpr double kBinSeconds = static_cast<double>(FeltShock::kBin) * 1e-6;
/// Measurements of a bin below which it counts as a gap.
constexpr int kLeastCount = 2;
/// Below this speed the vehicle stands, and the signal is noise [m/s].
constexpr double kStanding = 0.02;
/// Weight of one bin in the estimate of the noise.
constexpr double kNoiseGain = 0.05;
/// Lower limit, because the logarithm needs a positive number [m2/s4].
constexpr double kLeastSquare = 1e-4;

}  // namespace

void FeltShock::restart() {
  bin_ = {};
  last_.clear();
  segment_ = {};
  way_ = 0.0;
  count_ = 0;
}

std::optional<FeltSegment> FeltShock::take(const BodyMotion& motion) {
  if (!motion.p_map.allFinite() || !std::isfinite(motion.rise)) {
    restart();
    return std::nullopt;
  }
  const int64_t number = motion.utime / kBin;
  if (number < bin_.number) return std::nullopt;
  std::optional<FeltSegment> ended;
  if (number != bin_.number) {
    const Bin full = std::exchange(bin_, {number, 0, {}});
    const bool gap = full.count < kLeastCount || number != full.number + 1;
    if (full.number >= 0 && gap) {
      restart();
      bin_.number = number;
    } else if (full.number >= 0) {
      const double share = 1.0 / full.count;
      ended = close({(full.number + 1) * kBin, share * full.sum.p_map, share * full.sum.rise,
                     share * full.sum.speed, share * full.sum.climb});
    }
  }
  ++bin_.count;
  bin_.sum.p_map += motion.p_map;
  bin_.sum.rise += motion.rise;
  bin_.sum.speed += motion.speed;
  bin_.sum.climb += motion.climb;
  return ended;
}

std::optional<FeltSegment> FeltShock::close(const BodyMotion& mean) {
  last_.push_back(mean);
  if (last_.size() < 3) return std::nullopt;
  const BodyMotion first = last_[0], middle = last_[1];
  last_.erase(last_.begin());
  const double speed = std::isfinite(middle.speed)
                           ? std::abs(middle.speed)
                           : (mean.p_map - first.p_map).norm() / (2.0 * kBinSeconds);
  const double climbed = std::isfinite(mean.climb - first.climb) ? mean.climb - first.climb
                                                                 : speed * (mean.rise - first.rise);
  const double acceleration =
      climbed / (2.0 * kBinSeconds) +
      arm_ * (mean.rise - 2.0 * middle.rise + first.rise) / (kBinSeconds * kBinSeconds);
  const double pitch_rate = (mean.rise - first.rise) / (2.0 * kBinSeconds);
  const double moved = (mean.p_map - first.p_map).norm();
  if (speed < kStanding && moved < kStanding) {
    noise_ += std::max(kNoiseGain, 1.0 / ++noise_count_) * (acceleration * acceleration - noise_);
  }
  return addToSegment(middle, speed, acceleration, pitch_rate);
}

std::optional<FeltSegment> FeltShock::addToSegment(const BodyMotion& middle, double speed,
                                                   double acceleration, double pitch_rate) {
  if (speed < kSlowest) {
    segment_ = {};
    way_ = 0.0;
    count_ = 0;
    return std::nullopt;
  }
  ++count_;
  way_ += speed * kBinSeconds;
  segment_.p_map.push_back(middle.p_map);
  segment_.speed += speed;
  segment_.shock += acceleration * acceleration;
  segment_.peak = std::max(segment_.peak, std::abs(acceleration));
  segment_.pitch_rate += pitch_rate * pitch_rate;
  if (way_ < kSegment) return std::nullopt;
  FeltSegment ended = std::exchange(segment_, {});
  const double share = 1.0 / std::exchange(count_, 0);
  way_ = 0.0;
  ended.utime = middle.utime;
  ended.speed *= share;
  ended.shock = std::sqrt(std::max({kLeastSquare, noise_, share * ended.shock - noise_}));
  ended.pitch_rate = std::sqrt(share * ended.pitch_rate);
  return ended;
}

}  // namespace tread::learner
