// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "modules/identification/core/pruning.hpp"

#include <algorithm>
#include <cmath>

#include "modules/identification/core/end_errors.hpp"

namespace tread::gap {
namespace {

constexpr double kSure = 4.0;        // standard errors of a gain that is certain
constexpr double kSureOfFew = 2.5;   // the same if few blocks act, whose agreement is limited
constexpr double kNearly = 0.8;      // evidence that suffices for an effect that has passed once
constexpr double kNearlySure = 2.0;  // required gain in standard errors in that case
constexpr double kNearlyNats = 50.0;
constexpr double kSureNats = 100.0;  // and its minimum: smaller gains may be negligible
constexpr double kLongLag = 0.1;     // [s]

/// The cost of removing an effect.
struct Removal {
  FitState state;         ///< without it
  double score = 0.0;     ///< T of the whole effect in the presence of the others
  double evidence = 0.0;  ///< over what is needed
  bool few = false;       ///< few blocks excite it
  Gain gain;              ///< of having it, on held-out blocks
};

/// One model with an effect from another model.
ModelDocument withEffectOf(const ModelDocument& model, const ModelDocument& source,
                           const std::string& effect) {
  ModelDocument changed = model;
  for (const EffectParameter& parameter : effectNamed(effect).parameters) {
    const std::string path = effect + "." + parameter.name;
    *findParameter(changed, path) = *findParameter(source, path);
  }
  return changed;
}

/// The cost of the effect, given a state without it and the direction that restores it.
Removal judged(const Fitter& fitter, const Eigen::VectorXd& loss_with, FitState reduced,
               const Eigen::VectorXd& direction, const Needed& needed) {
  Removal removed;
  const ScoreTest test(fitter, reduced, direction);
  removed.score = test.score(0);
  removed.evidence = evidence(test, 0, needed);
  removed.few = isSparse(test, 0, needed.score);
  removed.gain = gainOf(fitter, heldOutLoss(fitter, reduced), loss_with);
  removed.state = std::move(reduced);
  return removed;
}

Removal removal(const Fitter& fitter, const FitState& state, const Eigen::VectorXd& loss_with,
                const std::string& effect, const Needed& needed) {
  FitState reduced = without(fitter, state, effect);
  const Eigen::VectorXd direction =
      fitter.secant(reduced, withEffectOf(reduced.model, state.model, effect), 1.0);
  return judged(fitter, loss_with, std::move(reduced), direction, needed);
}

/// The same in first order, without a simulation; the state's model is not changed.
Removal linearRemoval(const Fitter& fitter, const FitState& state, const Eigen::VectorXd& loss_with,
                      const std::string& effect, const Needed& needed) {
  FitState reduced = withoutLinearly(fitter, state, effect);
  const Eigen::VectorXd direction = state.predicted - reduced.predicted;
  followLinearly(fitter, reduced);
  return judged(fitter, loss_with, std::move(reduced), direction, needed);
}

/// A model's errors on the fitter's blocks: sums, for comparisons.
struct Missed {
  double position = 0.0;  ///< at the ends of executions
  double yaw = 0.0;
  double yaw_rate = 0.0;
};

Missed missedBy(const Fitter& fitter, const FitState& state) {
  const std::vector<char> blocks = fitter.blocksThatCount();
  Missed missed;
  for (const ExecutionError& error : endErrors(fitter.data(), state.model)) {
    if (blocks[static_cast<size_t>(error.block)] == 0) continue;
    missed.position += error.position;
    missed.yaw += error.yaw;
  }
  const Eigen::VectorXd residuals = fitter.data().residuals(state.predicted);
  for (size_t i = 0; i < fitter.mask().size(); ++i)
    if (fitter.mask()[i] && fitter.data().all()[i].channel == ObservedRate::kYawRate)
      missed.yaw_rate += std::abs(residuals[static_cast<Eigen::Index>(i)]);
  return missed;
}

/// Relative improvement of the mean end error, of position or yaw, whichever is larger; for an
/// effect of the INS, which may not change any pose, also of the yaw rate.
double improvement(const Fitter& fitter, const FitState& old_state, const FitState& new_state,
                   const std::string& effect) {
  const Missed before = missedBy(fitter, old_state);
  const Missed after = missedBy(fitter, new_state);
  double largest = 0.0;
  if (before.position > 0.0) largest = std::max(largest, 1.0 - after.position / before.position);
  if (before.yaw > 0.0) largest = std::max(largest, 1.0 - after.yaw / before.yaw);
  if (effectNamed(effect).kind() == EffectKind::kMeasurement && before.yaw_rate > 0.0)
    largest = std::max(largest, 1.0 - after.yaw_rate / before.yaw_rate);
  return largest;
}

/// Effects by the certainty of their strongest parameter, least certain first.
std::vector<std::string> leastSureFirst(const Fitter& fitter, const FoundTerms& result) {
  const Eigen::MatrixXd covariance = parameterCovariance(fitter, result.state);
  std::map<std::string, double> sure;
  for (size_t i = 0; i < result.state.free.size(); ++i)
    for (const std::string& effect : result.effects) {
      const FreeParameter& parameter = result.state.free[i];
      if (effectOf(parameter.path) != effect) continue;
      const auto at = static_cast<Eigen::Index>(i);
      const double value = *findParameter(result.state.model, parameter.path);
      if (!isTime(parameter))
        sure[effect] = std::max(sure[effect], std::abs(value) / std::sqrt(covariance(at, at)));
    }
  std::vector<std::string> order = result.effects;
  std::stable_sort(order.begin(), order.end(),
                   [&sure](const auto& a, const auto& b) { return sure[a] < sure[b]; });
  return order;
}

bool isBeyondDoubt(const Removal& removed) {
  const double sure = removed.few ? kSureOfFew : kSure;
  return removed.gain.value > sure * removed.gain.error && removed.gain.value > kSureNats;
}

/// Whether an effect's prediction is linear down to its absence: not for limits, thresholds,
/// shapes.
bool isStraight(const FitState& state, const std::string& effect) {
  for (const FreeParameter& parameter : state.free) {
    if (effectOf(parameter.path) != effect) continue;
    const EffectParameter& known =
        parameterNamed(effectNamed(effect), parameter.path.substr(effect.size() + 1));
    if (known.reciprocal() || !known.probes.empty() || known.role == ParameterRole::kShape)
      return false;
  }
  return true;
}

bool isAtBound(const FitState& state, const std::string& effect) {
  return std::any_of(state.free.begin(), state.free.end(), [&](const FreeParameter& parameter) {
    return effectOf(parameter.path) == effect && runsToBound(state.model, parameter);
  });
}

/// Whether a test has named it, so that it is not only a nuisance term.
bool wasNamed(const FoundTerms& result, const std::string& effect) {
  const auto known = result.evidence.find(effect);
  return known != result.evidence.end() && known->second.p_value;
}

/// An effect that has passed the test once needs slightly less evidence to stay; so does one that
/// the wheels show and that replaces such an effect.
bool isNearly(const FoundTerms& result, const std::string& effect, const Removal& removed) {
  const auto known = result.evidence.find(effect);
  if (known != result.evidence.end() && known->second.by_wheels)
    return removed.gain.value > kNearlySure * removed.gain.error;
  return wasNamed(result, effect) && removed.evidence >= kNearly &&
         removed.gain.value > kNearlySure * removed.gain.error && removed.gain.value > kNearlyNats;
}

/// Whether an effect is one of the lags between a command and the INS's measurement, in addition to
/// a long one.
/** Without it the long one would absorb its delay, and reach an implausible size. */
bool isBesideLag(const FoundTerms& result, const std::string& effect) {
  if (!isLag(effectNamed(effect))) return false;
  return std::any_of(result.effects.begin(), result.effects.end(), [&](const std::string& other) {
    if (other == effect || !isLag(effectNamed(other))) return false;
    return std::abs(*findParameter(result.state.model, primaryPath(effectNamed(other)))) > kLongLag;
  });
}

/// The reason for removing an effect; empty if it should stay.
struct Against {
  std::string words;
  bool negligible = false;  ///< it is real, but negligible
};

Against reasonAgainst(const SearchState& search, const std::string& effect,
                      const Removal& removed) {
  // Residuals far beyond the scales do not pull more: a large effect shows in its gain.
  if (removed.evidence < 1.0 && !isBeyondDoubt(removed) &&
      !isNearly(search.result, effect, removed))
    return {"chance explains it in the presence of the others", false};
  if (removed.gain.value <= 0.0) return {"does not help on blocks left out", false};
  const double least = isBesideLag(search.result, effect) ? 0.0 : search.settings.least_gain;
  if (least > 0.0 && improvement(search.fitter, removed.state, search.result.state, effect) < least)
    return {"real, but negligible: changes the end error by less than 1 %", true};
  return {};
}

void remove(const SearchState& search, const std::string effect, Removal& removed,
            const Against& why) {
  SearchRecord& record = search.result.record;
  // Pure nuisance terms are removed without a report.
  const bool was_added = wasNamed(search.result, effect);
  if (why.negligible) record.negligible.push_back(effect);
  if (was_added) {
    record.steps.push_back(
        {effect, true, removed.score, 1.0, removed.gain.value, removed.gain.error, {}, why.words});
    search.say("  - " + effect + ": " + why.words);
  }
  search.result.state = std::move(removed.state);
  auto& effects = search.result.effects;
  effects.erase(std::find(effects.begin(), effects.end(), effect));
}

/// Last, because a superfluous effect may have pushed another one to its bound.
bool removeAtBound(const SearchState& search, const Needed& needed, const Eigen::VectorXd& loss) {
  for (const std::string& effect : search.result.effects) {
    if (search.isAccepted(effect) || !isAtBound(search.result.state, effect)) continue;
    Removal removed = removal(search.fitter, search.result.state, loss, effect, needed);
    search.result.record.at_bound.push_back(effect);
    remove(search, effect, removed, {"runs to the end of its plausible range", false});
    return true;
  }
  return false;
}

/// Considers all, least certain first; true if one was removed.
bool removeOne(const SearchState& search, const Needed& needed_of_all) {
  const Fitter& fitter = search.fitter;
  FoundTerms& result = search.result;
  const Eigen::VectorXd loss = heldOutLoss(fitter, result.state);
  for (const std::string& effect : leastSureFirst(fitter, result)) {
    // An effect that is certain in first order needs no simulation without it.
    Needed needed = needed_of_all;
    needed.size_counts = effectNamed(effect).search.change_points.empty();
    const bool straight = isStraight(result.state, effect);
    Removal removed;
    if (straight) removed = linearRemoval(fitter, result.state, loss, effect, needed);
    const bool sure = straight && removed.evidence >= 1.0 && isBeyondDoubt(removed);
    if (!sure) removed = removal(fitter, result.state, loss, effect, needed);
    const bool stays = sure || search.isAccepted(effect);
    const Against why = stays ? Against() : reasonAgainst(search, effect, removed);
    if (why.words.empty()) {
      EffectEvidence& known = result.evidence[effect];
      known.score = removed.score;
      known.evidence = removed.evidence;
      known.gain = removed.gain;
      continue;
    }
    remove(search, effect, removed, why);
    return true;
  }
  return removeAtBound(search, needed_of_all, loss);
}

}  // namespace

FitState switchedOff(const Fitter& fitter, const FitState& state,
                     const std::vector<std::string>& effects) {
  FitState reduced = state;
  for (const std::string& effect : effects) {
    for (size_t i = reduced.free.size(); i-- > 0;)
      if (effectOf(reduced.free[i].path) == effect) fitter.release(reduced, i);
    for (const EffectParameter& parameter : effectNamed(effect).parameters)
      if (parameter.role == ParameterRole::kStrength)
        *findParameter(reduced.model, effect + "." + parameter.name) = 0.0;
  }
  reduced.predicted = fitter.predict(reduced.model);
  return reduced;
}

FitState without(const Fitter& fitter, const FitState& state, const std::string& effect) {
  FitState reduced = switchedOff(fitter, state, {effect});
  fitter.fitRoughly(reduced);
  return reduced;
}

FitState withoutLinearly(const Fitter& fitter, const FitState& state, const std::string& effect) {
  FitState reduced = state;
  for (size_t i = reduced.free.size(); i-- > 0;) {
    if (effectOf(reduced.free[i].path) != effect) continue;
    const auto at = static_cast<Eigen::Index>(i);
    reduced.predicted -= state.jacobian.col(at) * *findParameter(state.model, state.free[i].path);
    fitter.release(reduced, i);
  }
  return reduced;
}

void pruneEffects(const SearchState& search, const Needed& needed) {
  while (removeOne(search, needed)) continue;  // at most as often as there are effects
}

}  // namespace tread::gap
