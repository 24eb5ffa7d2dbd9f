// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/search_steps.hpp"

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

/// What removing an effect costs.
struct Removal {
  FitState state;         ///< without it
  double score = 0.0;     ///< T of the whole effect in the presence of the others
  double evidence = 0.0;  ///< over what is needed
  bool few = false;       ///< few blocks excite it
  Gain gain;              ///< of having it, on blocks left out
};

bool belongsTo(const FreeParameter& parameter, const std::string& effect) {
  return parameter.path.compare(0, effect.size() + 1, effect + ".") == 0;
}

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
               const Eigen::VectorXd& direction, const std::vector<char>& mask,
               const Needed& needed) {
  Removal removed;
  const ScoreTest test(fitter.data(), reduced, direction, mask);
  removed.score = test.score(0);
  removed.evidence = evidence(test, 0, needed);
  removed.few = isSparse(test, 0, needed.score);
  removed.gain = gainOf(heldOutLoss(fitter.data(), reduced, mask), loss_with,
                        blocksThatCount(fitter.data(), mask));
  removed.state = std::move(reduced);
  return removed;
}

Removal removal(const Fitter& fitter, const FitState& state, const Eigen::VectorXd& loss_with,
                const std::string& effect, const std::vector<char>& mask, const Needed& needed) {
  FitState reduced = without(fitter, state, effect, mask);
  const Eigen::VectorXd direction =
      fitter.secant(reduced, withEffectOf(reduced.model, state.model, effect), 1.0);
  return judged(fitter, loss_with, std::move(reduced), direction, mask, needed);
}

/// The same in first order, without a simulation; the model of the state stays as it was.
Removal linearRemoval(const Fitter& fitter, const FitState& state, const Eigen::VectorXd& loss_with,
                      const std::string& effect, const std::vector<char>& mask,
                      const Needed& needed) {
  FitState reduced = withoutLinearly(fitter, state, effect);
  const Eigen::VectorXd direction = state.predicted - reduced.predicted;
  followLinearly(fitter, reduced, mask);
  return judged(fitter, loss_with, std::move(reduced), direction, mask, needed);
}

/// What a model misses on the mask's blocks: sums, for comparisons.
struct Missed {
  double position = 0.0;  ///< at the ends of executions
  double yaw = 0.0;
  double yaw_rate = 0.0;
};

Missed missedBy(const Fitter& fitter, const FitState& state, const std::vector<char>& mask) {
  const std::vector<char> blocks = blocksThatCount(fitter.data(), mask);
  Missed missed;
  for (const ExecutionError& error : endErrors(fitter.data(), state.model)) {
    if (blocks[static_cast<size_t>(error.block)] == 0) continue;
    missed.position += error.position;
    missed.yaw += error.yaw;
  }
  const Eigen::VectorXd residuals = fitter.data().residuals(state.predicted);
  for (size_t i = 0; i < mask.size(); ++i)
    if (mask[i] && fitter.data().all()[i].channel == Channel::kYawRate)
      missed.yaw_rate += std::abs(residuals[static_cast<Eigen::Index>(i)]);
  return missed;
}

/// Relative improvement of the mean end error, of position or yaw, whichever is larger; of an
/// effect of the INS, which may move no pose, also of the yaw rate.
double improvement(const Fitter& fitter, const FitState& old_state, const FitState& new_state,
                   const std::string& effect, const std::vector<char>& mask) {
  const Missed before = missedBy(fitter, old_state, mask);
  const Missed after = missedBy(fitter, new_state, mask);
  double largest = 0.0;
  if (before.position > 0.0) largest = std::max(largest, 1.0 - after.position / before.position);
  if (before.yaw > 0.0) largest = std::max(largest, 1.0 - after.yaw / before.yaw);
  if (effectNamed(effect).kind() == EffectKind::kMeasurement && before.yaw_rate > 0.0)
    largest = std::max(largest, 1.0 - after.yaw_rate / before.yaw_rate);
  return largest;
}

/// Effects by how sure their strongest parameter is, least sure first.
std::vector<std::string> leastSureFirst(const Fitter& fitter, const SearchResult& result,
                                        const std::vector<char>& mask) {
  const Eigen::MatrixXd covariance = parameterCovariance(fitter.data(), result.state, mask);
  std::map<std::string, double> sure;
  for (size_t i = 0; i < result.state.free.size(); ++i)
    for (const std::string& effect : result.effects) {
      const FreeParameter& parameter = result.state.free[i];
      if (!belongsTo(parameter, effect)) continue;
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
    if (!belongsTo(parameter, effect)) continue;
    const EffectParameter& known =
        parameterNamed(effectNamed(effect), parameter.path.substr(effect.size() + 1));
    if (known.reciprocal() || !known.probes.empty() || known.role == ParameterRole::kShape)
      return false;
  }
  return true;
}

class Pruning {
 public:
  Pruning(const Fitter& fitter, const std::vector<char>& mask, const SearchSettings& settings,
          const Needed& needed, SearchResult& result, const Progress& say)
      : fitter_(fitter),
        mask_(mask),
        settings_(settings),
        needed_(needed),
        result_(result),
        say_(say) {}

  void run() {
    while (removeOne()) continue;
  }

 private:
  /// Looks at all, least sure first; true if one went.
  bool removeOne() {
    const Eigen::VectorXd loss = heldOutLoss(fitter_.data(), result_.state, mask_);
    for (const std::string& effect : leastSureFirst(fitter_, result_, mask_)) {
      // What is beyond doubt in first order needs no simulation without it.
      Needed needed = needed_;
      needed.size_counts = effectNamed(effect).search.change_points.empty();
      const bool straight = isStraight(result_.state, effect);
      Removal removed;
      if (straight) removed = linearRemoval(fitter_, result_.state, loss, effect, mask_, needed);
      const bool sure = straight && removed.evidence >= 1.0 && isBeyondDoubt(removed);
      if (!sure) removed = removal(fitter_, result_.state, loss, effect, mask_, needed);
      const bool stays = sure || contains(settings_.accepted, effect);
      const std::string why = stays ? "" : reasonAgainst(effect, removed);
      if (why.empty()) {
        EffectEvidence& known = result_.evidence[effect];
        known.score = removed.score;
        known.evidence = removed.evidence;
        known.gain = removed.gain;
        continue;
      }
      remove(effect, removed, why);
      return true;
    }
    return removeAtBound(loss);
  }

  /// Comes last: a superfluous effect may have pushed another one to its bound.
  bool removeAtBound(const Eigen::VectorXd& loss) {
    for (const std::string& effect : result_.effects) {
      if (contains(settings_.accepted, effect) || !isAtBound(effect)) continue;
      Removal removed = removal(fitter_, result_.state, loss, effect, mask_, needed_);
      result_.record.at_bound.push_back(effect);
      remove(effect, removed, "runs to the end of its plausible range");
      return true;
    }
    return false;
  }

  bool isAtBound(const std::string& effect) const {
    return std::any_of(
        result_.state.free.begin(), result_.state.free.end(), [&](const FreeParameter& parameter) {
          return belongsTo(parameter, effect) && runsToBound(result_.state.model, parameter);
        });
  }

  /// Whether a test has named it: it is no mere nuisance term.
  bool wasNamed(const std::string& effect) const {
    const auto known = result_.evidence.find(effect);
    return known != result_.evidence.end() && known->second.p_value;
  }

  /// What has passed the test once stays with a little less evidence.
  bool isNearly(const std::string& effect, const Removal& removed) const {
    return wasNamed(effect) && removed.evidence >= kNearly &&
           removed.gain.value > kNearlySure * removed.gain.error &&
           removed.gain.value > kNearlyNats;
  }

  /// Why an effect should go; empty if it should stay.
  std::string reasonAgainst(const std::string& effect, const Removal& removed) const {
    // Residuals far beyond the scales pull no more: a large effect shows in its gain.
    if (removed.evidence < 1.0 && !isBeyondDoubt(removed) && !isNearly(effect, removed))
      return "chance explains it beside the others";
    if (removed.gain.value <= 0.0) return "does not help on blocks left out";
    if (settings_.least_gain > 0.0 &&
        improvement(fitter_, removed.state, result_.state, effect, mask_) < settings_.least_gain)
      return "real, but negligible: changes the end error by less than 1 %";
    return "";
  }

  void remove(const std::string effect, Removal& removed, const std::string& why) {
    // Mere nuisance terms go without a word.
    const bool was_added = wasNamed(effect);
    if (why.compare(0, 4, "real") == 0) result_.record.negligible.push_back(effect);
    if (was_added) {
      SearchStep step;
      step.effect = effect;
      step.removed = true;
      step.score = removed.score;
      step.gain = removed.gain.value;
      step.gain_error = removed.gain.error;
      step.remark = why;
      result_.record.steps.push_back(step);
      say_("  - " + effect + ": " + why);
    }
    result_.state = std::move(removed.state);
    result_.effects.erase(std::find(result_.effects.begin(), result_.effects.end(), effect));
  }

  const Fitter& fitter_;
  const std::vector<char>& mask_;
  const SearchSettings& settings_;
  const Needed needed_;
  SearchResult& result_;
  const Progress& say_;
};

}  // namespace

FitState switchedOff(const Fitter& fitter, const FitState& state,
                     const std::vector<std::string>& effects) {
  FitState reduced = state;
  for (const std::string& effect : effects) {
    for (size_t i = reduced.free.size(); i-- > 0;)
      if (belongsTo(reduced.free[i], effect)) fitter.release(reduced, i);
    for (const EffectParameter& parameter : effectNamed(effect).parameters)
      if (parameter.role == ParameterRole::kStrength)
        *findParameter(reduced.model, effect + "." + parameter.name) = 0.0;
  }
  reduced.predicted = fitter.data().predict(reduced.model);
  return reduced;
}

FitState without(const Fitter& fitter, const FitState& state, const std::string& effect,
                 const std::vector<char>& mask) {
  FitState reduced = switchedOff(fitter, state, {effect});
  fitter.fitRoughly(reduced, mask);
  return reduced;
}

FitState withoutLinearly(const Fitter& fitter, const FitState& state, const std::string& effect) {
  FitState reduced = state;
  for (size_t i = reduced.free.size(); i-- > 0;) {
    if (!belongsTo(reduced.free[i], effect)) continue;
    const auto at = static_cast<Eigen::Index>(i);
    reduced.predicted -= state.jacobian.col(at) * *findParameter(state.model, state.free[i].path);
    fitter.release(reduced, i);
  }
  return reduced;
}

void pruneEffects(const Fitter& fitter, const std::vector<char>& mask,
                  const SearchSettings& settings, const Needed& needed, SearchResult& result,
                  const Progress& say) {
  Pruning(fitter, mask, settings, needed, result, say).run();
}

}  // namespace tread::gap
