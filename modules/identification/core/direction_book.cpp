// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/direction_book.hpp"

#include <stdexcept>

namespace tread::gap {
namespace {

bool isSame(double a, double b) {
  return a == b || (a != a && b != b);
}

bool isSame(const Candidate& a, const Candidate& b) {
  return a.effect == b.effect && a.parameter == b.parameter && a.change == b.change &&
         isSame(a.since, b.since) && a.shapes == b.shapes;
}

/// Of a term that is fitted: its column of the Jacobian.
Eigen::VectorXd releaseDirection(const FitState& state, const Candidate& candidate) {
  const std::string path = candidate.effect + "." + candidate.parameter;
  for (size_t i = 0; i < state.free.size(); ++i)
    if (state.free[i].path == path) return state.jacobian.col(static_cast<Eigen::Index>(i));
  throw std::logic_error("a release of " + path + ", which is not free");
}

}  // namespace

const Excitation& DirectionBook::excitation(const Fitter& fitter, const FitState& state) {
  if (!measured_) excitation_ = excitationOf(fitter.rows(), state.model);
  measured_ = true;
  return excitation_;
}

DirectionBook::Page* DirectionBook::pageOf(const Candidate& candidate) {
  for (Page& page : pages_)
    if (isSame(page.candidate, candidate)) return &page;
  return nullptr;
}

Eigen::MatrixXd DirectionBook::directions(const Fitter& fitter, const FitState& state,
                                          const std::vector<Candidate>& candidates) {
  std::vector<Candidate> missing;
  for (const Candidate& candidate : candidates)
    if (!candidate.release && pageOf(candidate) == nullptr) missing.push_back(candidate);
  renew(fitter, state, missing);
  Eigen::MatrixXd all(state.predicted.size(), static_cast<Eigen::Index>(candidates.size()));
  for (size_t i = 0; i < candidates.size(); ++i)
    all.col(static_cast<Eigen::Index>(i)) = candidates[i].release
                                                ? releaseDirection(state, candidates[i])
                                                : pageOf(candidates[i])->direction;
  return all;
}

void DirectionBook::renew(const Fitter& fitter, const FitState& state,
                          const std::vector<Candidate>& candidates) {
  if (candidates.empty()) return;
  const Eigen::MatrixXd directions = directionsOf(fitter, state, candidates);
  for (size_t i = 0; i < candidates.size(); ++i) {
    const Eigen::VectorXd direction = directions.col(static_cast<Eigen::Index>(i));
    if (Page* known = pageOf(candidates[i]))
      known->direction = direction;
    else
      pages_.push_back({candidates[i], direction});
  }
}

}  // namespace tread::gap
