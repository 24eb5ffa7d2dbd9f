// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/mission.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace tread::missions {

const char* nameOf(Outcome outcome) {
  switch (outcome) {
    case Outcome::kArrived:
      return "arrived";
    case Outcome::kRefused:
      return "refused";
    case Outcome::kIdle:
      return "idle";
    case Outcome::kStopped:
      return "stopped";
  }
  return "stopped";
}

namespace {

struct Sum {
  int count = 0;
  double position = 0.0;
  double yaw = 0.0;
  double metres = 0.0;
  double radians = 0.0;
};

/// Walks through one mission and adds the executions whose index since the last change is within
/// [first, last].
void addMission(const MissionResult& result, int first, int last,
                std::map<std::pair<std::string, std::string>, Sum>& sums) {
  size_t change = 0;
  std::pair<std::string, std::string> pair{"start", ""};
  int index = 0;
  for (const ScoredExecution& execution : result.executions) {
    while (change < result.crossings.size() && result.crossings[change].time <= execution.time) {
      pair = {result.crossings[change].from, result.crossings[change].to};
      index = 0;
      ++change;
    }
    if (!execution.measured || execution.surface.empty()) continue;
    if (pair.first == "start") pair.second = execution.surface;
    if (execution.surface != pair.second) continue;
    ++index;
    if (index < first || index > last) continue;
    Sum& sum = sums[pair];
    ++sum.count;
    sum.position += execution.error_position;
    sum.yaw += std::abs(execution.error_yaw);
    sum.metres += execution.path_length;
    sum.radians += execution.turned;
  }
}

using Executions = std::vector<const ScoredExecution*>;

/// Means over the executions with index first..last (1-based), clipped to what there is.
std::pair<double, double> meanErrors(const Executions& executions, size_t first, size_t last) {
  double position = 0.0, yaw = 0.0;
  int count = 0;
  for (size_t i = first; i <= last && i <= executions.size(); ++i, ++count) {
    position += executions[i - 1]->error_position;
    yaw += std::abs(executions[i - 1]->error_yaw);
  }
  const double none = std::numeric_limits<double>::quiet_NaN();
  return count == 0 ? std::make_pair(none, none) : std::make_pair(position / count, yaw / count);
}

}  // namespace

std::vector<const ScoredExecution*> stretchOf(const MissionResult& result, size_t index) {
  const auto& changes = result.crossings;
  const double from = index == 0 ? -1.0 : changes[index - 1].time;
  const double to =
      index < changes.size() ? changes[index].time : std::numeric_limits<double>::infinity();
  Executions executions;
  for (const ScoredExecution& execution : result.executions)
    if (execution.measured && !execution.surface.empty() && execution.time > from &&
        execution.time <= to)
      executions.push_back(&execution);
  return executions;
}

ErrorAroundChange errorsAround(const MissionResult& result, size_t change) {
  const Executions before = stretchOf(result, change);
  const Executions after = stretchOf(result, change + 1);
  ErrorAroundChange errors;
  const size_t first = before.size() > 5 ? before.size() - 4 : 1;
  std::tie(errors.before_position, errors.before_yaw) = meanErrors(before, first, before.size());
  std::tie(errors.after_position, errors.after_yaw) = meanErrors(after, 1, 3);
  std::tie(errors.settled_position, errors.settled_yaw) = meanErrors(after, 5, 15);
  return errors;
}

std::vector<ErrorAfterChange> errorsAfterChange(const std::vector<MissionResult>& results,
                                                int first, int last) {
  std::map<std::pair<std::string, std::string>, Sum> sums;
  for (const MissionResult& result : results) addMission(result, first, last, sums);
  std::vector<ErrorAfterChange> errors;
  for (const auto& [pair, sum] : sums) {
    if (sum.count == 0) continue;
    ErrorAfterChange error;
    error.from = pair.first;
    error.to = pair.second;
    error.count = sum.count;
    error.position = sum.position / sum.count;
    error.yaw = sum.yaw / sum.count;
    error.position_per_m = sum.metres > 0.0 ? sum.position / sum.metres : 0.0;
    error.yaw_per_rad = sum.radians > 0.0 ? sum.yaw / sum.radians : 0.0;
    errors.push_back(error);
  }
  return errors;
}

}  // namespace tread::missions
