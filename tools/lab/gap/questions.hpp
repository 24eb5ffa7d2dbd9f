// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/report/page.hpp"
#include "common/soundness/core/drive.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_document.hpp"
#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// A sequence of commands, and the command before it.
struct Manoeuvre {
  std::string name;
  TrackCommand before;                 ///< held until the motion is steady
  std::vector<TrackCommand> commands;  ///< each held for kManoeuvrePeriod
};

inline constexpr double kManoeuvrePeriod = 0.05;  ///< [s]

/// Circumstances of a drive.
struct Circumstances {
  double session_time = 0.0;  ///< [s] since the session began
  double battery_drop = 0.0;  ///< [1] relative fall of the voltage
  double roll = 0.0;          ///< [rad]
  double pitch = 0.0;         ///< [rad]
  double worked = 0.0;        ///< [1] mean square of the duty so far, which heats the drive
};

/// Simulates a manoeuvre as measured by the INS: poses relative to the first, and yaw rates, one
/// per command and one before; times from 0 on.
std::vector<MotionSample> drivenByModel(const ModelDocument& model, const Manoeuvre& manoeuvre,
                                        const Circumstances& circumstances = {},
                                        const ExecutionNoise& noise = {});

/// Significance level of a change over all parameters together [standard deviations of a normal
/// distribution]: 0.3 %. Neighbouring blocks of ground are similar, so up to 1 % of pairs of equal
/// logs are reported as different.
inline constexpr double kSigmaLevel = 3.0;

}  // namespace tread::gap
