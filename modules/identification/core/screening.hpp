// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/validation.hpp"

namespace tread::gap {

/// One direction in which an effect that is off could act, and where a fit of it begins; or one in
/// which a held term of the model may have changed (`release`).
struct Candidate {
  std::string effect;
  std::string parameter;  ///< of the effect: the strength that is switched on
  double value = 0.0;     ///< at which it is tried
  double change = 0.0;    ///< that this is from where it does nothing; the direction is the secant
  double since = kNotMeasured;  ///< [s] time of a change from which on it acts; NaN = always
  /// Values that go with it: shapes such as the time of a change.
  std::vector<std::pair<std::string, double>> shapes;
  std::vector<std::string> free;  ///< paths that a fit of this candidate frees
  std::string change_point;       ///< path of the time of a change; empty = none
  bool release = false;           ///< frees a held term: what was known of it no longer counts

  /// Of the strength.
  std::string path() const { return effect + "." + parameter; }
};

/// The most that a drive demands, in first approximation; limits are probed below it.
struct Excitation {
  double track_speed = 0.0;  ///< [m/s] commanded
  double omega = 0.0;        ///< [rad/s]
  double v_omega = 0.0;      ///< [m/s2]
  double begin = 0.0;        ///< [s] first command
  double end = 0.0;          ///< [s] last command
  bool voltage = false;      ///< the battery was measured
};
Excitation excitationOf(const Observations& data, const ModelDocument& model);

/// All directions of all effects of the catalogue that are off in a model.
/** Thresholds and change points get several (their gradient at 0 says nothing). Effects that
 * are another one under a second name are left to their groups. */
std::vector<Candidate> candidatesFor(const ModelDocument& model, const Excitation& excitation);

/// Those of a state: also effects that are on and held by what is known of them, to be freed; where
/// numbers of the nominal model are free without limits, effects that are the same under another
/// name are left out.
std::vector<Candidate> candidatesFor(const FitState& state, const Excitation& excitation);

/// Those of one effect, even if it is another one under a second name.
std::vector<Candidate> candidatesOf(const std::string& effect, const FitState& state,
                                    const Excitation& excitation);

/// Takes out the candidates of these effects.
void leaveOut(std::vector<Candidate>& candidates, const std::vector<std::string>& effects);

/// A model with the candidate at its trial value.
ModelDocument tried(const ModelDocument& model, const Candidate& candidate);

/// The directions of candidates, rows x candidates.
Eigen::MatrixXd directionsOf(const Fitter& fitter, const FitState& state,
                             const std::vector<Candidate>& candidates);

/// Frees the candidate's parameters in a state, from its trial value scaled by first order.
void addCandidate(const Fitter& fitter, FitState& state, const Candidate& candidate, double size);

/// Whether a size is nothing beside what is typical.
bool isVanishing(const std::string& effect, const std::string& parameter, double size);

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
