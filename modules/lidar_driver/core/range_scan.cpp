// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/core/range_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tread::lidar {
namespace {

constexpr double kTurn = 6.28318530717958647692;

float classified(float range, double range_min, double range_max) {
  if (std::isnan(range) || range < static_cast<float>(range_min))
    return std::numeric_limits<float>::quiet_NaN();
  if (range > static_cast<float>(range_max)) return std::numeric_limits<float>::infinity();
  return range;
}

void dropOutside(std::array<float, 3>& point, double range_min, double range_max) {
  const double range = std::hypot(point[0], point[1], point[2]);
  if (!(range >= range_min && range <= range_max))
    point.fill(std::numeric_limits<float>::quiet_NaN());
}

}  // namespace

std::string ScanCheck::problemOfBeams(const RangeScan& raw) const {
  if (raw.ranges.empty()) return "no beams";
  if (raw.ranges.size() > static_cast<size_t>(limits_.max_beams)) return "too many beams";
  if (!std::isfinite(raw.angle_first) || !std::isfinite(raw.angle_step) || raw.angle_step == 0.0)
    return "angles not finite";
  const double sweep = std::abs(raw.angle_step) * static_cast<double>(raw.ranges.size() - 1);
  return sweep > kTurn + 1e-6 ? "more than a turn" : "";
}

std::string ScanCheck::problemOf(const RangeScan& raw) const {
  const std::string problem = raw.points.empty() ? problemOfBeams(raw) : "";
  if (!problem.empty()) return problem;
  if (raw.points.size() > kMostPoints) return "too many points";
  if (raw.duration_us < 0 || raw.duration_us > 1'000'000) return "duration outside 0..1 s";
  if (raw.utime <= last_utime_) return "not newer than the scan before";
  return {};
}

std::optional<RangeScan> ScanCheck::accept(const RangeScan& raw) {
  refusal_ = problemOf(raw);
  if (!refusal_.empty()) return std::nullopt;
  last_utime_ = raw.utime;
  RangeScan scan = raw;
  scan.range_min = std::max(raw.range_min, limits_.range_min);
  scan.range_max = std::min(raw.range_max, limits_.range_max);
  if (scan.points.empty())
    thin(scan);
  else
    for (auto& point : scan.points) dropOutside(point, scan.range_min, scan.range_max);
  return scan;
}

void ScanCheck::thin(RangeScan& scan) const {
  const std::vector<float> ranges = std::exchange(scan.ranges, {});
  const auto stride = static_cast<size_t>(limits_.beam_stride);
  scan.angle_step *= limits_.beam_stride;
  for (size_t i = 0; i < ranges.size(); i += stride)
    scan.ranges.push_back(classified(ranges[i], scan.range_min, scan.range_max));
  // The last kept beam may precede the last measured one.
  if (ranges.size() > 1)
    scan.duration_us = scan.duration_us * static_cast<int64_t>((scan.ranges.size() - 1) * stride) /
                       static_cast<int64_t>(ranges.size() - 1);
}

}  // namespace tread::lidar
