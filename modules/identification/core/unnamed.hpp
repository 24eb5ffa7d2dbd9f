// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/search.hpp"

// What is left after all names and has a shape becomes a term of the model: a curve over one
// condition that the kernel knows while it simulates, times a second one.
namespace tread::gap {

/// Terms that one search adds at most.
inline constexpr size_t kMostUnnamed = 2;

/// By this share of its largest value each value of a term may differ from one drive to another.
/** A term is only like what it stands for: where a drive has other conditions beside its own, its
 * values are others. By more than kRestVaries, as the term was chosen for one drive. */
inline constexpr double kTermVaries = 0.4;

/// Size of the largest value of a term.
double largestValue(const UnnamedTerm& term);

/// The values of the unnamed terms that a model has, for a fit: held by the model's covariance and
/// by kTermVaries; free where the model is calibrated.
std::vector<FreeParameter> termParameters(const ModelDocument& model, bool calibrate);

/// The channels of a term that acts on these channels of the residuals, each once.
std::vector<TermChannel> termChannels(const std::vector<Unexplained>& unexplained);

/// Proposes a term on one of these channels, and takes it into the state if it holds.
/** 1. The conditions of each row come from one simulation. A curve of three values over each
 * condition, 0 where the condition is 0, alone and times each factor, is scored by what it gains in
 * first order beside all that is free. 2. The most promising ones are simulated by the kernel and
 * refitted; the one that gains most on blocks left out is kept, with five values if these gain more
 * beyond chance. 3. It must gain on blocks left out by `sure` standard errors and kTermNats. The
 * fitter's rows alone count. Returns the gain; nothing where no term holds, and then the state is
 * as it was. */
std::optional<UnnamedFinding> addTerm(const Fitter& fitter, FitState& state,
                                      const std::vector<TermChannel>& channels, double sure);

inline constexpr double kTermSure = 3.0;  ///< standard errors: a form was chosen from hundreds
/// The same where all of the driving has shown that there is a term, and half of it chooses one.
inline constexpr double kTermSureOfHalf = 1.0;
/// Standard errors; more than of a named effect, whose form is known beforehand.
inline constexpr double kEndSure = 2.0;
inline constexpr double kTermNats = 10.0;  ///< [nats]

/// Whether the end error is less with a term than without it, by kEndSure standard errors and by
/// the share `least_gain`, on halves of the driving that the sizes were not fitted to; and neither
/// position nor heading is worse beyond its standard error.
bool lessensEndError(const Fitter& fitter, const FitState& with, const FitState& without,
                     double least_gain);

/// Adds terms to what a search found, as long as something with a shape is left.
/** `adequacy` is of the result's state; afterwards it is of the state with the terms. */
void addUnnamedTerms(const SearchState& search, double adequacy_alpha, Adequacy& adequacy,
                     std::vector<UnnamedFinding>& found);

/// Share of a term that counts to the rest: by so much its form may be off.
/** Chosen on drives of foreign vehicles: with 1 a dead band that had become five times as large was
 * nothing new beside a term. */
inline constexpr double kTermForm = 0.25;

/// Counts the terms of a model to its rest: the whole of each channel (kAllConditions) is what it
/// leaves and the share kTermForm of what its terms say, root mean square over the rows.
/** A term is only like what it stands for, and what is between the two is another one on each
 * drive. */
void countTermsToRest(const Observations& data, ModelDocument& model);

/// What is left over the condition of a term that the model has: the means over cells of the
/// residuals with the term in them, over its factor.
std::vector<AtlasCell> termCells(const Fitter& fitter, const ModelDocument& model,
                                 const UnnamedTerm& term);

}  // namespace tread::gap
