// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/scan_faults.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::faults {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr int64_t kRemembered = 2'500'000;  // [us]

/// A false obstacle, or free space instead of one.
void replaceSector(lidar::RangeScan& scan, double strength, bool phantom) {
  const double centre = 1.6 * (strength - 0.5);
  const double half = phantom ? 0.2 : 0.9;
  for (size_t i = 0; i < scan.ranges.size(); ++i) {
    const double angle = scan.angle_first + static_cast<double>(i) * scan.angle_step;
    if (std::abs(angle - centre) > half) continue;
    scan.ranges[i] = phantom ? static_cast<float>(1.0 + 3.0 * strength) : kFar;
  }
}

/// As if the device were rotated; beams outside of its field are not measured.
void turn(lidar::RangeScan& scan, double angle) {
  const auto shift = static_cast<int64_t>(std::lround(angle / scan.angle_step));
  const auto count = static_cast<int64_t>(scan.ranges.size());
  std::vector<float> turned(scan.ranges.size(), std::numeric_limits<float>::quiet_NaN());
  const auto whole = static_cast<int64_t>(std::lround(2.0 * kPi / std::abs(scan.angle_step)));
  for (int64_t i = 0; i < count; ++i) {
    const int64_t from = ((i + shift) % whole + whole) % whole;
    if (from < count) turned[static_cast<size_t>(i)] = scan.ranges[static_cast<size_t>(from)];
  }
  scan.ranges = std::move(turned);
}

}  // namespace

/// Returns the newest scan taken before a time.
void ScanFaults::repeat(lidar::RangeScan& scan, int64_t utime) {
  const auto after = std::find_if(past_.begin(), past_.end(),
                                  [&](const auto& past) { return past.utime > utime; });
  scan.ranges = after == past_.begin() ? past_.front().ranges : std::prev(after)->ranges;
}

void ScanFaults::disturb(lidar::RangeScan& scan) {
  const bool freezes = fault_ && fault_->kind == FaultKind::kScanFreeze;
  if (!freezes || past_.empty()) past_.push_back(scan);
  if (!freezes && past_.front().utime < scan.utime - kRemembered) past_.pop_front();
  if (!fault_) return;
  const double strength = fault_->strength;
  switch (fault_->kind) {
    case FaultKind::kPhantom:
    case FaultKind::kVanish:
      return replaceSector(scan, strength, fault_->kind == FaultKind::kPhantom);
    case FaultKind::kScanFreeze: {
      // The last one, or the last few in alternation.
      const size_t turns = std::min<size_t>(past_.size(), strength < 0.7 ? 1 : 3);
      scan.ranges = past_[past_.size() - 1 - static_cast<size_t>(++frame_) % turns].ranges;
      return;
    }
    case FaultKind::kScanLag:
      return repeat(scan, scan.utime - static_cast<int64_t>(3e5 + 9e5 * strength));
    case FaultKind::kScanMirror:
      return std::reverse(scan.ranges.begin(), scan.ranges.end());
    case FaultKind::kScanTurn:
      return turn(scan, kPi / 9.0 + strength * 16.0 / 9.0 * kPi);
    case FaultKind::kScanFar:
      return std::fill(scan.ranges.begin(), scan.ranges.end(),
                       strength < 0.5 ? kFar : static_cast<float>(scan.range_max));
    case FaultKind::kScanZero:
      return std::fill(scan.ranges.begin(), scan.ranges.end(), 0.0F);
    default:
      return;
  }
}

}  // namespace tread::faults
