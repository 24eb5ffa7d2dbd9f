// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/rule_comparison.hpp"

#include <algorithm>
#include <cmath>

namespace tread::missions {
namespace {

using Executions = std::vector<const ScoredExecution*>;

/// Sums that become means.
struct Sums {
  MeanError error;
  double metres = 0.0;
  double radians = 0.0;

  /// Executions with index first..last (1-based), clipped to what there is.
  void add(const Executions& executions, size_t first, size_t last, const ErrorOf& errorOf) {
    for (size_t i = std::max<size_t>(1, first); i <= std::min(last, executions.size()); ++i) {
      const ScoredExecution& execution = *executions[i - 1];
      const auto at_end = errorOf(execution);
      if (!at_end) continue;
      ++error.count;
      error.position += at_end->position;
      error.yaw += std::abs(at_end->yaw);
      metres += execution.path_length;
      radians += execution.turned;
    }
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

}  // namespace

ErrorOf errorAsDriven() {
  return [](const ScoredExecution& execution) -> std::optional<shadow::EndError> {
    if (!execution.measured) return std::nullopt;
    return shadow::EndError{execution.error_position, execution.error_yaw};
  };
}

ErrorOf errorByRule(size_t rule) {
  return [rule](const ScoredExecution& execution) -> std::optional<shadow::EndError> {
    if (rule >= execution.by_rule.size()) return std::nullopt;
    return execution.by_rule[rule];
  };
}

ErrorsAroundChanges errorsAroundChanges(const std::vector<MissionResult>& results,
                                        const ErrorOf& error) {
  Sums before, after, settled;
  for (const MissionResult& result : results)
    for (size_t change = 0; change < result.crossings.size(); ++change) {
      const Executions on_old = stretchOf(result, change);
      const Executions on_new = stretchOf(result, change + 1);
      before.add(on_old, on_old.size() > 5 ? on_old.size() - 4 : 1, on_old.size(), error);
      after.add(on_new, 1, 3, error);
      settled.add(on_new, 5, 15, error);
    }
  return {before.mean(), after.mean(), settled.mean()};
}

MeanError meanErrorOf(const std::vector<MissionResult>& results, const ErrorOf& error) {
  Sums all;
  for (const MissionResult& result : results)
    for (size_t index = 0; index <= result.crossings.size(); ++index) {
      const Executions executions = stretchOf(result, index);
      all.add(executions, 1, executions.size(), error);
    }
  return all.mean();
}

}  // namespace tread::missions
