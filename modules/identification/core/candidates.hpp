// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "modules/identification/core/fit.hpp"

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

}  // namespace tread::gap
