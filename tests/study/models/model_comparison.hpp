// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tests/study/models/compared_models.hpp"

namespace tread::gap {

/// A log and the ideal model of the vehicle that drove it.
struct ComparisonLog {
  Drive drive;
  ModelDocument ideal;
  bool ideal_known = true;  ///< else the track of `ideal` is a guess, and there is no first rung
};

struct ComparisonTask {
  std::vector<ComparisonLog> logs;
  bool pool = false;  ///< also learn from all logs but one, for each
  uint64_t seed = 1;
  ParallelFor parallel = serialFor;  ///< does not change a bit of the result
};

/// A mean difference of end errors over executions; standard error over blocks of driving.
struct MeanDifference {
  double mean = 0.0;
  double error = 0.0;
};

/// By how much `discovered` errs more than another rung, on the same executions.
struct RungDifference {
  MeanDifference yaw;       ///< [rad]
  MeanDifference position;  ///< [m]
};

/// Models that were fitted to the same driving.
struct ComparisonFold {
  std::string trained_on;
  RungModels models;
};

/// How far each rung is from one log, on driving that it was not fitted to.
struct ComparisonRow {
  std::string log;
  std::string remark;  ///< why there is nothing; empty else
  int blocks = 0;
  double driven = 0.0;           ///< [s]
  bool structure_nested = true;  ///< effects, too, were chosen without the driving that judges
  std::array<std::optional<EndErrors>, kRungs> errors;
  std::array<std::optional<RungDifference>, kRungs> behind;  ///< of discovered less this rung
  std::optional<EndErrors> floor;  ///< encoders and gyro, see deadReckoningFloor()
  std::vector<ComparisonFold> folds;
};

struct ModelComparison {
  uint64_t seed = 0;
  std::vector<ComparisonRow>
      nested;  ///< each log: one half of its blocks judges the other half's fits
  std::vector<ComparisonRow> pooled;  ///< each log judges what all others teach; empty = not asked
};

/// Errors 2 s after the start of an execution, simulated open loop, of models that did not see that
/// driving.
/** Nested: alternate blocks of a log, structure and parameters of each half from the other. As
 * find does, effects are chosen on the whole log where it has less than 20 blocks; below 10 there
 * is nothing. Pooled: structure and parameters from all other logs. Deterministic for a seed. */
ModelComparison compareOnLogs(const ComparisonTask& task, const Progress& say);

/// Why a log by itself gives no row, in one line; empty if it gives one.
std::string unusable(const Drive& drive);

/// Mean of second less first over executions, its standard error clustered by blocks.
/** Both of the same executions in the same order. */
RungDifference differenceOf(const std::vector<ExecutionError>& first,
                            const std::vector<ExecutionError>& second);

}  // namespace tread::gap
