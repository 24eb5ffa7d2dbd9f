// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/search.hpp"

// Where simulation and measurement disagree, the most probable name of the difference, and its
// certainty, in five steps:
//   1. Check. Are the logs sound, does the model cover the vehicle, is there enough driving? If
//      not, the verdict is kCannotTell, with the reason.
//   2. Search (search.hpp). Calibrate; test every effect of the catalogue; add the best, refit,
//      validate on blocks that were left out, prune; until nothing is left to add.
//   3. Remainder (adequacy.hpp, unnamed.hpp, rest.hpp). Test what the residuals still depend on;
//      add unnamed terms for it, and describe the noise of the rest.
//   4. Identified model (identified_model.hpp, evidence.hpp). Sizes with 95 % intervals, and what
//      wheels, currents and voltage show of each effect.
//   5. Errors (end_errors.hpp) and verdict (verdict.hpp). Errors on driving that was used neither
//      for choosing the effects nor for their sizes: the test drives or, without any, alternate
//      blocks of the training drives, each half predicted from the other.
namespace tread::gap {

/// The task of `tread-gap find`.
struct GapTask {
  ModelDocument model;
  std::vector<Drive> train;
  std::vector<Drive> test;         ///< never used for structure or parameters; may be empty
  std::vector<LogNote> log_notes;  ///< notes on the logs
  /// Also fits lag, delay and gains of the nominal model: makes a model of a new vehicle.
  bool calibrate = false;
  /// Keeps all real effects, however little they change the end error.
  bool keep_small = false;
  /// Deviations that no effect explains are reported but not added to the new model as a term; the
  /// same holds if a person has rejected an effect, which would otherwise return without its name.
  bool named_only = false;
  /// Accepted effects are in the model from the start and are kept; rejected ones are never
  /// considered.
  std::vector<EffectDecision> decisions;
  uint64_t seed = 1;
  ParallelFor parallel = serialFor;  ///< does not change a bit of the result
  TimeLimit is_over = neverOver;     ///< if so, the search returns the best result so far
};

/// The five steps. Deterministic for a seed.
/** Throws std::invalid_argument for an accepted effect whose size the drives cannot determine. */
GapFinding findGap(const GapTask& task, const Progress& say);

}  // namespace tread::gap
