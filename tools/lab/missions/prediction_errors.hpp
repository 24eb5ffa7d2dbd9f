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

/// Prediction error of a measured execution in the world with a seed; nullopt if there is none.
using ErrorOf =
    std::function<std::optional<report::PredictionError>(const ScoredExecution&, uint64_t seed)>;

/// Error relative to the set that the planner had used.
ErrorOf errorAsDriven();
/// Error relative to the prediction of rule `rule` of MissionResult::shadow_rules.
ErrorOf errorByRule(size_t rule);

/// Mean errors of some executions.
struct MeanError {
  int count = 0;
  double position = 0.0;        ///< [m] mean
  double yaw = 0.0;             ///< [rad] mean of the absolute error
  double position_per_m = 0.0;  ///< pooled: sum of errors over sum of metres driven
  double yaw_per_rad = 0.0;     ///< pooled: sum of errors over sum of radians turned
};

/// Errors around changes of surface, each averaged over the executions of all changes.
struct ErrorsAroundChanges {
  MeanError before;   ///< the last five executions on the old surface
  MeanError after;    ///< the first three on the new surface
  MeanError first;    ///< the first of these, which no rule can predict
  MeanError next;     ///< the two after it
  MeanError settled;  ///< the fifth to the fifteenth
};

/// Measured executions completely on one segment of surface: after crossing `index` - 1, before
/// crossing `index`; 0 = before the first.
std::vector<const ScoredExecution*> segmentOf(const MissionResult& result, size_t index);

/// For one change, an index into crossings, as driven.
ErrorsAroundChanges errorsAroundChange(const MissionResult& result, size_t change);

/// For all changes of all missions.
ErrorsAroundChanges errorsAroundChanges(const std::vector<MissionResult>& results,
                                        const ErrorOf& error);

/// Over all measured executions that are completely on one surface.
MeanError meanErrorOf(const std::vector<MissionResult>& results, const ErrorOf& error);

/// Error after changes between two surfaces; from "start" = before the first change.
struct ErrorAfterChange : MeanError {
  std::string from;
  std::string to;
};

/// Error of executions first..last after each change of surface (1 = the first complete one), as
/// driven; per pair of surfaces, sorted by name, pooled over all missions.
std::vector<ErrorAfterChange> errorsAfterChange(const std::vector<MissionResult>& results,
                                                int first, int last);

/// An oracle that predicts each pattern by its mean over all executions on the surface.
/** The mean is over the measured ends of executions completely on the surface in all other worlds
 * (at least kFewest, else nullopt). Its error is the scatter between executions, which no rule can
 * predict. */
class Omniscient {
 public:
  static constexpr int kFewest = 8;

  /// Adds the executions of a mission.
  void add(const MissionResult& result);
  /// Error for an execution in the world with this seed.
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

/// Selection of surface changes.
enum class Met {
  kAny,
  kFirst,  ///< to a surface that is new in this mission
  kBefore  ///< to a surface with at least ten earlier measured executions
};

/// Number of executions that a rule needs on a new surface.
/** n is the smallest number of measured executions on the new surface after which the mean error of
 * the next five is at most 1.2 times the oracle's for the same five; 0 = at once. It is computed
 * for position, for yaw, and for both in the same five. A segment that ends earlier (next change,
 * goal) is censored; medians are Kaplan-Meier estimates. Changes followed by fewer than five
 * executions are left out. */
struct Settling {
  static constexpr double kWithin = 1.2;
  static constexpr size_t kWindow = 5;

  int missions = 0;  ///< missions with such changes
  int changes = 0;
  /// Medians over the changes; infinite if fewer than half reach the criterion.
  double position = 0.0;
  double yaw = 0.0;
  double both = 0.0;
  /// Ratio of the summed errors of rule and oracle, over all changes, for the five executions after
  /// n = 0, 1, 2, ...; up to the largest n that ten changes reach.
  std::vector<double> position_ratio;
  std::vector<double> yaw_ratio;
};

Settling settlingOf(const std::vector<MissionResult>& results, const ErrorOf& error,
                    const Omniscient& omniscient, Met met = Met::kAny);

/// Kaplan-Meier median of times to an event, partly censored (reached = false); infinite if fewer
/// than half reach it. Exposed for tests.
double medianTime(std::vector<std::pair<int, bool>> times);

}  // namespace tread::missions
