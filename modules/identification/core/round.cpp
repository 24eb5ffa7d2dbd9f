// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/round.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "modules/identification/core/detectable.hpp"

namespace tread::gap {
namespace {

constexpr double kMomentAlpha = 0.01;    // of what may begin at any time
constexpr double kPowerQuantile = 0.84;  // normal: 80 % power

std::vector<size_t> bestOfEffects(const Round& round) {
  std::map<std::string, size_t> best;
  for (size_t i = 0; i < round.candidates.size(); ++i) {
    const auto known = best.emplace(round.candidates[i].effect, i).first;
    if (std::abs(round.scores[i]) > std::abs(round.scores[known->second])) known->second = i;
  }
  std::vector<size_t> order;
  for (const auto& [effect, index] : best) order.push_back(index);
  std::stable_sort(order.begin(), order.end(), [&round](size_t a, size_t b) {
    return std::abs(round.scores[a]) > std::abs(round.scores[b]);
  });
  return order;
}

/// Evidence for a candidate over what is needed; less than 1 if chance explains it.
double evidenceOf(const ScoreTest& test, Eigen::Index candidate, const Round& round, bool first) {
  // A change finds a few blocks of chance wherever they are: it has to show in many.
  const bool moment = !effectNamed(round.candidates[static_cast<size_t>(candidate)].effect)
                           .search.change_points.empty();
  const double level = moment ? std::min(round.alpha, kMomentAlpha) : round.alpha;
  const Needed needed{criticalScore(round.chance, level), round.overdispersion, first, !moment};
  const double found = evidence(test, candidate, needed);
  return familyWise(round.chance, test.score(candidate)) <= level ? std::max(1.0, found) : found;
}

}  // namespace

Round testedRound(const Fitter& fitter, const FitState& state, const std::vector<char>& mask,
                  const SearchSettings& settings, bool first, DirectionBook& book) {
  Round round;
  round.first = first;
  round.alpha = first ? settings.alpha : settings.alpha_more;
  round.candidates = candidatesFor(state, book.excitation(fitter, state));
  leaveOut(round.candidates, settings.rejected);
  const ScoreTest test(fitter.rows(), state, book.directions(fitter, state, round.candidates),
                       mask);
  round.chance = test.largestByChance(settings.draws, settings.seed);
  round.overdispersion = test.usualOverdispersion();
  for (size_t i = 0; i < round.candidates.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    round.scores.push_back(test.score(at));
    round.sizes.push_back(test.size(at));
    round.evidence.push_back(evidenceOf(test, at, round, first));
    round.promise.push_back(test.promise(at));
  }
  round.best = bestOfEffects(round);
  const double needed = criticalScore(round.chance, settings.alpha) + kPowerQuantile;
  for (size_t i : round.best) {
    if (round.candidates[i].release) continue;  // on, and fitted
    const auto at = static_cast<Eigen::Index>(i);
    round.tests.push_back({round.candidates[i].effect, round.candidates[i].parameter,
                           round.scores[i], familyWise(round.chance, round.scores[i]),
                           test.uniqueness(at), detectableSize(round.candidates, test, i, needed)});
  }
  return round;
}

std::vector<size_t> significant(const Round& round) {
  std::map<std::string, size_t> clearest;
  for (size_t i = 0; i < round.candidates.size(); ++i) {
    if (round.evidence[i] < 1.0) continue;
    const auto known = clearest.emplace(round.candidates[i].effect, i).first;
    if (round.promise[i] > round.promise[known->second]) known->second = i;
  }
  std::vector<size_t> found;
  for (const auto& [effect, index] : clearest) found.push_back(index);
  std::stable_sort(found.begin(), found.end(),
                   [&round](size_t a, size_t b) { return round.promise[a] > round.promise[b]; });
  return found;
}

double pValueOf(const Round& round, double score, double evidence) {
  const double by_blocks = familyWise(round.chance, score);
  return by_blocks <= round.alpha
             ? by_blocks
             : std::min(by_blocks, chanceOfSize(evidence, round.candidates.size(), round.first));
}

}  // namespace tread::gap
