// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/mapping/core/scan_view.hpp"

namespace tread::mapping {

/// How the scans of a range finder can be wrong although they come.
enum class ScanDefect {
  kNone,
  kEmpty,        ///< no beam measures anything
  kFrozen,       ///< repeated bit for bit while the robot moves
  kSeesThrough,  ///< nothing where something stood a moment ago
  kMirrored,
  kTurned,
  kDelayed  ///< an old scan under a new time
};

/// A suspicion with what it rests on.
struct ScanSuspicion {
  ScanDefect defect = ScanDefect::kNone;
  double gain = 0.0;    ///< points that it explains more than it breaks
  double angle = 0.0;   ///< [rad] turned by
  double delay = 0.0;   ///< [s]
  bool always = false;  ///< earlier scans were wrong in the same way
};

/// All that the misfit of a scan may be explained by, the simplest first.
std::vector<ScanSuspicion> scanHypotheses();

/// Whether two scans are suspected of the same.
bool agree(const ScanSuspicion& a, const ScanSuspicion& b);

/// An earlier scan and the points of the new one, by whether they lie on it as they were told.
struct ScanDoubt {
  const ScanView* reference;
  PlaneMove told;                                        ///< T_reference_scan by the motion
  std::vector<Eigen::Vector2d> missed, hidden, matched;  ///< as ScanView::Fit says

  bool mostMissed() const { return missed.size() > matched.size(); }
};

/// Points that a defect explains by another place of the scan, less what it breaks; 0 if it is no
/// explanation.
double gainOf(ScanDefect defect, const PlaneMove& T_reference_scan, const ScanDoubt& doubt);
/// Whether so much of the scan lies so far from where it was told that no moving thing can be why.
bool beyondMotion(const PlaneMove& T_reference_scan, const ScanDoubt& doubt, double seconds_apart);
/// How many more points fit a place of the scan than fit as told; negative if less.
int balanceOf(const PlaneMove& T_reference_scan, const ScanDoubt& doubt);

/// A suspicion in words for the operator; of a frozen range finder without how far the robot moved.
std::string describe(const ScanSuspicion& suspicion);

}  // namespace tread::mapping
