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

/// What a model that knows only the commands says of a short piece of driving, in units of a
/// PieceScale.
struct DrivenPiece {
  double v = 0.0;           ///< forward speed of the kernel, mean over the piece
  double omega = 0.0;       ///< its yaw rate
  double asked_v = 0.0;     ///< mean of the track speeds that are asked for, after the delay
  double asked_turn = 0.0;  ///< half of right less left of them
  double old_v = 0.0;       ///< the same of the command before
  double old_turn = 0.0;
  double since = 0.0;  ///< [s] since the command that acts began to act
};

/// Units in which pieces are told; 1 = SI.
struct PieceScale {
  double v = 1.0;      ///< [m/s] of all speeds
  double omega = 1.0;  ///< [rad/s]
};

/// One column of a regression: coefficient times value is added to a part of the body twist.
struct TwistTerm {
  TwistPart part = TwistPart::kForward;
  std::string name;  ///< what it depends on
  double (*value)(const DrivenPiece&) = nullptr;
};

/// A linear correction of the body twist that the kernel's simulation produces.
/** Terms depend on commands and on the uncorrected simulation alone, so that a corrected simulation
 * runs open loop like any other. Without terms it corrects nothing. */
struct TwistRegression {
  PieceScale scale;
  std::vector<TwistTerm> terms;
  Eigen::VectorXd coefficients;  ///< terms x 1 [m/s or rad/s per unit of the term]
  double deviation = 0.0;        ///< [m/s or rad/s] of the prior that was taken
};

/// How a regression is fitted.
struct RegressionSettings {
  /// Standard deviations of the coefficients' normal prior around 0, of terms scaled to a root mean
  /// square of 1 [m/s or rad/s]; of several, blocked cross-validation takes the best.
  std::vector<double> deviations{1.0};
  /// Tell pieces in twice the root mean square of the training driving; else in SI units.
  bool scaled = false;
};

/// Fits the terms to what a model leaves on the fitter's rows; the model is held.
/** In the integral form: rows of the corrected simulation against measured rows, the same Student
 * likelihood as all other fits, plus the prior (ridge), by iterated least squares. */
TwistRegression fitRegression(const Fitter& fitter, const ModelDocument& model,
                              std::vector<TwistTerm> terms, const RegressionSettings& settings);

/// Motions of all segments as a vehicle with the correction drives them.
std::vector<std::vector<MotionSample>> simulateCorrected(const Observations& data,
                                                         const VehicleModel& vehicle,
                                                         const TwistRegression& regression);

}  // namespace tread::gap
