// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/gap/core/drive.hpp"
#include "tools/gap/core/finding.hpp"

namespace tread::gap {

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
  EndErrors with_first;   ///< of the second log with what was fitted on the first
  EndErrors with_second;  ///< and with its own
};

/// Movements from this on are called changes [standard errors].
inline constexpr double kMoved = 3.0;

/// Fits the terms that a model has on, and the numbers that it is unsure of, on both logs.
/** Of a model without either, lag, delay and gains are fitted. Throws std::runtime_error with one
 * line if a log has too little driving. */
LogChange compareLogs(const ModelDocument& model, const Drive& first, const Drive& second,
                      int threads);

/// The answer in words and as a table.
std::string textOf(const LogChange& change);

}  // namespace tread::gap
