// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/validation.hpp"

namespace tread::gap {

/// How a search is done.
struct SearchSettings {
  double alpha =
      0.02;  ///< probability that the first test over the whole catalogue names something wrongly
  double alpha_more = 0.05;  ///< the same of every further test, once something is there
  int draws = 1999;          ///< of the bootstrap
  size_t tried = 4;          ///< effects that are refitted at a time
  size_t most = 8;           ///< effects that are added at most
  bool calibrate = false;    ///< the numbers of the nominal model are free
  double least_gain = 0.01;  ///< of the end error; less is real but negligible; 0 = none is
  /// A person's last word: in from calibration on, whatever tests say.
  std::vector<std::string> accepted;
  std::vector<std::string> rejected;  ///< never considered
  bool all_sized = false;             ///< ends at once where an accepted one cannot be sized
  uint64_t seed = 1;
};

/// Directions of candidates that were simulated once and serve again.
/** A direction hardly changes when another effect joins the model, and not at all with the data
 * that a fit looks at: those of the first test serve the halves of a nested evaluation, too. */
class SensitivityCache {
 public:
  /// What the limits of candidates are taken from, measured with the first state.
  const Excitation& excitation(const Fitter& fitter, const FitState& state);

  /// Directions of candidates, rows x candidates; those that are not known are simulated.
  Eigen::MatrixXd directions(const Fitter& fitter, const FitState& state,
                             const std::vector<Candidate>& candidates);

  /// Simulates some candidates again at a state.
  void renew(const Fitter& fitter, const FitState& state, const std::vector<Candidate>& candidates);

 private:
  struct Entry {
    Candidate candidate;
    Eigen::VectorXd direction;
  };
  Entry* find(const Candidate& candidate);

  bool measured_ = false;
  Excitation excitation_;
  std::vector<Entry> entries_;
};

/// The smallest size of a candidate's effect that would have been seen, in its parameter's unit.
/** `needed`: score from which on an effect is seen, with the power that is wanted. A limit bites or
 * does not, and has no size that shrinks: of a limit it is the gentlest one among the candidates
 * that would have been seen. Infinite where nothing would. */
double detectableSize(const std::vector<Candidate>& candidates, const ScoreTest& test, size_t index,
                      double needed);

/// A test of all candidates against one state, and for each effect the candidate with the largest
/// score.
struct Screening {
  std::vector<Candidate> candidates;
  std::vector<double> scores;
  std::vector<double> sizes;
  std::vector<double> chance;    ///< largest scores where nothing is there, sorted
  std::vector<double> evidence;  ///< over what is needed: above 1 chance is no explanation
  std::vector<double> promise;   ///< gain in first order [nats]
  double alpha = 0.0;            ///< of this test
  bool first = false;            ///< nothing has been found yet
  double overdispersion = 1.0;   ///< as usual over the candidates
  std::vector<size_t> best;      ///< of each effect, largest score first
  std::vector<CandidateTest> tests;
};

/// Tests every candidate for a state, with directions from the cache.
/** `first`: nothing has been found yet, so that what usually scatters is not known. */
Screening screen(const Fitter& fitter, const FitState& state, const SearchSettings& settings,
                 bool first, SensitivityCache& cache);

/// Of each effect beyond chance the most promising candidate; the most promising effects first.
std::vector<size_t> significant(const Screening& screening);

/// Probability of a score by chance: by blocks, or by its size where that was what convinced.
double pValueOf(const Screening& screening, double score, double evidence);

}  // namespace tread::gap
