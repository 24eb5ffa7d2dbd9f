// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/soundness/core/drive.hpp"
#include "common/vehicle/model_document.hpp"
#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// One parameter of the common model, fitted to each log.
struct RepeatedParameter {
  std::string parameter;  ///< path as in findParameter()
  std::string unit;
  double common = kNotMeasured;  ///< weighted mean of the logs that determine it
  std::vector<double> values;    ///< by log
  std::vector<double> errors;    ///< standard errors over blocks of driving
  std::vector<bool> seen;  ///< by log: its error is below the parameter's value or its typical size
  /// [standard errors] largest difference between two logs that determine it
  double farthest = 0.0;
  bool differs = false;  ///< significantly different between days
};

/// Results for several logs of one vehicle, each alone and all together.
struct Repetition {
  std::vector<std::string> logs;
  std::vector<GapFinding> alone;
  GapFinding together;
  std::vector<RepeatedParameter> parameters;  ///< empty if all together do not determine any
  double needed = 0.0;                        ///< [standard errors] of a significant difference

  bool differs() const;
  /// Effects named in any log or in all together.
  std::vector<std::string> names() const;
  size_t logsThatName(const std::string& effect) const;
  /// The common model with that day's values of ground, battery and INS.
  ModelDocument modelOf(size_t log) const;
};

/// Searches each of the task's training logs, and all together, and fits the common result's sizes
/// in each.
/** Throws std::invalid_argument for fewer than two logs, and for one with too little driving. */
Repetition repeatLogs(const GapTask& task, const Progress& say);

/// The answer as two tables.
std::string textOf(const Repetition& repetition);

}  // namespace tread::gap
