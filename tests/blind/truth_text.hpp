// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tests/blind/blind_case.hpp"
#include "tests/blind/hider.hpp"
#include "tests/blind/instruments.hpp"

namespace tread::blind {

/// What was hidden, as found after the drive.
struct HiddenTruth {
  const EffectSpec* spec = nullptr;
  std::vector<Quantity> levers;
  std::vector<Quantity> equivalent;
};

/// How far a log goes: what is never asked cannot be found.
struct Excitation {
  double speed = 0.0;              ///< largest [m/s]
  double yaw_rate = 0.0;           ///< largest [rad/s]
  double side_acceleration = 0.0;  ///< largest |v omega| [m/s^2]
  int reversals = 0;               ///< of either track, from pattern to pattern
};

/// All that is written down about a case.
struct CaseTruth {
  std::vector<HiddenTruth> effects;
  double duration = 0.0;  ///< [s]
  EndPoseError floor;     ///< of the truth itself
  EndPoseError gap;       ///< of the plain vehicle, noise apart
  Excitation excitation;
  std::string defect_at;  ///< where a bad log is bad, in words
};

/// The truth as JSON, two spaces, keys in a fixed order, newline at the end.
std::string truthText(const CasePlan& plan, const CaseTruth& truth);

}  // namespace tread::blind
