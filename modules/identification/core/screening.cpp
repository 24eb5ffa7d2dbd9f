// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/screening.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "modules/identification/core/candidates.hpp"

namespace tread::gap {
namespace {

bool isSame(double a, double b) {
  return a == b || (a != a && b != b);
}

bool isSame(const Candidate& a, const Candidate& b) {
  return a.effect == b.effect && a.parameter == b.parameter && a.change == b.change &&
         isSame(a.since, b.since) && a.shapes == b.shapes && a.elsewhere == b.elsewhere;
}

bool isSimulated(const Candidate& candidate) {
  return !candidate.release || candidate.elsewhere;
}

/// For a fitted term: its column of the Jacobian.
Eigen::VectorXd releaseDirection(const FitState& state, const Candidate& candidate) {
  const std::string path = candidate.path();
  for (size_t i = 0; i < state.free.size(); ++i)
    if (state.free[i].path == path) return state.jacobian.col(static_cast<Eigen::Index>(i));
  throw std::logic_error("" + path + " is not free, and cannot be released");
}

constexpr double kChangeAlpha = 0.01;  // for effects that may begin at any time

std::vector<size_t> bestOfEffects(const Screening& screening) {
  std::map<std::string, size_t> best;
  for (size_t i = 0; i < screening.candidates.size(); ++i) {
    const auto known = best.emplace(screening.candidates[i].effect, i).first;
    if (std::abs(screening.scores[i]) > std::abs(screening.scores[known->second]))
      known->second = i;
  }
  std::vector<size_t> order;
  for (const auto& [effect, index] : best) order.push_back(index);
  std::stable_sort(order.begin(), order.end(), [&screening](size_t a, size_t b) {
    return std::abs(screening.scores[a]) > std::abs(screening.scores[b]);
  });
  return order;
}

/// Whether an effect may begin at any time: it can match a few random blocks anywhere, and must
/// show in many.
bool mayBeginLater(const Screening& screening, size_t candidate) {
  return !effectNamed(screening.candidates[candidate].effect).search.change_points.empty();
}

double levelOf(const Screening& screening, size_t candidate) {
  return mayBeginLater(screening, candidate) ? std::min(screening.alpha, kChangeAlpha)
                                             : screening.alpha;
}

/// Evidence for a candidate relative to the requirement; less than 1 if chance explains it.
double evidenceOf(const ScoreTest& test, size_t candidate, const Screening& screening) {
  const auto at = static_cast<Eigen::Index>(candidate);
  const double found = evidence(test, at, neededFor(screening, candidate));
  return familyWise(screening.chance, test.score(at)) <= levelOf(screening, candidate)
             ? std::max(1.0, found)
             : found;
}

}  // namespace

const Excitation& SensitivityCache::excitation(const Fitter& fitter, const FitState& state) {
  if (!measured_) excitation_ = excitationOf(fitter.data(), state.model);
  measured_ = true;
  return excitation_;
}

SensitivityCache::Entry* SensitivityCache::find(const Candidate& candidate) {
  for (Entry& entry : entries_)
    if (isSame(entry.candidate, candidate)) return &entry;
  return nullptr;
}

Eigen::MatrixXd SensitivityCache::directions(const Fitter& fitter, const FitState& state,
                                             const std::vector<Candidate>& candidates) {
  std::vector<Candidate> missing;
  for (const Candidate& candidate : candidates)
    if (isSimulated(candidate) && find(candidate) == nullptr) missing.push_back(candidate);
  renew(fitter, state, missing);
  Eigen::MatrixXd all(state.predicted.size(), static_cast<Eigen::Index>(candidates.size()));
  for (size_t i = 0; i < candidates.size(); ++i)
    all.col(static_cast<Eigen::Index>(i)) = isSimulated(candidates[i])
                                                ? find(candidates[i])->direction
                                                : releaseDirection(state, candidates[i]);
  return all;
}

void SensitivityCache::renew(const Fitter& fitter, const FitState& state,
                             const std::vector<Candidate>& candidates) {
  if (candidates.empty()) return;
  // For all rows: searches over other rows will need the same directions.
  const Fitter all = fitter.onAllRows();
  FitState of = state;
  of.predicted = all.predict(state.model);
  const Eigen::MatrixXd directions = directionsOf(all, of, candidates);
  for (size_t i = 0; i < candidates.size(); ++i) {
    const Eigen::VectorXd direction = directions.col(static_cast<Eigen::Index>(i));
    if (Entry* known = find(candidates[i]))
      known->direction = direction;
    else
      entries_.push_back({candidates[i], direction});
  }
}

double detectableSize(const std::vector<Candidate>& candidates,
                      const std::function<double(size_t)>& sizeOf, size_t index) {
  const Candidate& best = candidates[index];
  if (!parameterNamed(effectNamed(best.effect), best.parameter).reciprocal()) return sizeOf(index);
  double gentlest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& tried = candidates[i];
    // The direction leads to the limit itself: it must be detected completely.
    if (tried.effect == best.effect && tried.parameter == best.parameter &&
        sizeOf(i) <= tried.change)
      gentlest = std::min(gentlest, tried.value);
  }
  return gentlest;
}

Screening screen(const Fitter& fitter, const FitState& state, const SearchSettings& settings,
                 bool first, SensitivityCache& cache) {
  Screening screening;
  screening.first = first;
  screening.alpha = first ? settings.alpha : settings.alpha_more;
  screening.candidates = candidatesFor(state, cache.excitation(fitter, state));
  leaveOut(screening.candidates, settings.rejected);
  if (!settings.release)
    screening.candidates.erase(
        std::remove_if(screening.candidates.begin(), screening.candidates.end(),
                       [](const Candidate& candidate) { return candidate.release; }),
        screening.candidates.end());
  const ScoreTest test(fitter, state, cache.directions(fitter, state, screening.candidates));
  screening.chance = test.largestByChance(settings.draws, settings.seed);
  screening.overdispersion = test.usualOverdispersion();
  for (size_t i = 0; i < screening.candidates.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    screening.scores.push_back(test.score(at));
    screening.sizes.push_back(test.size(at));
    screening.evidence.push_back(evidenceOf(test, i, screening));
    screening.promise.push_back(test.promise(at));
  }
  screening.best = bestOfEffects(screening);
  const Needed needed{criticalScore(screening.chance, settings.alpha), screening.overdispersion,
                      first, true};
  const auto leastOf = [&](size_t i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (!fitter.data().isBrief()) return (needed.score + kPowerQuantile) * test.sizeError(at);
    return mayBeginLater(screening, i) ? std::numeric_limits<double>::infinity()
                                       : leastSize(test, at, needed);
  };
  for (size_t i : screening.best) {
    if (screening.candidates[i].release) continue;  // on, and fitted
    const auto at = static_cast<Eigen::Index>(i);
    screening.tests.push_back(
        {screening.candidates[i].effect, screening.candidates[i].parameter, screening.scores[i],
         familyWise(screening.chance, screening.scores[i]), test.uniqueness(at),
         detectableSize(screening.candidates, leastOf, i)});
  }
  return screening;
}

Needed neededFor(const Screening& screening, size_t candidate) {
  return {criticalScore(screening.chance, levelOf(screening, candidate)), screening.overdispersion,
          screening.first, !mayBeginLater(screening, candidate)};
}

std::vector<size_t> significant(const Screening& screening) {
  std::map<std::string, size_t> clearest;
  for (size_t i = 0; i < screening.candidates.size(); ++i) {
    if (screening.evidence[i] < 1.0) continue;
    const auto known = clearest.emplace(screening.candidates[i].effect, i).first;
    if (screening.promise[i] > screening.promise[known->second]) known->second = i;
  }
  std::vector<size_t> found;
  for (const auto& [effect, index] : clearest) found.push_back(index);
  std::stable_sort(found.begin(), found.end(), [&screening](size_t a, size_t b) {
    return screening.promise[a] > screening.promise[b];
  });
  return found;
}

double pValueOf(const Screening& screening, double score, double evidence) {
  const double by_blocks = familyWise(screening.chance, score);
  return by_blocks <= screening.alpha
             ? by_blocks
             : std::min(by_blocks,
                        chanceOfSize(evidence, screening.candidates.size(), screening.first));
}

}  // namespace tread::gap
