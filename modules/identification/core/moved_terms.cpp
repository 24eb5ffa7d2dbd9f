// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/moved_terms.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include <Eigen/Eigenvalues>

#include "modules/identification/core/search_steps.hpp"

namespace tread::gap {
namespace {

constexpr double kMoved = 0.01;  // probability that any given term is wrongly reported as changed
constexpr double kLeastTogether = 1e-3;  // of a variance, in any combination of terms: lower limit
constexpr double kBearable = 10.0;       // [nats] allowed cost of fewer changes

/// Terms that moved together by more than chance, though each alone may not: a delay and a lag may
/// each be vague while their sum is well known. Of each such combination the term with the largest
/// part.
/** Needed where a known rest makes each term vaguer. */
std::vector<char> movedTogether(const FitState& state, const Eigen::MatrixXd& moves, double most) {
  std::vector<char> moved(state.free.size(), 0);
  std::vector<Eigen::Index> held;
  for (size_t i = 0; i < state.free.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (std::isfinite(state.free[i].deviation) && !isNameless(state, i) &&
        std::isfinite(moves(at, at)) && moves(at, at) > 0.0)
      held.push_back(at);
  }
  if (held.empty() || !state.model.rest || state.model.rest->empty()) return moved;
  const Eigen::MatrixXd covariance = moves(held, held);
  const Eigen::VectorXd unit = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::VectorXd off = unit.cwiseProduct(Eigen::VectorXd(offExpected(state)(held)));
  const Eigen::MatrixXd correlation = unit.asDiagonal() * covariance * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation);
  for (Eigen::Index k = 0; k < off.size(); ++k) {
    const Eigen::VectorXd parts = eigen.eigenvectors().col(k).cwiseProduct(off);
    const double variance = std::max(kLeastTogether, eigen.eigenvalues()[k]);
    if (std::abs(parts.sum()) <= most * std::sqrt(variance)) continue;
    Eigen::Index largest = 0;
    parts.cwiseAbs().maxCoeff(&largest);
    moved[static_cast<size_t>(held[static_cast<size_t>(largest)])] = 1;
  }
  return moved;
}

/// Indices of given terms that moved and are held by a prior.
std::vector<size_t> movedTerms(const SearchState& search, const ModelDocument& before) {
  const FitState& state = search.result.state;
  const Moves moves = movesOf(search.fitter, before, search.result);
  std::vector<size_t> moved;
  for (size_t i = 0; i < state.free.size(); ++i) {
    const std::string& path = state.free[i].path;
    if (isNameless(state, i) || !std::isfinite(state.free[i].deviation) ||
        contains(search.result.effects, effectOf(path)))
      continue;
    ParameterEstimate estimate;
    estimate.parameter = path;
    estimate.value = *findParameter(state.model, path);
    estimate.before = state.free[i].expected;
    if (hasMoved(estimate, moves.byChance(i), false) || moves.together[i]) moved.push_back(i);
  }
  return moved;
}

/// The state with the prior of one term restored, and everything fitted.
FitState held(const Fitter& fitter, FitState state, const MovedTerm& term) {
  for (FreeParameter& parameter : state.free)
    if (parameter.path == term.path) parameter.deviation = term.deviation;
  fitter.fit(state);
  return state;
}

}  // namespace

std::vector<MovedTerm> freedTerms(const SearchState& search) {
  const FitState& state = search.result.state;
  std::vector<MovedTerm> terms;
  for (const FreeParameter& parameter : state.free) {
    const double deviation = knownDeviation(state.model, parameter.path);
    if (std::isinf(parameter.deviation) && std::isfinite(deviation) && isGiven(parameter))
      terms.push_back({parameter.path, deviation});
  }
  return terms;
}

bool isNameless(const FitState& state, size_t index) {
  const std::string& path = state.free[index].path;
  return restTermOf(path) || termOfPath(state.model, path) != nullptr;
}

bool hasMoved(const ParameterEstimate& estimate, double most_by_chance, bool calibrate) {
  const bool number = estimate.parameter.find('.') == std::string::npos;
  if (number && calibrate) return false;
  return std::abs(estimate.value - estimate.before) > most_by_chance;
}

Moves movesOf(const Fitter& fitter, const ModelDocument& before, const FoundTerms& result) {
  const FitState& state = result.state;
  size_t given = 0;
  for (size_t i = 0; i < state.free.size(); ++i)
    given += !contains(result.effects, effectOf(state.free[i].path)) &&
             (!isNameless(state, i) || termOfPath(before, state.free[i].path) != nullptr);
  Moves moves;
  moves.most =
      studentQuantile(fitter.data().measuredBlocks() - 1,
                      normalQuantileOf(kMoved / static_cast<double>(std::max<size_t>(1, given))));
  moves.covariance = moveCovariance(fitter, state);
  moves.together = movedTogether(state, moves.covariance, moves.most);
  return moves;
}

void reestimateMoved(const SearchState& search, const ModelDocument& before) {
  if (search.settings.calibrate || search.isCutShort()) return;
  const std::vector<size_t> moved = movedTerms(search, before);
  FitState freed = search.result.state;
  std::vector<MovedTerm> terms = freedTerms(search);
  for (const size_t i : moved) {
    terms.push_back({freed.free[i].path, freed.free[i].deviation});
    freed.free[i].deviation = std::numeric_limits<double>::infinity();
  }
  if (terms.empty()) return;
  search.fitter.fit(freed);
  for (size_t i = 0; i < terms.size() && terms.size() > 1 && !search.isCutShort();) {
    FitState fewer = held(search.fitter, freed, terms[i]);
    if (fewer.loss - freed.loss > kBearable) {
      ++i;
      continue;
    }
    freed = std::move(fewer);
    terms.erase(terms.begin() + static_cast<std::ptrdiff_t>(i));
  }
  search.result.state = std::move(freed);
  while (replaceMoved(search, terms)) continue;  // each replacement removes a term
}

}  // namespace tread::gap
