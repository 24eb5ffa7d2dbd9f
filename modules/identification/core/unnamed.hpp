// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/pruning.hpp"

// A remainder that no effect explains but that has a shape becomes a term of the model: a curve
// over one condition known to the kernel during simulation, times a second one.
namespace tread::gap {

/// Largest number of terms that one search adds.
inline constexpr size_t kMostUnnamed = 2;

/// Variation of a term's values from one drive to another, as a share of its largest value.
/** A term is only similar to its cause: in a drive with other conditions its values differ. By more
 * than kRestVaries, because the term was chosen for one drive. */
inline constexpr double kTermVaries = 0.4;

/// Size of the largest value of a term.
double largestValue(const UnnamedTerm& term);

/// The values of a model's unnamed terms for a fit: with priors from the model's covariance and
/// kTermVaries; free when the model is calibrated.
std::vector<FreeParameter> termParameters(const ModelDocument& model, bool calibrate);

/// The channels of a term that acts on these channels of the residuals, each once.
std::vector<TermChannel> termChannels(const std::vector<Unexplained>& unexplained);

/// Proposes a term on one of these channels, and includes it in the state if it is confirmed.
/** 1. The conditions of each row come from one simulation. A curve of three values over each
 *    condition, 0 where the condition is 0, alone and times each factor, is scored by its
 *    first-order gain in addition to all free parameters. 2. The most promising ones are simulated
 *    by the kernel and refitted; the one with the largest gain on held-out blocks is kept, with
 *    five values if these gain significantly more. 3. It must gain on held-out blocks by `sure`
 *    standard errors and kTermNats. Only the fitter's rows count. Returns the gain; nullopt if no
 *    term is confirmed, with the state unchanged. */
std::optional<UnnamedFinding> addTerm(const Fitter& fitter, FitState& state,
                                      const std::vector<TermChannel>& channels, double sure);

inline constexpr double kTermSure = 3.0;  ///< standard errors: a form was chosen from hundreds
/// The same when all of the driving has confirmed a term, and half of it chooses one.
inline constexpr double kTermSureOfHalf = 1.0;
/// Standard errors; more than for a named effect, whose form is given.
inline constexpr double kEndSure = 2.0;
inline constexpr double kTermNats = 10.0;  ///< [nats]

/// Whether a term reduces the end error by kEndSure standard errors and by the share `least_gain`,
/// on halves of the driving that were not used for the sizes, without making position or heading
/// significantly worse.
bool lessensEndError(const Fitter& fitter, const FitState& with, const FitState& without,
                     double least_gain);

/// Adds terms to the result of a search while the remainder has a shape.
/** `adequacy` is that of the result's state; afterwards that of the state with the terms. */
void addUnnamedTerms(const SearchState& search, double adequacy_alpha, Adequacy& adequacy,
                     std::vector<UnnamedFinding>& found);

/// Share of a term that counts as rest, for the error of its form.
/** Chosen on drives of other vehicles: with 1, a dead band that had become five times as large was
 * not detected beside a term. */
inline constexpr double kTermForm = 0.25;

/// Includes a model's terms in its rest: the whole rest of each channel (kAllConditions) is the
/// remainder and the share kTermForm of its terms, root mean square over the rows.
/** A term is only similar to its cause, and the difference varies from drive to drive. */
void countTermsToRest(const Observations& data, ModelDocument& model);

/// The remainder over the condition of a term of the model: means over cells of the residuals
/// without the term, divided by its factor.
std::vector<AtlasCell> termCells(const Fitter& fitter, const ModelDocument& model,
                                 const UnnamedTerm& term);

}  // namespace tread::gap
