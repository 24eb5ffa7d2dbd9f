// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/lab/missions/mission.hpp"

namespace tread::missions {

/// Prediction error of a measured execution in the world with a seed; nothing if there is none.
using ErrorOf =
    std::function<std::optional<report::PredictionError>(const ScoredExecution&, uint64_t seed)>;

/// Against the set that the planner had used.
ErrorOf errorAsDriven();
/// Against what the rule with this index in MissionResult::shadow_rules predicted.
ErrorOf errorByRule(size_t rule);

/// Errors of some executions.
struct MeanError {
  int count = 0;
  double position = 0.0;        ///< [m] mean
  double yaw = 0.0;             ///< [rad] mean of the absolute error
  double position_per_m = 0.0;  ///< pooled: sum of errors over metres driven
  double yaw_per_rad = 0.0;     ///< pooled: sum of errors over radians turned
};

/// Errors around changes of surface, each mean over the executions of all changes.
struct ErrorsAroundChanges {
  MeanError before;   ///< the last five executions on the old surface
  MeanError after;    ///< the first three on the new one
  MeanError first;    ///< of these the first, which nobody can know
  MeanError next;     ///< and the two after it
  MeanError settled;  ///< the fifth to the fifteenth
};

/// Measured executions that lie wholly on one segment of surface: after crossing `index` - 1,
/// before crossing `index`; 0 = before the first.
std::vector<const ScoredExecution*> segmentOf(const MissionResult& result, size_t index);

/// Of one change, an index into crossings, as driven.
ErrorsAroundChanges errorsAroundChange(const MissionResult& result, size_t change);

/// Of all changes of all missions.
ErrorsAroundChanges errorsAroundChanges(const std::vector<MissionResult>& results,
                                        const ErrorOf& error);

/// Over all measured executions that lie wholly on one surface.
MeanError meanErrorOf(const std::vector<MissionResult>& results, const ErrorOf& error);

/// After changes between two surfaces; from "start" = before the first change.
struct ErrorAfterChange : MeanError {
  std::string from;
  std::string to;
};

/// Of the executions with index first..last after each change of surface (1 = the first whole one
/// after it), as driven. Per pair of surfaces, sorted by name, pooled over all missions.
std::vector<ErrorAfterChange> errorsAfterChange(const std::vector<MissionResult>& results,
                                                int first, int last);

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
  std::optional<report::PredictionError> errorOf(const ScoredExecution& execution,
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
 * once. For position, yaw, and both in the same five. A segment that ends earlier (next change,
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
