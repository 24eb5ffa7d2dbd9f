// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "tests/study/models/twist_regression.hpp"

namespace tread::gap {

/// A piece of a simulated segment with its twist.
struct SimulatedPiece {
  double duration = 0.0;  ///< [s]
  Twist2 v_body;
  DrivenPiece driven;
  int block = 0;
};

/// The pieces of all segments of a model's simulation, in SI units.
/** Integrating their twists reproduces the simulation up to rounding. */
class TwistPieces {
 public:
  TwistPieces(const Observations& data, const VehicleModel& vehicle);

  const std::vector<SimulatedPiece>& pieces() const { return pieces_; }
  /// Poses with corrections of the twist (pieces x 3: forward, sideways, turning).
  Motions motions(const Eigen::MatrixX3d& correction) const;
  /// Twice the root mean squares over pieces of counted blocks; 1 without motion.
  PieceScale scaleOf(const std::vector<char>& block_counts) const;
  /// Values of terms (pieces x terms).
  Eigen::MatrixXd valuesOf(const std::vector<TwistTerm>& terms, const PieceScale& scale) const;

 private:
  std::vector<SimulatedPiece> pieces_;
  std::vector<size_t> counts_;        ///< pieces of each segment
  std::vector<MotionSample> begins_;  ///< of each segment
};

}  // namespace tread::gap
