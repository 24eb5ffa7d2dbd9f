// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/identification/core/drive.hpp"
#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// What one log says of the parameters that are compared.
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

  /// Difference in standard errors; 0 where one log does not say.
  double sigmas() const;
};

/// What changed from one log to another.
struct LogChange {
  std::vector<Movement> movements;
  int first_blocks = 0;
  int second_blocks = 0;
  double needed = 0.0;    ///< [standard errors] from which a movement is no chance
  EndErrors with_first;   ///< of the second log with what was fitted on the first
  EndErrors with_second;  ///< and with its own

  bool moved(const Movement& movement) const;
  bool anyMoved() const;
};

/// Level at which something is said to have moved, for all parameters together [standard
/// deviations of a normal number]: 0.3 %. As blocks of ground resemble their neighbours, up to 1 %
/// of pairs of equal logs are said to differ.
inline constexpr double kSigmaLevel = 3.0;

/// Fits the terms that a model has on, and the numbers that it is unsure of, on a log.
/** Of a model without either, lag, delay and gains are fitted. Throws std::runtime_error with one
 * line if the log has too little driving. */
LogFit fitLog(const ModelDocument& model, const Drive& drive,
              const ParallelFor& parallel = serialFor);

/// Standard errors that a difference needs: errors of few blocks are themselves uncertain
/// (Student), and of many parameters one is soon far off (Bonferroni).
double neededSigmas(int fewest_blocks, size_t parameters);

/// What moved between two fits of one model.
LogChange changeBetween(const LogFit& first, const LogFit& second);

/// Both fits, what moved, and what the second log says of the first one's parameters.
LogChange compareLogs(const ModelDocument& model, const Drive& first, const Drive& second,
                      const ParallelFor& parallel = serialFor);

/// The answer in words and as a table.
std::string textOf(const LogChange& change);

}  // namespace tread::gap
