// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/lag_structure.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "modules/identification/core/pruning.hpp"

namespace tread::gap {
namespace {

/// Names of the effects.
struct LagNames {
  const std::string drive = effectThatIsLate(LateBy::kDrive).name;
  const std::string yaw = effectThatIsLate(LateBy::kYawRate).name;
  const std::string body = effectThatIsLate(LateBy::kSpeed).name;

  std::vector<std::string> all() const { return {drive, yaw, body}; }
};

constexpr double kLeastLag = 0.03;     // [s] start value of a fit
constexpr double kLeastNats = 10.0;    // by which another structure must be better
constexpr double kLongModelLag = 0.1;  // [s] of a model's lag that may consist of two

std::string pathOf(const std::string& lag) {
  return primaryPath(effectNamed(lag));
}

using Lags = std::vector<std::pair<std::string, double>>;  // effect, [s] start value of the fit

/// A lag of the drive, combined with one of the yaw rate or of the speed, or only the latter two.
/** `v` and `omega`: total delays of both [s]. */
std::vector<Lags> structuresFor(const LagNames& names, double v, double omega) {
  // If both are equal, one of two starts with half of it, so that the fit distinguishes them.
  const bool alike = std::abs(v - omega) < kLeastLag;
  const double common = std::max(kLeastLag, (alike ? 0.5 : 1.0) * std::min(v, omega));
  const double rest = std::max(kLeastLag, alike ? 0.5 * v : std::abs(v - omega));
  return {{{names.drive, 0.5 * (v + omega)}},
          {{names.drive, common}, {names.yaw, rest}},
          {{names.drive, common}, {names.body, rest}},
          {{names.yaw, std::max(kLeastLag, omega)},
           {names.body, std::max(kLeastLag, (alike ? 0.5 : 1.0) * v)}}};
}

/// A fitted structure, and its gain over the result's structure on held-out blocks.
struct Trial {
  std::vector<std::string> effects;
  FitState state;
  Gain gain;
};

/// Whether the lag of the drive is a free number of the nominal model.
bool isNominalLagFree(const FitState& state) {
  return std::any_of(state.free.begin(), state.free.end(), [](const FreeParameter& parameter) {
    return parameter.path == "lag" && std::isinf(parameter.deviation);
  });
}

std::optional<Trial> tryOut(const SearchState& search, const Lags& lags,
                            const Eigen::VectorXd& loss_now) {
  const Fitter& fitter = search.fitter;
  const bool nominal = isNominalLagFree(search.result.state);
  const LagNames lag_names;
  Trial trial;
  trial.state = switchedOff(fitter, search.result.state, lag_names.all());
  if (nominal) *findParameter(trial.state.model, "lag") = kLeastLag;
  for (const auto& [effect, value] : lags) {
    if (nominal && effect == lag_names.drive)
      *findParameter(trial.state.model, "lag") = value;
    else
      trial.effects.push_back(effect);
  }
  trial.state.predicted = fitter.predict(trial.state.model);
  fitter.renewJacobian(trial.state);
  for (const auto& [effect, value] : lags) {
    if (!contains(trial.effects, effect)) continue;
    FreeParameter lag = freeParameter(trial.state.model, pathOf(effect));
    lag.expected = 0.0;
    fitter.add(trial.state, lag, value);
  }
  // Far from the start values: repeat with a Jacobian computed there.
  for (int round = 0; round < 2; ++round) {
    fitter.fitRoughly(trial.state);
    fitter.renewJacobian(trial.state);
  }
  for (const FreeParameter& parameter : trial.state.free)
    if (contains(trial.effects, effectOf(parameter.path)) && onBound(trial.state.model, parameter))
      return std::nullopt;
  trial.gain = gainOf(fitter, loss_now, heldOutLoss(fitter, trial.state));
  return trial;
}

}  // namespace

bool chooseLags(const SearchState& search) {
  FoundTerms& result = search.result;
  const bool nominal = isNominalLagFree(result.state);
  const LagNames lag_names;
  std::vector<std::string> now;
  for (const std::string& lag : lag_names.all()) {
    const bool found = contains(result.effects, lag);
    // Lags of the model and accepted lags are kept.
    if ((isOn(effectNamed(lag), result.state.model) && !found) || search.isAccepted(lag) ||
        contains(search.settings.rejected, lag))
      return false;
    // With a free lag of the model, the drive's lag effect would duplicate it.
    if (nominal && lag == lag_names.drive && found) return false;
    if (found) now.push_back(lag);
  }
  const auto lagOf = [&](const std::string& lag) {
    return *findParameter(result.state.model,
                          nominal && lag == lag_names.drive ? std::string("lag") : pathOf(lag));
  };
  const double drive = lagOf(lag_names.drive);
  if (now.empty() && !(nominal && drive > kLongModelLag)) return false;
  const Eigen::VectorXd loss_now = heldOutLoss(search.fitter, result.state);
  std::optional<Trial> best;
  double most = 0.0;
  for (const Lags& lags :
       structuresFor(lag_names, drive + lagOf(lag_names.body), drive + lagOf(lag_names.yaw))) {
    std::vector<std::string> names;
    for (const auto& [lag, value] : lags)
      if (!nominal || lag != lag_names.drive) names.push_back(lag);
    if (names == now || search.isCutShort()) continue;
    std::optional<Trial> trial = tryOut(search, lags, loss_now);
    if (!trial) continue;
    // One lag that replaces two need only be as good.
    const double needed = names.size() < now.size() ? -std::min(kLeastNats, trial->gain.error)
                                                    : std::max(kLeastNats, trial->gain.error);
    if (trial->gain.value < needed || (best && trial->gain.value - needed <= most)) continue;
    most = trial->gain.value - needed;
    best = std::move(trial);
  }
  if (!best) return false;
  std::string taken = nominal ? "the model's lag" : "";
  for (const std::string& lag : best->effects) taken += (taken.empty() ? "" : " and ") + lag;
  for (const std::string& lag : now) {
    if (contains(best->effects, lag)) continue;
    result.record.steps.push_back(
        {lag, true, 0.0, 1.0, 0.0, 0.0, {}, "in its place, the lags together: " + taken});
    search.say("  - " + lag + ": in its place, the lags together: " + taken);
  }
  for (const std::string& lag : now)
    result.effects.erase(std::find(result.effects.begin(), result.effects.end(), lag));
  for (const std::string& lag : best->effects) {
    result.effects.push_back(lag);
    // Chosen but not tested yet: pruning tests it, and reports it.
    if (!result.evidence[lag].p_value) result.evidence[lag].p_value = 1.0;
    if (contains(now, lag)) continue;
    const std::string remark = "the lags together: " + taken;
    result.record.steps.push_back(
        {lag, false, 0.0, 1.0, best->gain.value, best->gain.error, {}, remark});
    search.say("  = " + lag + ": " + remark);
  }
  result.state = std::move(best->state);
  return true;
}

}  // namespace tread::gap
