// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tests/study/hide/blind_case.hpp"
#include "tests/study/hide/hider.hpp"
#include "tests/study/hide/instruments.hpp"

namespace tread::blind {

/// A hidden effect, as measured after the drive.
struct HiddenTruth {
  const EffectSpec* spec = nullptr;
  std::vector<Quantity> levers;
  std::vector<Quantity> equivalent;
  std::vector<std::string> group;  ///< each equivalent to this one in this drive
};

/// Extent of a log's driving: effects outside of it cannot be found.
struct Excitation {
  double speed = 0.0;              ///< largest [m/s]
  double yaw_rate = 0.0;           ///< largest [rad/s]
  double side_acceleration = 0.0;  ///< largest |v omega| [m/s^2]
  int reversals = 0;               ///< of either track, between patterns
};

/// The truth about a case.
struct CaseTruth {
  std::vector<HiddenTruth> effects;
  double duration = 0.0;  ///< [s]
  EndPoseError floor;     ///< error of the truth itself
  EndPoseError gap;       ///< of the plain vehicle, without noise
  Excitation excitation;
  std::string defect_at;  ///< place of a bad log's defect, in words
};

/// The truth as JSON, two spaces, keys in a fixed order, newline at the end:
///   format "tread-hide truth 1", case, log, kind (kindName(), or "semi"), seed, minutes,
///   duration_s, programme, noise {...}, size
///   effects [{name, kind vehicle|measurement|out_of_catalogue,
///     form physical (changed in the 1 kHz dynamics)|kinematic (in the motion or what is said of
///     it), shape same|other (as the catalogue's equation in steady motion), place drive|ground|""
///     (before the track|forces that resist the motion|neither), how, size, levers
///     [{name, value, unit, measured}]      what was turned in the generator equivalent [{name,
///     value, unit, measured}]  in the catalogue's terms, as a change against the
///       plain vehicle; measured: least squares over the patterns' steady halves
///     group [...]      each of these alone is the same for any drive
///     together [[...]] these are the same where they are all there
///     depends_on [...]}]
///   right_verdicts [...], right_names [...]       answers that count as right
///   defect, defect_at                             of a bad log
///   floor, gap {position_m {median, rms}, yaw_rad {median, rms}, yaw_rate_rad_s {rms},
///     executions}   of the noise-free truth against the log; of the plain vehicle against the
///     truth: 2 s end poses, and the gyro over 0.25 s
///   excitation {speed_m_s, yaw_rate_rad_s, side_acceleration_m_s2, reversals}
std::string truthText(const CasePlan& plan, const CaseTruth& truth);

}  // namespace tread::blind
