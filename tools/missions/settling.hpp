// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/missions/prediction_errors.hpp"

namespace tread::missions {

/// An oracle: for each surface, the mean of the patterns that were executed on it.
/** It predicts the mean measured end of all executions of the pattern that lie wholly on the
 * surface in all other worlds (at least kFewest, else nothing). Its error is the scatter from
 * execution to execution, which no rule can predict. */
class Omniscient {
 public:
  static constexpr int kFewest = 8;

  /// Takes in the executions of a mission.
  void add(const MissionResult& result);
  /// Error of an execution in the world with this seed.
  std::optional<shadow::PredictionError> errorOf(const ScoredExecution& execution,
                                                 uint64_t seed) const;

 private:
  struct Ends {
    int count = 0;
    double x = 0.0, y = 0.0, yaw = 0.0;  ///< sums [m, m, rad]
    void add(const Pose2& end);
    void remove(const Ends& other);
  };
  using Key = std::pair<std::string, std::string>;  ///< surface, pattern

  std::map<Key, Ends> all_;
  std::map<uint64_t, std::map<Key, Ends>> by_seed_;
};

/// Which changes of surface count.
enum class Met {
  kAny,
  kFirst,  ///< to a surface that the robot had not been on before in this mission
  kBefore  ///< to one on which it had ended at least ten measured executions
};

/// How many executions a rule needs on a new surface.
/** The measure: n is the smallest number of measured executions on the new surface after which the
 * mean error of the next five is at most 1.2 times the omniscient one's of the same five; 0 = at
 * once. For position, yaw, and both in the same five. A stretch that ends earlier (next change,
 * goal) is censored there: medians are those of Kaplan and Meier. Changes with fewer than five
 * executions after them are left out. */
struct Settling {
  static constexpr double kWithin = 1.2;
  static constexpr size_t kWindow = 5;

  int missions = 0;  ///< that have such changes
  int changes = 0;
  /// Medians over the changes; infinite where fewer than half come there.
  double position = 0.0;
  double yaw = 0.0;
  double both = 0.0;
  /// Sum of errors over the sum of the omniscient one's, over all changes, in the five executions
  /// after n = 0, 1, 2, ...; as far as ten changes have that many executions.
  std::vector<double> position_ratio;
  std::vector<double> yaw_ratio;
};

Settling settlingOf(const std::vector<MissionResult>& results, const ErrorOf& error,
                    const Omniscient& omniscient, Met met = Met::kAny);

/// Kaplan-Meier median of times to an event, some of them censored (reached = false); infinite if
/// fewer than half reach it. For tests.
double medianTime(std::vector<std::pair<int, bool>> times);

}  // namespace tread::missions
