// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tests/study/models/compared_models.hpp"

namespace tread::gap {

/// A log and the ideal model of its vehicle.
struct ComparisonLog {
  Drive drive;
  ModelDocument ideal;
  bool ideal_known = true;  ///< else the track of `ideal` is a guess, and there is no first rung
};

struct ComparisonTask {
  std::vector<ComparisonLog> logs;
  bool pool = false;  ///< also fit all logs but one, for each
  uint64_t seed = 1;
  ParallelFor parallel = serialFor;  ///< does not affect the result
};

/// Mean difference of end errors over executions, with standard error over blocks of driving.
struct MeanDifference {
  double mean = 0.0;
  double error = 0.0;
};

/// Difference of errors between `discovered` and another rung, on the same executions.
struct RungDifference {
  MeanDifference yaw;       ///< [rad]
  MeanDifference position;  ///< [m]
};

/// Models fitted to the same driving.
struct ComparisonFold {
  std::string trained_on;
  RungModels models;
};

/// Errors of each rung on one log, for held-out driving.
struct ComparisonRow {
  std::string log;
  std::string remark;  ///< why there is no result; else empty
  int blocks = 0;
  double driven = 0.0;           ///< [s]
  bool structure_nested = true;  ///< effects, too, were chosen without the test driving
  std::array<std::optional<EndErrors>, kRungs> errors;
  std::array<std::optional<RungDifference>, kRungs> behind;  ///< discovered minus this rung
  std::optional<EndErrors> floor;  ///< encoders and gyro, see deadReckoningFloor()
  std::vector<ComparisonFold> folds;
};

struct ModelComparison {
  uint64_t seed = 0;
  /// Each log: one half of its blocks tests the fits of the other half
  std::vector<ComparisonRow> nested;
  /// each log tests the fits of all others; empty = not requested
  std::vector<ComparisonRow> pooled;
};

/// Open-loop errors 2 s after the start of an execution, for models without that driving.
/** Nested: alternate blocks of a log; structure and parameters of each half come from the other
 * one. As in find, effects are chosen on the whole log if it has less than 20 blocks; below 10
 * there is no result. Pooled: structure and parameters from all other logs. Deterministic for a
 * seed. */
ModelComparison compareOnLogs(const ComparisonTask& task, const Progress& say);

/// Why a log alone gives no row, in one line; empty if it does.
std::string unusable(const Drive& drive);

/// Mean over executions of second minus first, with a standard error clustered by blocks.
/** Both have the same executions in the same order. */
RungDifference differenceOf(const std::vector<ExecutionError>& first,
                            const std::vector<ExecutionError>& second);

}  // namespace tread::gap
