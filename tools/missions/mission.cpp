// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/mission.hpp"

#include <cmath>
#include <map>

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
    while (change < result.surface_changes.size() &&
           result.surface_changes[change].time <= execution.time) {
      pair = {result.surface_changes[change].from, result.surface_changes[change].to};
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

}  // namespace

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
