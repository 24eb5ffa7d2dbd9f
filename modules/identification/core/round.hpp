// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/direction_book.hpp"
#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/score_test.hpp"
#include "modules/identification/core/search_settings.hpp"

namespace tread::gap {

/// A test of all candidates against one state, and for each effect the candidate with the largest
/// score.
struct Round {
  std::vector<Candidate> candidates;
  std::vector<double> scores;
  std::vector<double> sizes;
  std::vector<double> chance;    ///< largest scores of worlds in which nothing is there
  std::vector<double> evidence;  ///< over what is needed: above 1 chance is no explanation
  std::vector<double> promise;   ///< gain in first order [nats]
  double alpha = 0.0;            ///< of this test
  bool first = false;            ///< nothing has been found yet
  double overdispersion = 1.0;   ///< as usual over the candidates
  std::vector<size_t> best;      ///< of each effect, largest score first
  std::vector<CandidateTest> tests;
};

/// Tests every candidate for a state, with directions from the book.
/** `first`: nothing has been found yet, so that what usually scatters is not known. */
Round testedRound(const Fitter& fitter, const FitState& state, const std::vector<char>& mask,
                  const SearchSettings& settings, bool first, DirectionBook& book);

/// Of each effect beyond chance the most promising candidate; the most promising effects first.
std::vector<size_t> significant(const Round& round);

/// Probability of a score by chance: by blocks, or by its size where that was what convinced.
double pValueOf(const Round& round, double score, double evidence);

}  // namespace tread::gap
