// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/search.hpp"

#include <algorithm>
#include <cmath>

#include "modules/identification/core/end_errors.hpp"

namespace tread::gap {
namespace {

constexpr double kSure = 4.0;        // standard errors of a gain beyond doubt
constexpr double kSureOfFew = 2.5;   // the same where few blocks act, which cannot agree better
constexpr double kNearly = 0.8;      // evidence with which what has passed once stays
constexpr double kNearlySure = 2.0;  // if it gains so many standard errors
constexpr double kNearlyNats = 50.0;
constexpr double kSureNats = 100.0;  // and its least size: smaller ones may be negligible
constexpr double kLongLag = 0.1;     // [s]

/// What removing an effect costs.
struct Removal {
  FitState state;         ///< without it
  double score = 0.0;     ///< T of the whole effect in the presence of the others
  double evidence = 0.0;  ///< over what is needed
  bool few = false;       ///< few blocks excite it
  Gain gain;              ///< of having it, on blocks left out
};

/// The effect of one model put into another.
ModelDocument withEffectOf(const ModelDocument& model, const ModelDocument& source,
                           const std::string& effect) {
  ModelDocument changed = model;
  for (const EffectParameter& parameter : effectNamed(effect).parameters) {
    const std::string path = effect + "." + parameter.name;
    *findParameter(changed, path) = *findParameter(source, path);
  }
  return changed;
}

/// What the effect costs, given a state without it and the direction that leads back.
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

/// The same in first order, without a simulation; the model of the state stays as it was.
Removal linearRemoval(const Fitter& fitter, const FitState& state, const Eigen::VectorXd& loss_with,
                      const std::string& effect, const Needed& needed) {
  FitState reduced = withoutLinearly(fitter, state, effect);
  const Eigen::VectorXd direction = state.predicted - reduced.predicted;
  followLinearly(fitter, reduced);
  return judged(fitter, loss_with, std::move(reduced), direction, needed);
}

/// What a model misses on the fitter's blocks: sums, for comparisons.
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

/// Relative improvement of the mean end error, of position or yaw, whichever is larger; of an
/// effect of the INS, which may move no pose, also of the yaw rate.
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

/// Effects by how sure their strongest parameter is, least sure first.
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

/// Whether an effect's prediction is straight down to its absence: not limits, thresholds, shapes.
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

/// Whether a test has named it: it is no mere nuisance term.
bool wasNamed(const FoundTerms& result, const std::string& effect) {
  const auto known = result.evidence.find(effect);
  return known != result.evidence.end() && known->second.p_value;
}

/// What has passed the test once stays with a little less evidence; so does what the wheels show,
/// in the place of an effect that has passed it.
bool isNearly(const FoundTerms& result, const std::string& effect, const Removal& removed) {
  const auto known = result.evidence.find(effect);
  if (known != result.evidence.end() && known->second.by_wheels)
    return removed.gain.value > kNearlySure * removed.gain.error;
  return wasNamed(result, effect) && removed.evidence >= kNearly &&
         removed.gain.value > kNearlySure * removed.gain.error && removed.gain.value > kNearlyNats;
}

/// Whether an effect is one of the lags between a command and what the INS says, beside a long one.
/** Without it the long one would take its time over, and with it a size that nobody believes. */
bool isBesideLag(const FoundTerms& result, const std::string& effect) {
  if (!isLag(effectNamed(effect))) return false;
  return std::any_of(result.effects.begin(), result.effects.end(), [&](const std::string& other) {
    if (other == effect || !isLag(effectNamed(other))) return false;
    return std::abs(*findParameter(result.state.model, primaryPath(effectNamed(other)))) > kLongLag;
  });
}

/// Why an effect should go; no words if it should stay.
struct Against {
  std::string words;
  bool negligible = false;  ///< it is real, but too small to count
};

Against reasonAgainst(const SearchState& search, const std::string& effect,
                      const Removal& removed) {
  // Residuals far beyond the scales pull no more: a large effect shows in its gain.
  if (removed.evidence < 1.0 && !isBeyondDoubt(removed) &&
      !isNearly(search.result, effect, removed))
    return {"chance explains it beside the others", false};
  if (removed.gain.value <= 0.0) return {"does not help on blocks left out", false};
  const double least = isBesideLag(search.result, effect) ? 0.0 : search.settings.least_gain;
  if (least > 0.0 && improvement(search.fitter, removed.state, search.result.state, effect) < least)
    return {"real, but negligible: changes the end error by less than 1 %", true};
  return {};
}

void remove(const SearchState& search, const std::string effect, Removal& removed,
            const Against& why) {
  SearchRecord& record = search.result.record;
  // Mere nuisance terms go without a word.
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

/// Comes last: a superfluous effect may have pushed another one to its bound.
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

/// Looks at all, least sure first; true if one went.
bool removeOne(const SearchState& search, const Needed& needed_of_all) {
  const Fitter& fitter = search.fitter;
  FoundTerms& result = search.result;
  const Eigen::VectorXd loss = heldOutLoss(fitter, result.state);
  for (const std::string& effect : leastSureFirst(fitter, result)) {
    // What is beyond doubt in first order needs no simulation without it.
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
  while (removeOne(search, needed)) continue;  // no more often than there are effects
}

}  // namespace tread::gap
