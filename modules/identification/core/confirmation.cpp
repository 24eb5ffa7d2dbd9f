// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/confirmation.hpp"

#include <algorithm>
#include <cmath>

#include "modules/identification/core/end_errors.hpp"
#include "modules/identification/core/search_steps.hpp"

namespace tread::gap {
namespace {

/// Adds what a state misses on every other block: position, yaw and yaw rate (blocks x 3).
void addMissed(const Observations& data, const FitState& state, int half, Eigen::MatrixXd& sums) {
  for (const ExecutionError& error : endErrors(data, state.model))
    if (error.block % 2 == half)
      sums.row(error.block).head(2) += Eigen::RowVector2d(error.position, error.yaw);
  const Eigen::VectorXd residuals = data.residuals(state.predicted);
  for (size_t i = 0; i < data.all().size(); ++i) {
    const Observation& row = data.all()[i];
    if (row.channel == Channel::kYawRate && row.block % 2 == half)
      sums(row.block, 2) += std::abs(residuals[static_cast<Eigen::Index>(i)]);
  }
}

/// The result with its given, released and accepted terms alone.
FitState withoutFound(const Fitter& fitter, const std::vector<char>& mask,
                      const SearchSettings& settings, const SearchResult& result) {
  if (result.released.empty()) return result.calibrated;
  std::vector<std::string> found;
  for (const std::string& effect : result.effects)
    if (!contains(settings.accepted, effect)) found.push_back(effect);
  FitState state = switchedOff(fitter, result.state, found);
  fitter.fit(state, mask);
  return state;
}

bool isConfirmed(const Fitter& fitter, const SearchResult& result, const FitState& lacking) {
  const Observations& data = fitter.data();
  Eigen::MatrixXd with = Eigen::MatrixXd::Zero(data.blocks(), 3);
  Eigen::MatrixXd without = with;
  for (int half : {0, 1}) {
    addMissed(data, refitted(fitter, result, halfMask(data, half)), 1 - half, with);
    addMissed(data, lacking, half, without);
  }
  const bool measurement =
      std::all_of(result.effects.begin(), result.effects.end(), [](const std::string& effect) {
        return effectNamed(effect).kind() == EffectKind::kMeasurement;
      });
  const std::vector<char> every(static_cast<size_t>(data.blocks()), 1);
  for (Eigen::Index i = 0; i < (measurement ? 3 : 2); ++i) {
    const Gain gain = gainOf(without.col(i), with.col(i), every);
    if (gain.value > gain.error) return true;
  }
  return false;
}

}  // namespace

std::vector<char> halfMask(const Observations& data, int half) {
  std::vector<char> mask;
  for (const Observation& row : data.all()) mask.push_back(row.block % 2 == half);
  return mask;
}

void dropUnconfirmed(const Fitter& fitter, const std::vector<char>& mask,
                     const SearchSettings& settings, SearchResult& result, const Progress& say) {
  if (result.effects.empty()) return;
  FitState lacking = withoutFound(fitter, mask, settings, result);
  if (isConfirmed(fitter, result, lacking)) return;
  std::vector<std::string> kept;
  for (const std::string& effect : result.effects) {
    if (contains(settings.accepted, effect)) {
      kept.push_back(effect);
      continue;
    }
    say("  - " + effect + ": does not lessen the end error on driving it was not fitted to");
    result.record.negligible.push_back(effect);
  }
  result.effects = kept;
  result.state = std::move(lacking);
}

}  // namespace tread::gap
