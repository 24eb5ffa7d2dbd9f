// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/validation.hpp"

// Statistics of rows and their blocks for a state: held-out losses, covariances, score tests.
namespace tread::gap {

/// A direction in which an effect that is off could act, with the start values of its fit; or one
/// in which a given term of the model may have changed (`release`): slightly or, if the slope is
/// uninformative because the drive does not reach the given value (limits, thresholds), to another
/// value altogether (`elsewhere`).
struct Candidate {
  std::string effect;
  std::string parameter;  ///< of the effect: the strength that is switched on
  double value = 0.0;     ///< trial value
  double change = 0.0;    ///< difference from the value without effect; the direction is the secant
  double since = kNotMeasured;  ///< [s] time of a change at which it begins to act; NaN = always
  /// Accompanying values: shapes such as the time of a change.
  std::vector<std::pair<std::string, double>> shapes;
  std::vector<std::string> free;  ///< paths freed by a fit of this candidate
  std::string change_point;       ///< path of the time of a change; empty = none
  bool release = false;           ///< of a given term: its prior no longer counts
  bool elsewhere = false;         ///< of a release: begins at `value`, far from the given one

  /// Of the strength.
  std::string path() const { return effect + "." + parameter; }
};

/// The largest demands of a drive, in first approximation; limits are probed below them.
struct Excitation {
  double track_speed = 0.0;  ///< [m/s] commanded
  double omega = 0.0;        ///< [rad/s]
  double v_omega = 0.0;      ///< [m/s2]
  double begin = 0.0;        ///< [s] first command
  double end = 0.0;          ///< [s] last command
  bool voltage = false;      ///< the battery was measured in every drive
};

/// Whether the time limit of a search has passed; polled between its steps, needs no clock of its
/// own.
using TimeLimit = std::function<bool()>;
inline bool neverOver() {
  return false;
}

/// Settings of a search.
struct SearchSettings {
  double alpha = 0.02;       ///< error probability of the first test over the whole catalogue
  double alpha_more = 0.05;  ///< the same for every further test, once an effect was found
  int draws = 1999;          ///< of the bootstrap
  size_t tried = 4;          ///< number of effects refitted at a time
  size_t most = 8;           ///< largest number of effects added
  bool calibrate = false;    ///< the numbers of the nominal model are free
  bool release = true;       ///< given terms may differ from the model
  /// Of the end error; smaller effects are real but negligible; 0 = none is
  double least_gain = 0.01;
  /// Final decision of a person: included from the calibration on, whatever the tests give.
  std::vector<std::string> accepted;
  std::vector<std::string> rejected;  ///< never considered
  bool all_sized = false;             ///< stop at once if an accepted one cannot be sized
  uint64_t seed = 1;
  TimeLimit is_over = neverOver;  ///< if so, the search adds nothing more, prunes and ends
};

/// Directions of candidates that were simulated once and are reused.
/** A direction hardly changes when another effect joins the model, and not at all with the
 * selection of rows: those of the first test also serve the halves of a nested evaluation. */
class SensitivityCache {
 public:
  /// Basis of the candidates' limits, measured with the first state.
  const Excitation& excitation(const Fitter& fitter, const FitState& state);

  /// Directions of candidates, rows x candidates; unknown ones are simulated.
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

/// The smallest size of a candidate's effect that would have been detected, in its parameter's
/// unit.
/** `sizeOf`: the same for each candidate by its slope. A limit either acts or
 * does not, so its size cannot shrink: for a limit it is the weakest of the candidates that would
 * have been detected. Infinite if none would. */
double detectableSize(const std::vector<Candidate>& candidates,
                      const std::function<double(size_t)>& sizeOf, size_t index);

/// A test of all candidates against one state, and the highest-scoring candidate of each effect.
struct Screening {
  std::vector<Candidate> candidates;
  std::vector<double> scores;
  std::vector<double> sizes;
  std::vector<double> chance;    ///< largest scores under the null hypothesis, sorted
  std::vector<double> evidence;  ///< relative to the requirement: above 1 chance is excluded
  std::vector<double> promise;   ///< gain in first order [nats]
  double alpha = 0.0;            ///< of this test
  bool first = false;            ///< no effect has been found yet
  double overdispersion = 1.0;   ///< median over the candidates
  std::vector<size_t> best;      ///< of each effect, largest score first
  std::vector<CandidateTest> tests;
};

/// Tests every candidate for a state, with directions from the cache.
/** `first`: no effect has been found yet, so that the usual scatter is unknown. */
Screening screen(const Fitter& fitter, const FitState& state, const SearchSettings& settings,
                 bool first, SensitivityCache& cache);

/// Requirements on a candidate's score.
Needed neededFor(const Screening& screening, size_t candidate);

/// The most promising candidate of each significant effect, the most promising effects first.
std::vector<size_t> significant(const Screening& screening);

/// p-value of a score: by blocks, or by its size if that was decisive.
double pValueOf(const Screening& screening, double score, double evidence);

}  // namespace tread::gap
