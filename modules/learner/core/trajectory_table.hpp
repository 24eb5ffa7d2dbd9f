// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/pattern/pattern.hpp"

namespace tread::learner {

/// T x 3 numbers in memory: all x, then all y, then all yaw, so that a loop over samples is a loop
/// over neighbours.
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
  /// To be changed in place.
  Trajectory change(size_t pattern) {
    return {numbers_.data() + begins_[pattern], samples(pattern), 3};
  }
  ConstTrajectory of(size_t pattern) const {
    return {numbers_.data() + begins_[pattern], samples(pattern), 3};
  }
  /// The last pose of a pattern.
  Pose2 end(size_t pattern) const;
  /// Takes over all numbers of a table of the same shape; allocates nothing.
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

}  // namespace tread::learner
