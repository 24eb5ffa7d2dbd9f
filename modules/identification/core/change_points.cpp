// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/change_points.hpp"

#include <algorithm>

namespace tread::gap {
namespace {

constexpr double kFirstStep = 16.0;  // [s]
constexpr double kLastStep = 0.25;   // [s]
constexpr double kFarthest = 120.0;  // [s] that an interval is looked for to either side

double lossAt(const Fitter& fitter, const FitState& state, const std::string& path, double time,
              const std::vector<char>& mask) {
  ModelDocument model = state.model;
  *findParameter(model, path) = time;
  const Observations& data = fitter.data();
  return totalLoss(data.residuals(data.predict(model)), state.scales, mask);
}

}  // namespace

bool hasChanged(const Effect& effect, const ChangePoint& change, const ModelDocument& model) {
  return std::any_of(change.strengths.begin(), change.strengths.end(),
                     [&](const std::string& strength) {
                       return *findParameter(model, effect.name + "." + strength) != 0.0;
                     });
}

std::vector<std::string> changePointsOn(const ModelDocument& model) {
  std::vector<std::string> paths;
  for (const Effect& effect : effectCatalogue())
    for (const ChangePoint& change : effect.search.change_points)
      if (hasChanged(effect, change, model)) paths.push_back(effect.name + "." + change.time);
  return paths;
}

void refineChangePoint(const Fitter& fitter, FitState& state, const std::string& path,
                       const std::vector<char>& mask) {
  double& time = *findParameter(state.model, path);
  double least = lossAt(fitter, state, path, time, mask);
  for (double step = kFirstStep; step >= kLastStep;) {
    const double later = lossAt(fitter, state, path, time + step, mask);
    const double earlier = time > step ? lossAt(fitter, state, path, time - step, mask) : least;
    if (std::min(later, earlier) >= least) {
      step /= 2.0;
      continue;
    }
    time += later < earlier ? step : -step;
    least = std::min(later, earlier);
  }
  state.predicted = fitter.data().predict(state.model);
  fitter.renewJacobian(state);
}

std::pair<double, double> changePointInterval(const Fitter& fitter, const FitState& state,
                                              const std::string& path,
                                              const std::vector<char>& mask, double allowed) {
  const double time = *findParameter(state.model, path);
  const double least = lossAt(fitter, state, path, time, mask);
  const auto reach = [&](double direction) {
    double inside = 0.0;
    double outside = 0.5;
    while (outside < kFarthest &&
           lossAt(fitter, state, path, time + direction * outside, mask) < least + allowed) {
      inside = outside;
      outside *= 2.0;
    }
    for (int i = 0; i < 4; ++i) {
      const double middle = (inside + outside) / 2.0;
      const bool within =
          lossAt(fitter, state, path, time + direction * middle, mask) < least + allowed;
      (within ? inside : outside) = middle;
    }
    return outside;
  };
  return {std::max(0.0, time - reach(-1.0)), time + reach(1.0)};
}

}  // namespace tread::gap
