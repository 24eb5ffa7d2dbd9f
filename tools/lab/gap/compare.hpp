// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/parallel/parallel_for.hpp"
#include "common/soundness/core/drive.hpp"
#include "common/vehicle/model_document.hpp"
#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// Estimates from one log of the compared parameters.
struct LogFit {
  ModelDocument model;  ///< fitted
  std::vector<std::string> parameters;
  std::vector<double> values;
  std::vector<double> errors;  ///< standard errors over blocks of driving
  int blocks = 0;              ///< of measured driving
};

/// One parameter, fitted on each of two logs.
struct Movement {
  std::string parameter;  ///< path as in findParameter()
  std::string unit;
  double first = 0.0;
  double first_error = 0.0;  ///< standard error over blocks of driving
  double second = 0.0;
  double second_error = 0.0;

  /// Difference in standard errors; 0 if one log does not determine the parameter.
  double sigmas() const;
};

/// Changes from one log to another.
struct LogChange {
  std::vector<Movement> movements;
  int first_blocks = 0;
  int second_blocks = 0;
  double needed = 0.0;    ///< [standard errors] of a significant change
  EndErrors with_first;   ///< of the second log with the first log's parameters
  EndErrors with_second;  ///< and with its own

  bool moved(const Movement& movement) const;
  bool anyMoved() const;
};

/// Fits the active terms of a model and its uncertain numbers to a log.
/** For a model without either it fits lag, delay and gains. Throws std::runtime_error with one line
 * if the log has too little driving. */
LogFit fitLog(const ModelDocument& model, const Drive& drive,
              const ParallelFor& parallel = serialFor);

/// Standard errors of a significant difference: corrected for few blocks (Student) and many
/// parameters (Bonferroni).
double neededSigmas(int fewest_blocks, size_t parameters);

/// Changes between two fits of one model.
LogChange changeBetween(const LogFit& first, const LogFit& second);

/// Both fits, the changes, and the second log's errors with the first log's parameters.
LogChange compareLogs(const ModelDocument& model, const Drive& first, const Drive& second,
                      const ParallelFor& parallel = serialFor);

/// The answer in words and as a table.
std::string textOf(const LogChange& change);

}  // namespace tread::gap
