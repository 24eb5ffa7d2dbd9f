// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/robot/setup/core/wiring_check.hpp"

namespace tread::setup {

/// Largest deviations that are not yet a fault.
struct Tolerance {
  double turn;       ///< [rad] of the INS
  double elsewhere;  ///< [m] of the INS
  double gauge;      ///< relative error of the configured one
  double weak;       ///< share of the other side
};
inline constexpr Tolerance kMinute{0.05, 0.15, 0.2, 0.9}, kSeconds{0.2, 0.3, 0.6, 0.7};

inline constexpr size_t kFewRows = 25;
inline constexpr size_t kParts = 12;          ///< parts of the drive for the jackknife
inline constexpr double kStandsStill = 0.05;  ///< [m/s], [rad/s]: less is no motion at full command
inline constexpr double kTurnedForSure = 0.5;  ///< [rad]
/// residual of the mirrored yaw over that of the configured one
inline constexpr double kMirrorGain = 0.6;

std::string fixedText(double value, int decimals);
std::string inMetres(double value);
std::string inDegrees(double angle);

/// A value with its 95 % interval from the jackknife estimates `parts`.
ConfidenceInterval leavingOneOut(double best, const std::vector<double>& parts, bool is_angle);

/// `by_path`: the INS's heading turns opposite to its path; else it contradicts the observation.
WiringFault insMirrored(bool by_path);
WiringFault insTurned(const ConfidenceInterval& yaw, const std::string& or_else);
WiringFault insElsewhere(const ConfidenceInterval& x, const ConfidenceInterval& y);
WiringFault nothingMoves();

}  // namespace tread::setup
