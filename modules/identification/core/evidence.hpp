// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

// Evidence about found effects from quantities that are measured beside the INS, never fitted, and
// predicted by the model of the drive as well: wheel speeds, motor currents, battery voltage.
//   1. Columns: the measured quantity, its usual dependence on the motion, and the part of the
//      motion that each effect takes.
//   2. Fit: least squares over the blocks of driving, all effects together.
//   3. Verdict: the coefficient of an effect with its 95 % interval, from the jackknife over
//      blocks. An effect without a clear answer gets none.
//
//   wheels    Effects that the wheels show are in the drive, the others below it or in the INS. The
//             wheels' radius and effective track are unknown: their speeds are compared up to one
//             factor for driving and one for turning, and effects that equal such a factor (slip,
//             track width) get no answer. Neither do effects on lateral motion, nor two effects
//             that resemble each other but have different answers. Encoders with a lag of their
//             own, by a tenth of a second or two, make a lag look longer.
//   currents  A load draws current where it reduces the speed, a weak drive does not.
//   voltage   A motor's speed is proportional to its voltage. For effects that are one factor on
//             the motion that changes between blocks.
namespace tread::gap {

/// The evidence of one source about each effect; no entry for an effect without any. `state`: of
/// the whole model, with a current prediction.
std::map<std::string, MeasuredEvidence> evidenceBy(EvidenceSource source, const Fitter& fitter,
                                                   const FitState& state,
                                                   const std::vector<std::string>& effects);

}  // namespace tread::gap
