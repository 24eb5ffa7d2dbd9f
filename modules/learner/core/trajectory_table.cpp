// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/trajectory_table.hpp"

#include <algorithm>

namespace tread::learner {

TrajectoryTable::TrajectoryTable(const std::vector<MotionPattern>& patterns) {
  begins_.push_back(0);
  for (const MotionPattern& pattern : patterns)
    begins_.push_back(begins_.back() + 3 * static_cast<Eigen::Index>(pattern.trajectory.size()));
  numbers_.resize(static_cast<size_t>(begins_.back()));
  std::vector<double> numbers;
  for (size_t p = 0; p < patterns.size(); ++p) {
    fill(patterns[p].trajectory, numbers);
    std::copy(numbers.begin(), numbers.end(), numbers_.begin() + begins_[p]);
  }
}

Pose2 TrajectoryTable::end(size_t pattern) const {
  const ConstTrajectory trajectory = of(pattern);
  const Eigen::Index last = trajectory.rows() - 1;
  return {trajectory(last, 0), trajectory(last, 1), trajectory(last, 2)};
}

void TrajectoryTable::copyNumbers(const TrajectoryTable& other) {
  std::copy(other.numbers_.begin(), other.numbers_.end(), numbers_.begin());
}

void fill(const std::vector<Pose2>& poses, std::vector<double>& numbers) {
  const size_t samples = poses.size();
  numbers.resize(3 * samples);
  for (size_t t = 0; t < samples; ++t) {
    numbers[t] = poses[t].x;
    numbers[samples + t] = poses[t].y;
    numbers[2 * samples + t] = poses[t].yaw;
  }
}

std::vector<Pose2> posesOf(const ConstTrajectory& trajectory) {
  std::vector<Pose2> poses;
  poses.reserve(static_cast<size_t>(trajectory.rows()));
  for (Eigen::Index t = 0; t < trajectory.rows(); ++t)
    poses.push_back({trajectory(t, 0), trajectory(t, 1), trajectory(t, 2)});
  return poses;
}

}  // namespace tread::learner
