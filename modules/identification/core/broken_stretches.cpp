// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <map>

#include "modules/identification/core/hygiene.hpp"

namespace tread::gap {
namespace {

constexpr size_t kFewest = 10;        // stretches among which one stands out
constexpr double kLeastTurn = 0.35;   // [rad] that heading and gyro may differ over a stretch
constexpr double kLeastCourse = 0.6;  // [rad] of the way against the heading
constexpr double kFar = 6.0;          // robust standard deviations

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Stretches whose value is further from the median than a least distance and than six robust
/// standard deviations.
void markOutliers(const std::map<size_t, double>& values, double least,
                  std::vector<size_t>& marked) {
  if (values.size() < kFewest) return;
  std::vector<double> all;
  for (const auto& [stretch, value] : values) all.push_back(value);
  const double middle = median(all);
  for (double& value : all) value = std::abs(value - middle);
  const double limit = std::max(least, kFar * 1.4826 * median(all));
  for (const auto& [stretch, value] : values)
    if (std::abs(value - middle) > limit) marked.push_back(stretch);
}

/// How much more the heading turned than the gyro, by stretch [rad].
std::map<size_t, double> turnExcess(const Drive& drive,
                                    const std::vector<PoseIncrement>& increments) {
  std::map<size_t, double> excess;
  const auto match = headingBesideGyro(drive);
  if (!match || std::abs(match->correlation) < 0.5) return excess;
  const RunningSums gyro = gyroSums(drive);
  for (const PoseIncrement& increment : increments) {
    const auto rate =
        gyro[increment.stretch].mean(increment.begin - match->lag, increment.end - match->lag);
    if (rate)
      excess[increment.stretch] +=
          increment.T_begin_end.yaw - (match->slope * *rate + match->offset) * increment.duration();
  }
  return excess;
}

/// Direction of the way against the heading, forwards and backwards alike, by stretch [rad].
std::map<size_t, double> courses(const std::vector<PoseIncrement>& increments) {
  struct Sum {
    double cos2 = 0.0, sin2 = 0.0;
    int rows = 0;
  };
  std::map<size_t, Sum> sums;
  for (const PoseIncrement& increment : increments) {
    const Pose2& step = increment.T_begin_end;
    const double way = std::hypot(step.x, step.y);
    if (std::abs(step.yaw) > 0.3 || way < 0.2) continue;
    // From the middle of the turn, twice the angle: forwards and backwards are the same then.
    const double angle = 2.0 * (std::atan2(step.y, step.x) - step.yaw / 2.0);
    Sum& sum = sums[increment.stretch];
    sum.cos2 += way * std::cos(angle);
    sum.sin2 += way * std::sin(angle);
    ++sum.rows;
  }
  std::map<size_t, double> result;
  for (const auto& [stretch, sum] : sums)
    if (sum.rows >= 5) result[stretch] = 0.5 * std::atan2(sum.sin2, sum.cos2);
  return result;
}

}  // namespace

std::vector<size_t> brokenStretches(const Drive& drive) {
  const auto increments = poseIncrements(drive);
  std::vector<size_t> marked;
  markOutliers(turnExcess(drive, increments), kLeastTurn, marked);
  markOutliers(courses(increments), kLeastCourse, marked);
  std::sort(marked.begin(), marked.end());
  marked.erase(std::unique(marked.begin(), marked.end()), marked.end());
  return marked;
}

void removeStretches(const std::vector<size_t>& stretches, Drive& drive) {
  std::vector<size_t> index(drive.stretches.size());
  std::vector<Stretch> kept;
  for (size_t i = 0; i < drive.stretches.size(); ++i) {
    const bool out = std::binary_search(stretches.begin(), stretches.end(), i);
    index[i] = out ? SIZE_MAX : kept.size();
    if (!out) kept.push_back(std::move(drive.stretches[i]));
  }
  drive.stretches = std::move(kept);
  std::vector<Execution> executions;
  for (Execution execution : drive.executions) {
    execution.stretch = index[execution.stretch];
    if (execution.stretch != SIZE_MAX) executions.push_back(execution);
  }
  drive.executions = std::move(executions);
}

}  // namespace tread::gap
