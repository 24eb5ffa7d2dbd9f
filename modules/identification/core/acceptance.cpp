// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include "modules/identification/core/change_points.hpp"
#include "modules/identification/core/search_steps.hpp"

namespace tread::gap {
namespace {

constexpr double kUnknown = 2.0;  // times its typical size: what the 95 % interval must not exceed

/// The candidate that promises most; none that would change anything = candidates.
size_t mostPromising(const ScoreTest& test) {
  const auto count = static_cast<size_t>(test.candidates());
  size_t best = count;
  double promise = 0.0;
  for (size_t i = 0; i < count; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (test.uniqueness(at) <= 0.0 || (best < count && test.promise(at) <= promise)) continue;
    best = i;
    promise = test.promise(at);
  }
  return best;
}

std::string reasonAgainst(const Fitter& fitter, const FitState& state, const Candidate& candidate,
                          const std::vector<char>& mask) {
  const std::string strength = candidate.effect + "." + candidate.parameter;
  const Eigen::MatrixXd covariance = parameterCovariance(fitter.data(), state, mask);
  const double typical = parameterNamed(effectNamed(candidate.effect), candidate.parameter).typical;
  for (size_t i = 0; i < state.free.size(); ++i) {
    if (state.free[i].path != strength) continue;
    const auto at = static_cast<Eigen::Index>(i);
    if (isVanishing(candidate.effect, candidate.parameter, *findParameter(state.model, strength)))
      return "its size vanishes in the fit";
    if (onBound(state.model, state.free[i]))
      return "its size runs to the end of its plausible range";
    if (!(1.96 * std::sqrt(covariance(at, at)) < kUnknown * std::abs(typical)))
      return "nothing in this drive makes it visible";
  }
  return "";
}

}  // namespace

std::string takeIn(const Fitter& fitter, FitState& state, const std::string& effect,
                   const std::vector<char>& mask) {
  const auto candidates = candidatesOf(effect, state, excitationOf(fitter.data(), state.model));
  if (candidates.empty()) return "it is a number of the nominal model, which is free";
  const ScoreTest test(fitter.data(), state, directionsOf(fitter, state, candidates), mask);
  const size_t best = mostPromising(test);
  if (best == candidates.size())
    return "it changes nothing that this drive shows, or nothing that the model's other free "
           "terms do not";
  FitState tried = state;
  addCandidate(fitter, tried, candidates[best], test.size(static_cast<Eigen::Index>(best)), mask);
  fitter.fitRoughly(tried, mask);
  if (!candidates[best].change_point.empty())
    refineChangePoint(fitter, tried, candidates[best].change_point, mask);
  fitter.renewNoise(tried, mask);
  fitter.fit(tried, mask);
  const std::string why = reasonAgainst(fitter, tried, candidates[best], mask);
  if (why.empty()) state = std::move(tried);
  return why;
}

}  // namespace tread::gap
