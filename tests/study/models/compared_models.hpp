// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "modules/identification/core/end_errors.hpp"
#include "modules/identification/core/search.hpp"
#include "tests/study/models/twist_regression.hpp"

namespace tread::gap {

/// Models in use, each with more freedom than the previous one.
/** kIdeal          the given model, nothing fitted.
 *  kGains          slip_ratio, track_width: command gain and track fitted; and ins_latency, of the
 *                  pose alone, as in all rungs below.
 *  kPowertrain     and actuator_lag, command_delay, speed_saturation, track_asymmetry, icr_offset.
 *  kSlipRegression the published slip model: lag, delay, saturation, gain, track and latency as
 *                  above, then held, and Bayesian linear regression of the slip velocities on the
 *                  simulated twist: forward ~ v, sideways ~ v omega, turning ~ v omega, v, omega;
 *                  prior N(0, 1 m/s or rad/s) of terms scaled to a root mean square of 1. Unlike in
 *                  the papers powertrain and slip come from the poses alone, not from encoders, and
 *                  from all driving, not from steady windows.
 *  kBlackBox       kPowertrain, then held, and ridge regression of all parts of the twist on a
 *                  dictionary of 37 polynomials, thresholds and transients of filtered twist and
 *                  commands; its strength by blocked cross-validation within the training driving.
 *  kAllParameters  every effect of the catalogue in its likeliest form and the numbers of the
 *                  nominal model, fitted at once by damped least squares within plausible ranges.
 *  kSparse         what a sequentially thresholded regression (SINDy) on the directions of the same
 *                  effects leaves, fitted in the same way.
 *  kDiscovered     what search() finds with the numbers of the nominal model free: find
 * --calibrate. The last three begin where a fit of lag, delay, gain and track ends. */
enum class Rung {
  kIdeal,
  kGains,
  kPowertrain,
  kSlipRegression,
  kBlackBox,
  kAllParameters,
  kSparse,
  kDiscovered
};
inline constexpr size_t kRungs = 8;
inline constexpr auto kFound = static_cast<size_t>(Rung::kDiscovered);

/// "ideal", "gain + track", ... for tables.
const char* rungName(Rung rung);
/// "ideal", "gain_track", ... for files.
const char* rungKey(Rung rung);

/// A model of one rung.
struct RungModel {
  ModelDocument model;
  TwistRegression correction;        ///< empty if the rung has none
  std::vector<std::string> effects;  ///< named effects, for the last three rungs
  std::vector<std::string> at_end;   ///< paths of sizes at the ends of their plausible ranges
  /// Fitted paths and values.
  std::vector<std::pair<std::string, double>> numbers;
};

/// Models by rung; nullopt if a rung is unavailable.
using RungModels = std::array<std::optional<RungModel>, kRungs>;

/// All rungs but the discovered one, from the fitter's rows.
/** Without kIdeal if the ideal model is unknown and only a start value. */
RungModels fitRungs(const Fitter& fitter, const ModelDocument& ideal, bool ideal_known,
                    const Progress& say);

/// Lag, delay and gains fitted to the fitter's rows, as numbers of the nominal model.
ModelDocument calibratedNumbers(const Fitter& fitter, const ModelDocument& ideal);

/// Result of find --calibrate on the fitter's rows, starting from a model.
FoundTerms discover(const Fitter& fitter, const ModelDocument& begin, uint64_t seed,
                    const Progress& say);
/// As a rung, with the state of the search or one refitted elsewhere.
RungModel discoveredRung(const FoundTerms& found, const FitState& state);

/// End errors of a rung on executions of any rows.
std::vector<ExecutionError> endErrors(const Observations& data, const RungModel& rung);

}  // namespace tread::gap
