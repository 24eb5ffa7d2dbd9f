// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/end_errors.hpp"
#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/likelihood.hpp"
#include "modules/identification/core/rows.hpp"

namespace tread::gap {

/// A model and executions that it was not fitted to.
struct Unseen {
  const Rows* rows = nullptr;
  ModelDocument model;
  std::vector<EndError> errors;  ///< of the model on these executions
  size_t first_drive = 0;        ///< number of the rows' first drive among all logs
};

/// Executions for pictures.
struct ShownExecutions {
  std::vector<Overlay> overlays;   ///< six typical, then the three worst
  std::vector<PlaceError> places;  ///< of all
};

/// Typical and worst unseen executions with a band that holds nine of ten, and where all errors
/// are.
/** The band is the residual noise of the fitted model carried along the predicted path (scales of
 * the channels added up over time, the heading's also as a lever), times the factor with which it
 * holds 90 % of the unseen executions at each moment. No band where there are fewer than 20. */
ShownExecutions shownExecutions(const std::vector<Unseen>& unseen, const ModelDocument& before,
                                const Noise& noise);

}  // namespace tread::gap
