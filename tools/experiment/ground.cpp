// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/ground.hpp"

#include <algorithm>
#include <cmath>

namespace tread::experiment {

ExecutionEnd executionEnd(const learner::ConstTrajectory& trajectory) {
  const Eigen::Index last = trajectory.rows() - 1;
  ExecutionEnd end;
  end.pose = {trajectory(last, 0), trajectory(last, 1), trajectory(last, 2)};
  end.radians = std::abs(end.pose.yaw);
  end.metres = std::hypot(trajectory(0, 0), trajectory(0, 1));
  for (Eigen::Index i = 1; i <= last; ++i)
    end.metres += std::hypot(trajectory(i, 0) - trajectory(i - 1, 0),
                             trajectory(i, 1) - trajectory(i - 1, 1));
  return end;
}

Executions::Executions(const std::vector<recordings::Execution>& executions, size_t samples,
                       const std::vector<size_t>& left_out)
    : samples_(samples) {
  numbers_.reserve(executions.size() * samples * 3);
  for (size_t i = 0; i < executions.size(); ++i) {
    if (std::binary_search(left_out.begin(), left_out.end(), i)) continue;
    for (const Pose2& pose : executions[i]) numbers_.push_back(pose.x);
    for (const Pose2& pose : executions[i]) numbers_.push_back(pose.y);
    for (const Pose2& pose : executions[i]) numbers_.push_back(pose.yaw);
  }
  for (size_t i = 0; i < numbers_.size() / (3 * samples); ++i) ends_.push_back(executionEnd(of(i)));
}

namespace {

Ground groundOf(const recordings::PatternRecordings& book,
                const recordings::SurfaceRecordings& surface, std::vector<std::string>& notes) {
  std::vector<recordings::AverageNote> averaging;
  Ground ground{
      surface.surface, recordings::averageSet(book.patterns, surface, {}, averaging), {}, {}};
  for (const recordings::AverageNote& note : averaging)
    for (const std::string& line : note.rejected)
      notes.push_back(surface.surface + ", " + note.pattern + ": " + line);
  for (size_t p = 0; p < surface.executions.size(); ++p) {
    const MotionPattern& pattern = ground.averaged.patterns()[p];
    ground.averaged_ends.push_back(pattern.end());
    ground.executions.emplace_back(surface.executions[p], pattern.commands.size(),
                                   averaging[p].left_out);
  }
  return ground;
}

}  // namespace

std::vector<Ground> groundsOf(const recordings::PatternRecordings& book,
                              std::vector<std::string>& notes) {
  if (book.surfaces.size() < 2)
    throw recordings::RecordingError(
        "a transition needs recordings of at least two surfaces; there " +
        (book.surfaces.empty() ? std::string("is none")
                               : "is one: '" + book.surfaces.front().surface + "'"));
  std::vector<Ground> grounds;
  for (const recordings::SurfaceRecordings& surface : book.surfaces)
    grounds.push_back(groundOf(book, surface, notes));
  return grounds;
}

}  // namespace tread::experiment
