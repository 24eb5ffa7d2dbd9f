// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// The part of the body twist that a term corrects.
enum class TwistPart { kForward, kSideways, kTurning };

/// Description of a short piece of driving, from the commands alone, in units of a PieceScale.
struct DrivenPiece {
  double v = 0.0;           ///< forward speed of the kernel, mean over the piece
  double omega = 0.0;       ///< its yaw rate
  double asked_v = 0.0;     ///< mean commanded speed of the tracks, after the delay
  double asked_turn = 0.0;  ///< half of right minus left
  double old_v = 0.0;       ///< the same for the previous command
  double old_turn = 0.0;
  double since = 0.0;  ///< [s] since the present command began to act
};

/// Units of pieces; 1 = SI.
struct PieceScale {
  double v = 1.0;      ///< [m/s] of all speeds
  double omega = 1.0;  ///< [rad/s]
};

/// One regression column: coefficient times value is added to a part of the body twist.
struct TwistTerm {
  TwistPart part = TwistPart::kForward;
  std::string name;  ///< what it depends on
  double (*value)(const DrivenPiece&) = nullptr;
};

/// A linear correction of the twist in the kernel's simulation.
/** Terms depend only on commands and the uncorrected simulation, so a corrected simulation runs
 * open loop like any other. Without terms there is no correction. */
struct TwistRegression {
  PieceScale scale;
  std::vector<TwistTerm> terms;
  Eigen::VectorXd coefficients;  ///< terms x 1 [m/s or rad/s per unit of the term]
  double deviation = 0.0;        ///< [m/s or rad/s] of the chosen prior
};

/// Parameters of a regression fit.
struct RegressionSettings {
  /// Standard deviations of the coefficients' normal prior around 0, for terms scaled to a root
  /// mean square of 1 [m/s or rad/s]; of several, blocked cross-validation chooses the best.
  std::vector<double> deviations{1.0};
  /// Describe pieces in units of twice the training driving's root mean square; else in SI units.
  bool scaled = false;
};

/// Fits the terms to a model's residuals on the fitter's rows, with the model fixed.
/** Integral form: rows of the corrected simulation are compared with measured rows, with the same
 * Student likelihood as all other fits, plus the prior (ridge), by iterated least squares. */
TwistRegression fitRegression(const Fitter& fitter, const ModelDocument& model,
                              std::vector<TwistTerm> terms, const RegressionSettings& settings);

/// Motions of all segments with the correction.
std::vector<std::vector<MotionSample>> simulateCorrected(const Observations& data,
                                                         const VehicleModel& vehicle,
                                                         const TwistRegression& regression);

}  // namespace tread::gap
