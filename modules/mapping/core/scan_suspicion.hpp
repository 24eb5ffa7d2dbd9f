// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/mapping/core/scan_view.hpp"

namespace tread::mapping {

/// Defects of the scans of a range finder that still sends.
enum class ScanDefect {
  kNone,
  kEmpty,        ///< no beam measures anything
  kFrozen,       ///< repeated bit for bit while the robot moves
  kSeesThrough,  ///< nothing where an object was a moment ago
  kMirrored,
  kTurned,
  kDelayed  ///< an old scan with a new time
};

/// A suspected defect with its evidence.
struct ScanSuspicion {
  ScanDefect defect = ScanDefect::kNone;
  double gain = 0.0;    ///< points that it explains minus points that it breaks
  double angle = 0.0;   ///< [rad] turned by
  double delay = 0.0;   ///< [s]
  bool always = false;  ///< earlier scans had the same defect
};

/// All hypotheses that may explain the misfit of a scan, the simplest first.
std::vector<ScanSuspicion> scanHypotheses();

/// Whether two scans are suspected of the same defect.
bool agree(const ScanSuspicion& a, const ScanSuspicion& b);

/// An earlier scan and the points of the new one, by whether they fit under the claimed motion.
struct ScanDoubt {
  const ScanView* reference;
  PlaneMove told;                                        ///< T_reference_scan by the claimed motion
  std::vector<Eigen::Vector2d> missed, hidden, matched;  ///< by ScanView::Fit

  bool mostMissed() const { return missed.size() > matched.size(); }
};

/// Points that a defect explains by another alignment of the scan, minus those that it breaks; 0 if
/// it is no explanation.
double gainOf(ScanDefect defect, const PlaneMove& T_reference_scan, const ScanDoubt& doubt);
/// Whether so much of the scan is so far from its claimed position that moving objects cannot be
/// the cause.
bool beyondMotion(const PlaneMove& T_reference_scan, const ScanDoubt& doubt, double seconds_apart);
/// How many more points fit an alignment of the scan than the claimed one; negative if fewer.
int balanceOf(const PlaneMove& T_reference_scan, const ScanDoubt& doubt);

/// A suspicion in words for the operator; for a frozen range finder without the distance moved.
std::string describe(const ScanSuspicion& suspicion);

}  // namespace tread::mapping
