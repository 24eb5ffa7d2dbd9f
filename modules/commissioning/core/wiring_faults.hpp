// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tread::commissioning {

enum class Side { kLeft, kRight };

constexpr const char* nameOf(Side side) {
  return side == Side::kLeft ? "left" : "right";
}
constexpr Side otherOf(Side side) {
  return side == Side::kLeft ? Side::kRight : Side::kLeft;
}

/// Every fault that the short drive can show, in tracks and cars; wiring_faults.cpp has their
/// sentences.
enum class FaultKind {
  kNoMotion,
  kSwapped,
  kReversed,  ///< a track, or the throttle of a car
  kDead,
  kWeak,
  kInsTurned,
  kInsMirrored,
  kInsElsewhere,
  kGauge,
  kSteeringReversed,
  kSteeringDead,
  kSteeringAskew
};

/// A deviation from the configuration.
struct WiringFault {
  FaultKind kind = FaultKind::kNoMotion;
  std::optional<Side> side;  ///< the side, for faults of one side only
  double amount = 0.0;       ///< weak: share of the other side; turned [rad]; elsewhere, gauge [m]
  std::string words;         ///< one line: what, how much, what to do
};

/// `values` of the gaps in its sentence, in order.
WiringFault wiringFault(FaultKind kind, std::optional<Side> side, double amount,
                        const std::vector<std::string>& values = {});

}  // namespace tread::commissioning
