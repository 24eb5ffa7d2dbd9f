// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/scan_suspicion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace tread::mapping {
namespace {

/// A defect explains at least this many points and this share of those that the reference must have
/// seen under it; and this share of the explained points is where the reference saw free space,
/// because places hidden from it may be new. The latter does not apply to old scans, in which walls
/// ahead appear farther away.
constexpr int kLeastExplained = 12;
constexpr double kLeastShare = 0.75;
constexpr double kLeastMissedShare = 1.0 / 3.0;
/// Weight of each point that it breaks.
constexpr int kBroken = 4;
/// It explains points in this many of twelve sectors, or at such a distance from their claimed
/// positions that no object can have moved there [m, m/s].
constexpr int kLeastSectors = 3;
constexpr double kLeastJump = 0.5;
constexpr double kFastest = 8.0;

constexpr double kAngleStep = 4.0 / 180.0 * kPi;
constexpr double kLeastAngle = 12.0 / 180.0 * kPi;
constexpr double kDelayStep = 0.1;  // [s]
constexpr double kLeastDelay = 0.2;
constexpr double kMostDelay = 1.55;

/// Of some points: those that an alignment of the scan explains.
struct Explained {
  int points = 0;
  int unexplained = 0;
  double jump = 0.0;  ///< [m] summed distance from their claimed positions
  std::array<bool, 12> sectors{};
};

void explain(const PlaneMove& T_reference_scan, const ScanDoubt& doubt,
             const std::vector<Eigen::Vector2d>& points, Explained& explained) {
  for (const Eigen::Vector2d& point : points) {
    const ScanView::Fit fit = doubt.reference->fit(T_reference_scan * point);
    explained.unexplained += fit == ScanView::Fit::kMiss ? 1 : 0;
    if (fit != ScanView::Fit::kMatch) continue;
    ++explained.points;
    explained.jump += (T_reference_scan * point - doubt.told * point).norm();
    const double bearing = std::atan2(point.y(), point.x()) + kPi;
    explained.sectors[std::min<size_t>(11, static_cast<size_t>(bearing / kPi * 6.0))] = true;
  }
}

int brokenBy(const PlaneMove& T_reference_scan, const ScanDoubt& doubt) {
  return static_cast<int>(
      std::count_if(doubt.matched.begin(), doubt.matched.end(), [&](const Eigen::Vector2d& point) {
        return doubt.reference->fit(T_reference_scan * point) != ScanView::Fit::kMatch;
      }));
}

}  // namespace

double gainOf(ScanDefect defect, const PlaneMove& T_reference_scan, const ScanDoubt& doubt) {
  Explained explained;
  explain(T_reference_scan, doubt, doubt.missed, explained);
  const int missed = explained.points;
  explain(T_reference_scan, doubt, doubt.hidden, explained);
  const double share = defect == ScanDefect::kDelayed ? 0.0 : kLeastMissedShare;
  if (explained.points < kLeastExplained || missed < share * explained.points ||
      explained.points < kLeastShare * (explained.points + explained.unexplained))
    return 0.0;
  const double gain = explained.points - kBroken * brokenBy(T_reference_scan, doubt);
  return gain < 0.5 * explained.points ? 0.0 : gain;
}

bool beyondMotion(const PlaneMove& T_reference_scan, const ScanDoubt& doubt, double seconds_apart) {
  Explained explained;
  explain(T_reference_scan, doubt, doubt.missed, explained);
  explain(T_reference_scan, doubt, doubt.hidden, explained);
  const auto sectors = std::count(explained.sectors.begin(), explained.sectors.end(), true);
  return sectors >= kLeastSectors ||
         explained.jump >= (kLeastJump + kFastest * seconds_apart) * explained.points;
}

int balanceOf(const PlaneMove& T_reference_scan, const ScanDoubt& doubt) {
  Explained explained;
  explain(T_reference_scan, doubt, doubt.missed, explained);
  return explained.points - brokenBy(T_reference_scan, doubt);
}

std::vector<ScanSuspicion> scanHypotheses() {
  std::vector<ScanSuspicion> all;
  for (double angle = 0.0; angle < 2.0 * kPi - kAngleStep / 2.0; angle += kAngleStep) {
    if (std::abs(wrapAngle(angle)) > kLeastAngle - 1e-6) {
      all.push_back({ScanDefect::kTurned, 0.0, angle, 0.0, false});
      all.push_back({ScanDefect::kTurned, 0.0, angle, 0.0, true});
    }
    // By motion alone, mirrored plus rotated is hardly distinguishable from rotated.
    all.push_back({ScanDefect::kMirrored, 0.0, angle, 0.0, false});
    if (angle == 0.0) all.push_back({ScanDefect::kMirrored, 0.0, angle, 0.0, true});
  }
  for (double delay = kLeastDelay; delay < kMostDelay; delay += kDelayStep)
    for (const bool always : {false, true})
      all.push_back({ScanDefect::kDelayed, 0.0, 0.0, delay, always});
  return all;
}

bool agree(const ScanSuspicion& a, const ScanSuspicion& b) {
  // Defects detected without motion may change: far ranges that repeat are a frozen scan, too.
  const auto plain = [](ScanDefect defect) {
    return defect != ScanDefect::kNone && defect <= ScanDefect::kSeesThrough;
  };
  if (plain(a.defect) && plain(b.defect)) return true;
  return a.defect == b.defect && a.always == b.always &&
         std::abs(wrapAngle(a.angle - b.angle)) < 2.5 * kAngleStep &&
         std::abs(a.delay - b.delay) < 1.5 * kDelayStep;
}

std::string describe(const ScanSuspicion& suspicion) {
  std::ostringstream line;
  line << std::fixed;
  switch (suspicion.defect) {
    case ScanDefect::kNone:
      break;
    case ScanDefect::kEmpty:
      return "no beam of its scans measures anything: is it covered or dazzled, or broken?";
    case ScanDefect::kFrozen:
      return "it repeats bit for bit its scans from before the robot moved";
    case ScanDefect::kSeesThrough:
      return "its scans see nothing where something stood a moment ago: is it covered or broken?";
    case ScanDefect::kMirrored:
      return "its scans fit the motion only if they are mirrored: is it upside down, or are its "
             "beams numbered in reverse?";
    case ScanDefect::kTurned:
      line << "its scans fit the motion only if they are turned by about " << std::setprecision(0)
           << std::abs(wrapAngle(suspicion.angle)) * 180.0 / kPi
           << " deg: compare range_finder in robot.yaml with how it is mounted";
      break;
    case ScanDefect::kDelayed:
      line << "its scans fit the motion of about " << std::setprecision(1) << suspicion.delay
           << " s earlier: they are old ones under new times; restart it";
      break;
  }
  return line.str();
}

}  // namespace tread::mapping
