// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/moments.hpp"

#include <algorithm>

namespace tread::gap {
namespace {

constexpr double kFirstStep = 16.0;  // [s]
constexpr double kLastStep = 0.25;   // [s]
constexpr double kFarthest = 120.0;  // [s] that an interval is looked for to either side

double lossAt(const Fitter& fitter, const FitState& state, const std::string& path, double moment,
              const std::vector<char>& mask) {
  ModelDocument model = state.model;
  *findParameter(model, path) = moment;
  const Rows& rows = fitter.rows();
  return totalLoss(rows.residuals(rows.predict(model)), state.scales, mask);
}

}  // namespace

void refineMoment(const Fitter& fitter, FitState& state, const std::string& path,
                  const std::vector<char>& mask) {
  double& moment = *findParameter(state.model, path);
  double least = lossAt(fitter, state, path, moment, mask);
  for (double step = kFirstStep; step >= kLastStep;) {
    const double later = lossAt(fitter, state, path, moment + step, mask);
    const double earlier = moment > step ? lossAt(fitter, state, path, moment - step, mask) : least;
    if (std::min(later, earlier) >= least) {
      step /= 2.0;
      continue;
    }
    moment += later < earlier ? step : -step;
    least = std::min(later, earlier);
  }
  state.predicted = fitter.rows().predict(state.model);
  fitter.renewJacobian(state);
}

std::pair<double, double> momentInterval(const Fitter& fitter, const FitState& state,
                                         const std::string& path, const std::vector<char>& mask,
                                         double allowed) {
  const double moment = *findParameter(state.model, path);
  const double least = lossAt(fitter, state, path, moment, mask);
  const auto reach = [&](double direction) {
    double inside = 0.0;
    double outside = 0.5;
    while (outside < kFarthest &&
           lossAt(fitter, state, path, moment + direction * outside, mask) < least + allowed) {
      inside = outside;
      outside *= 2.0;
    }
    for (int i = 0; i < 4; ++i) {
      const double middle = (inside + outside) / 2.0;
      const bool within =
          lossAt(fitter, state, path, moment + direction * middle, mask) < least + allowed;
      (within ? inside : outside) = middle;
    }
    return outside;
  };
  return {std::max(0.0, moment - reach(-1.0)), moment + reach(1.0)};
}

}  // namespace tread::gap
