// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/scan_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/geometry/se3.hpp"

namespace tread::mapping {
namespace {

constexpr double kBin = 2.0 * kPi / ScanView::kBins;
/// Lower points above the robot's own ground may be ground [m].
constexpr double kGround = 0.25;
/// Largest distance of two returns from one object [m], plus this per metre of range.
constexpr double kApart = 0.08;
constexpr double kApartPerRange = 0.015;
/// Largest height difference at which a beam must hit an observed object [m].
constexpr double kInPlane = 0.04;
/// Distance from another scan's plane within which that scan would also have seen it [m].
constexpr double kSamePlane = 0.06;
/// With a smaller share of its points there the planes differ: on hills both may have seen ground.
constexpr double kMostInPlane = 0.6;
/// A moving object may leave the view or the range: within this distance a miss does not count [m].
constexpr double kMayLeave = 1.0;

double apart(double range) {
  return kApart + kApartPerRange * range;
}

}  // namespace

int ScanView::binOf(const Eigen::Vector2d& p_sensor) {
  const double bearing = std::atan2(p_sensor.y(), p_sensor.x()) + kPi;
  return std::clamp(static_cast<int>(bearing / kBin), 0, kBins - 1);
}

ScanView::ScanView(const Scan& scan, const FootprintSize& robot, double height)
    : utime_(scan.utime) {
  seen_.fill(std::numeric_limits<double>::infinity());
  const Eigen::Isometry3d T_map_sensor = scan.T_map_body_last * scan.T_body_sensor;
  const Eigen::Vector3d ahead = T_map_sensor.linear().col(0);
  T_map_sensor_.linear() = Eigen::Rotation2Dd(std::atan2(ahead.y(), ahead.x())).matrix();
  T_map_sensor_.translation() = T_map_sensor.translation().head<2>();
  T_sensor_map_ = T_map_sensor.inverse();
  const PlaneMove T_sensor_map = T_map_sensor_.inverse();
  const double ground = scan.T_map_body_last.translation().z() + kGround;
  std::vector<std::pair<int, Eigen::Vector3d>> hits;
  std::array<bool, kBins> hidden{};
  for (const Beam& beam : scan.beams) {
    const Eigen::Vector3d p_body = scan.T_body_sensor * beam.end;
    const auto bin = static_cast<size_t>(binOf(beam.end.head<2>()));
    looked_[bin] = true;
    seen_[bin] = std::min(seen_[bin], beam.end.head<2>().norm());
    hidden[bin] = hidden[bin] || (beam.hit && isOwnBody(p_body, robot, height));
    if (!beam.hit || p_body.z() < kGround) continue;
    const Eigen::Vector3d p_map =
        interpolated(scan.T_map_body_first, scan.T_map_body_last, beam.share) * p_body;
    if (p_map.z() > ground) hits.emplace_back(binOf(T_sensor_map * p_map.head<2>()), p_map);
  }
  // Such close returns may occasionally be the robot itself.
  hits.erase(
      std::remove_if(hits.begin(), hits.end(),
                     [&](const auto& hit) { return hidden[static_cast<size_t>(hit.first)]; }),
      hits.end());
  for (size_t i = 0; i < kBins; ++i) looked_[i] = looked_[i] && !hidden[i];
  sortIn(std::move(hits));
}

void ScanView::sortIn(std::vector<std::pair<int, Eigen::Vector3d>> hits) {
  std::stable_sort(hits.begin(), hits.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  const PlaneMove T_sensor_map = T_map_sensor_.inverse();
  for (const auto& [bin, p_map] : hits) {
    ++first_[static_cast<size_t>(bin) + 1];
    p_map_.push_back(p_map);
    points_.emplace_back(T_sensor_map * p_map.head<2>());
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
}

std::vector<Eigen::Vector2d> ScanView::inPlane(const ScanView& other, size_t at_most) const {
  std::vector<Eigen::Vector2d> points;
  const size_t step = other.points_.size() / at_most + 1;
  size_t looked_at = 0;
  for (size_t i = 0; i < other.points_.size(); i += step, ++looked_at)
    if (std::abs((T_sensor_map_ * other.p_map_[i]).z()) < kSamePlane)
      points.push_back(other.points_[i]);
  if (static_cast<double>(points.size()) < kMostInPlane * static_cast<double>(looked_at)) return {};
  return points;
}

ScanView::Fit ScanView::fit(const Eigen::Vector2d& p_sensor) const {
  const double range = p_sensor.norm();
  const double within = apart(range);
  const int bin = binOf(p_sensor);
  if (!looked_[static_cast<size_t>(bin)]) return Fit::kUnknown;
  const int aside = std::min(kBins / 4, 1 + static_cast<int>(within / std::max(range, 0.1) / kBin));
  for (int i = bin - aside; i <= bin + aside; ++i) {
    const auto at = static_cast<size_t>((i + kBins) % kBins);
    for (uint32_t k = first_[at]; k < first_[at + 1]; ++k)
      if ((points_[k] - p_sensor).squaredNorm() < within * within) return Fit::kMatch;
  }
  double seen = std::numeric_limits<double>::infinity();
  for (const int i : {bin - 1, bin, bin + 1})
    seen = std::min(seen, seen_[static_cast<size_t>((i + kBins) % kBins)]);
  return seen > range + within ? Fit::kMiss : Fit::kHidden;
}

ScanView::SeenThrough ScanView::seenThrough(const Scan& later) const {
  // At each bearing [m]; infinite: not observed.
  std::array<double, kBins> nearest;
  nearest.fill(std::numeric_limits<double>::infinity());
  double farthest = 0.0;
  for (const Beam& beam : later.beams) {
    double& bin = nearest[static_cast<size_t>(binOf(beam.end.head<2>()))];
    bin = std::min(bin, beam.end.head<2>().norm());
    farthest = std::max(farthest, beam.end.head<2>().norm());
  }
  const Eigen::Isometry3d T_sensor_map = (later.T_map_body_last * later.T_body_sensor).inverse();
  SeenThrough seen;
  for (const Eigen::Vector3d& p_map : p_map_) {
    const Eigen::Vector3d p_sensor = T_sensor_map * p_map;
    const double range = p_sensor.head<2>().norm();
    if (std::abs(p_sensor.z()) > kInPlane || range > farthest - kMayLeave) continue;
    const int aside = 1 + static_cast<int>(std::min(kMayLeave / range, 1.5) / kBin);
    const int bin = binOf(p_sensor.head<2>());
    double least = nearest[static_cast<size_t>(bin)], most = least;
    for (int i = bin - aside; i <= bin + aside; ++i) {
      const double here = nearest[static_cast<size_t>((i + kBins) % kBins)];
      least = std::min(least, here);
      most = std::max(most, here);
    }
    if (!std::isfinite(most)) continue;
    ++seen.expected;
    seen.through += least > range + 2.0 * apart(range) ? 1 : 0;
  }
  return seen;
}

}  // namespace tread::mapping
