// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/prediction_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace tread::missions {
namespace {

using Executions = std::vector<const ScoredExecution*>;

/// Sums that become means.
struct ErrorSums {
  MeanError error;
  double metres = 0.0;
  double radians = 0.0;

  void add(const ScoredExecution& execution, uint64_t seed, const ErrorOf& errorOf) {
    const auto at_end = errorOf(execution, seed);
    if (!at_end) return;
    ++error.count;
    error.position += at_end->position;
    error.yaw += std::abs(at_end->yaw);
    metres += execution.path_length;
    radians += execution.turned;
  }

  /// Executions with index first..last (1-based), clipped to what there is.
  void add(const Executions& executions, uint64_t seed, size_t first, size_t last,
           const ErrorOf& errorOf) {
    for (size_t i = first; i <= std::min(last, executions.size()); ++i)
      add(*executions[i - 1], seed, errorOf);
  }

  MeanError mean() const {
    MeanError mean = error;
    if (metres > 0.0) mean.position_per_m = error.position / metres;
    if (radians > 0.0) mean.yaw_per_rad = error.yaw / radians;
    if (error.count > 0) mean.position /= error.count;
    if (error.count > 0) mean.yaw /= error.count;
    return mean;
  }
};

struct SumsAround {
  ErrorSums before, after, settled;

  void add(const MissionResult& result, size_t change, const ErrorOf& error) {
    const Executions on_old = stretchOf(result, change);
    const Executions on_new = stretchOf(result, change + 1);
    before.add(on_old, result.seed, on_old.size() > 5 ? on_old.size() - 4 : 1, on_old.size(),
               error);
    after.add(on_new, result.seed, 1, 3, error);
    settled.add(on_new, result.seed, 5, 15, error);
  }
  ErrorsAroundChanges means() const { return {before.mean(), after.mean(), settled.mean()}; }
};

/// Walks through one mission and adds the executions whose index since the last change is within
/// [first, last].
void addAfterChanges(const MissionResult& result, int first, int last,
                     std::map<std::pair<std::string, std::string>, ErrorSums>& sums) {
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
    sums[pair].add(execution, result.seed, errorAsDriven());
  }
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

ErrorOf errorAsDriven() {
  return [](const ScoredExecution& execution, uint64_t) -> std::optional<shadow::PredictionError> {
    if (!execution.measured) return std::nullopt;
    return shadow::PredictionError{execution.error_position, execution.error_yaw};
  };
}

ErrorOf errorByRule(size_t rule) {
  return
      [rule](const ScoredExecution& execution, uint64_t) -> std::optional<shadow::PredictionError> {
        if (rule >= execution.by_rule.size()) return std::nullopt;
        return execution.by_rule[rule];
      };
}

ErrorsAroundChanges errorsAroundChange(const MissionResult& result, size_t change) {
  SumsAround sums;
  sums.add(result, change, errorAsDriven());
  return sums.means();
}

ErrorsAroundChanges errorsAroundChanges(const std::vector<MissionResult>& results,
                                        const ErrorOf& error) {
  SumsAround sums;
  for (const MissionResult& result : results)
    for (size_t change = 0; change < result.crossings.size(); ++change)
      sums.add(result, change, error);
  return sums.means();
}

MeanError meanErrorOf(const std::vector<MissionResult>& results, const ErrorOf& error) {
  ErrorSums all;
  for (const MissionResult& result : results)
    for (size_t index = 0; index <= result.crossings.size(); ++index) {
      const Executions executions = stretchOf(result, index);
      all.add(executions, result.seed, 1, executions.size(), error);
    }
  return all.mean();
}

std::vector<ErrorAfterChange> errorsAfterChange(const std::vector<MissionResult>& results,
                                                int first, int last) {
  std::map<std::pair<std::string, std::string>, ErrorSums> sums;
  for (const MissionResult& result : results) addAfterChanges(result, first, last, sums);
  std::vector<ErrorAfterChange> errors;
  for (const auto& [pair, sum] : sums) errors.push_back({sum.mean(), pair.first, pair.second});
  return errors;
}

}  // namespace tread::missions
