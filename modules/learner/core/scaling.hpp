// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "common/execution/measurement.hpp"
#include "common/pattern/pattern.hpp"

// The arithmetic of collective motion pattern scaling (paper, section IV):
//   1. the box around a trajectory and its start, and the interval of its yaw;
//   2. the quotient of two boxes, V = (x_s, y_s, phi_s), equation (1);
//   3. a trajectory scaled by V, component by component in the pattern's start frame;
//   4. exponential smoothing, equation (2).
// The guards against boxes of pure noise are decided once, from the shipped set: testing each
// execution against a threshold would act as a ratchet.
namespace tread::learner {

/// T x 3 numbers in memory: all x, then all y, then all yaw, so that loops over samples access
/// consecutive numbers.
using Trajectory = Eigen::Map<Eigen::Array<double, Eigen::Dynamic, 3>>;
using ConstTrajectory = Eigen::Map<const Eigen::Array<double, Eigen::Dynamic, 3>>;

/// Trajectories of all patterns of a set in one block of memory.
class TrajectoryTable {
 public:
  TrajectoryTable() = default;
  explicit TrajectoryTable(const std::vector<MotionPattern>& patterns);

  size_t patterns() const { return begins_.empty() ? 0 : begins_.size() - 1; }
  Eigen::Index samples(size_t pattern) const {
    return (begins_[pattern + 1] - begins_[pattern]) / 3;
  }
  /// For changes in place.
  Trajectory change(size_t pattern) {
    return {numbers_.data() + begins_[pattern], samples(pattern), 3};
  }
  ConstTrajectory of(size_t pattern) const {
    return {numbers_.data() + begins_[pattern], samples(pattern), 3};
  }
  /// The last pose of a pattern.
  Pose2 end(size_t pattern) const;
  /// Copies all numbers of a table of the same shape; allocates nothing.
  void copyNumbers(const TrajectoryTable& other);
  bool sameShape(const TrajectoryTable& other) const { return begins_ == other.begins_; }

 private:
  std::vector<double> numbers_;
  std::vector<Eigen::Index> begins_;
};

/// Poses as a trajectory: `numbers` gets T x 3 of them.
void fill(const std::vector<Pose2>& poses, std::vector<double>& numbers);
/// And back.
std::vector<Pose2> posesOf(const ConstTrajectory& trajectory);

/// One number for each of x, y and yaw of a trajectory in its start frame.
using Axes = Eigen::Array3d;

/// When a box is large enough for a comparison, and the limits of a factor.
struct ScalingLimits {
  Axes min_box{0.05, 0.02,
               0.03};  ///< [m], [m], [rad]: smaller boxes are noise; their factor stays 1
  /// A box must also exceed this multiple of the recorded standard deviation
  double min_box_sigmas = 3.0;
  double min_factor = 0.5;  ///< [1] limits of each factor of V
  double max_factor = 2.0;
};

/// See tread::boundingBox().
Axes boundingBox(const ConstTrajectory& trajectory);

/// Whether a pattern may scale others, and be scaled.
struct PatternRole {
  std::array<bool, 3> scalable{};  ///< x, y, yaw: its box exceeds the noise
  bool gives_scaling = false;  ///< it moves in more than one dimension: two boxes exceed the noise
};

/// The role of a pattern, from its shipped prediction and, if known, the standard deviations of its
/// covariance.
PatternRole roleOf(const MotionPattern& shipped, const ScalingLimits& limits);

/// Quotient of two boxes, axis by axis, within the limits; 1 on axes that are not scalable.
/** V of equation (1) for the boxes of the measured and the predicted trajectory. */
Axes scalingVector(const Axes& new_box, const Axes& old_box, const PatternRole& role,
                   const ScalingLimits& limits);

/// R * V in place: each pose's x, y and yaw times its factor, where the role allows it.
void scale(const Axes& factors, const PatternRole& role, Trajectory predicted);

/// Equation (2) in place: (1 - w) M + w R, component by component; w = `memory` is the weight of
/// the OLD prediction.
/** Line 13 of the paper's Algorithm 1 swaps the two; they agree at w = 0.5 only. Both trajectories
 * have the same number of poses, yaw unwrapped. */
void smooth(const ConstTrajectory& measured, double memory, Trajectory predicted);

/// Whether a covariance is known: all numbers finite, not all variances zero.
bool isKnown(const PoseCovariance& covariance);

}  // namespace tread::learner
