// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/identified_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "modules/identification/core/evidence.hpp"
#include "modules/identification/core/moved_terms.hpp"
#include "modules/identification/core/rest.hpp"
#include "modules/identification/core/search_steps.hpp"
#include "modules/identification/core/unnamed.hpp"

namespace tread::gap {
namespace {

constexpr double kChangeNats = 10.0;  // 2 nats, corrected for correlated ground
constexpr double kInvisible = 2.0;    // times its typical size: not excited
/// Minimum half-width of the 95 % interval as a share of a found size. No vehicle follows the
/// catalogue's equations exactly, and no drive shows the resulting error of their sizes: 1 to 5 %
/// in the blind study, for effects that only resemble them.
constexpr double kForm = 0.05;
constexpr double kTermChanged = 0.7;  // of the largest value of an unnamed term

/// `half` of the 95 % interval.
ParameterEstimate estimateOf(const std::string& path, const ModelDocument& before,
                             const ModelDocument& after, double half) {
  const double value = *findParameter(after, path);
  return {path, unitOf(path), value, value - half, value + half, *findParameter(before, path)};
}

bool isShape(const std::string& path) {
  const EffectParameter* known = findEffectParameter(path);
  return known != nullptr && known->role == ParameterRole::kShape;
}

/// Half-width of a given term's interval, infinite if the drive does not excite it.
double halfInterval(const FitState& state, size_t index, double half) {
  const std::string& path = state.free[index].path;
  const EffectParameter* known = findEffectParameter(path);
  if (known == nullptr) return half;
  const double visible =
      std::max(kInvisible * std::abs(known->typical), std::abs(*findParameter(state.model, path)));
  return half < visible ? half : std::numeric_limits<double>::infinity();
}

/// Whether a value of a model's unnamed term has changed, significantly and by kTermChanged of the
/// term's largest value.
/** Such a term is only similar to its cause: on another drive its values differ by more than the
 * blocks of one drive show. */
bool hasTermMoved(const UnnamedTerm& term, const ParameterEstimate& estimate,
                  double most_by_chance) {
  const double change = std::abs(estimate.value - estimate.before);
  return change > most_by_chance && change > kTermChanged * largestValue(term);
}

FoundEffect foundEffect(const std::string& name, const FoundTerms& result,
                        const SearchSettings& settings, std::vector<ParameterEstimate> parameters) {
  const auto known = result.evidence.find(name);
  const EffectEvidence evidence = known == result.evidence.end() ? EffectEvidence{} : known->second;
  FoundEffect effect;
  effect.name = name;
  effect.parameters = std::move(parameters);
  effect.score = evidence.score;
  effect.p_value = evidence.p_value.value_or(0.0);
  effect.gain = evidence.gain.value;
  effect.gain_error = evidence.gain.error;
  effect.accepted = contains(settings.accepted, name);
  if (effect.accepted) return effect;  // accepted by a person: it has no alternatives
  const VehicleLayout layout = result.state.model.vehicle.layout();
  std::vector<std::string> group = confoundedEffects(name, result.state.model.measurement);
  for (const std::string& pair : evidence.replaced) group.push_back(pair);
  for (const std::string& other : group)
    if (!contains(settings.rejected, other) && !contains(evidence.told_from, other) &&
        effectNamed(other).isOf(layout))
      effect.group.push_back(other);
  // Runners-up that were accepted later are not alternatives.
  for (const RunnerUp& other : evidence.runner_ups)
    if (!contains(result.effects, other.effect) && !contains(result.released, other.effect))
      effect.runner_ups.push_back(other);
  return effect;
}

constexpr double kLateWheels = 0.3;  // [s] by which encoders themselves may lag

/// Drops INS explanations of an effect that the wheels show.
/** Of a delay only above kLateWheels, because encoders lag too. */
void dropRefutedNames(FoundEffect& effect) {
  const MeasuredEvidence* wheels = effect.evidenceBy(EvidenceSource::kWheels);
  if (wheels == nullptr || !wheels->confirms()) return;
  const bool is_delay = effectNamed(effect.name).search.late_by == LateBy::kCommand;
  if (is_delay && effect.parameters.front().low < kLateWheels) return;
  const auto isOfIns = [](const std::string& other) {
    return effectNamed(other).kind() == EffectKind::kMeasurement;
  };
  effect.group.erase(std::remove_if(effect.group.begin(), effect.group.end(), isOfIns),
                     effect.group.end());
  effect.runner_ups.erase(
      std::remove_if(effect.runner_ups.begin(), effect.runner_ups.end(),
                     [&](const RunnerUp& other) { return isOfIns(other.effect); }),
      effect.runner_ups.end());
}

/// Whether the drive would have shown an effect; in a brief one, in its typical size.
bool isExcited(const CandidateTest& test, bool brief) {
  const EffectParameter& parameter = parameterNamed(effectNamed(test.effect), test.parameter);
  const double sizes = brief && !parameter.reciprocal() ? 1.0 : kInvisible;
  return test.detectable <= sizes * std::abs(parameter.typical);
}

ParameterCovariance knownCovariance(const FitState& state, const Eigen::MatrixXd& covariance) {
  ParameterCovariance known;
  std::vector<Eigen::Index> sure;
  for (size_t i = 0; i < state.free.size(); ++i) {
    const FreeParameter& parameter = state.free[i];
    const auto at = static_cast<Eigen::Index>(i);
    if (restTermOf(parameter.path)) continue;  // it has its own standard deviation
    if (!(std::sqrt(covariance(at, at)) < parameter.max - parameter.min)) continue;
    known.parameters.push_back(parameter.path);
    sure.push_back(at);
  }
  for (Eigen::Index i : sure) {
    known.matrix.emplace_back();
    for (Eigen::Index j : sure) known.matrix.back().push_back(covariance(i, j));
  }
  return known;
}

Envelope envelopeOf(const Observations& data, const VehicleModel& vehicle) {
  Envelope envelope;
  for (const auto& motion : data.simulate(vehicle))
    for (size_t i = 1; i < motion.size(); ++i) {
      const double dt = motion[i].time - motion[i - 1].time;
      if (dt > 0.0)
        envelope.include(twistTo(between(motion[i - 1].T_map_body, motion[i].T_map_body), dt));
    }
  return envelope;
}

}  // namespace

IdentifiedModel identifiedModel(const Fitter& fitter, const ModelDocument& before,
                                const SearchSettings& settings, const FoundTerms& result) {
  const Observations& data = fitter.data();
  const FitState& state = result.state;
  const Eigen::MatrixXd covariance = parameterCovariance(fitter, state);
  const double freedom = data.measuredBlocks() - 1;
  const double quantile = studentQuantile(freedom);
  const Moves moves = movesOf(fitter, before, result);
  IdentifiedModel identified;
  std::map<std::string, std::vector<ParameterEstimate>> of_effect;
  for (size_t i = 0; i < state.free.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (isNameless(state,
                   i)) {  // the adequacy test reports a rest, and an unnamed term reports itself
      const UnnamedTerm* const had = termOfPath(before, state.free[i].path);
      if (had != nullptr && !settings.calibrate && !contains(identified.moved_terms, had->name) &&
          hasTermMoved(*had, estimateOf(state.free[i].path, before, state.model, 0.0),
                       moves.byChance(i)))
        identified.moved_terms.push_back(had->name);
      continue;
    }
    const double error = std::sqrt(covariance(at, at));
    const std::string effect = effectOf(state.free[i].path);
    const bool found = contains(result.effects, effect);
    const bool has_form = found && !isShape(state.free[i].path);
    const double form =
        has_form ? kForm * std::abs(*findParameter(state.model, state.free[i].path)) : 0.0;
    const double half =
        found ? std::hypot(quantile * error, form) : halfInterval(state, i, quantile * error);
    ParameterEstimate estimate = estimateOf(state.free[i].path, before, state.model, half);
    if (found) {
      of_effect[effect].push_back(estimate);
    } else {
      estimate.moved =
          hasMoved(estimate, moves.byChance(i), settings.calibrate) || moves.together[i];
      identified.calibrated.push_back(estimate);
      const EffectParameter* const known = findEffectParameter(estimate.parameter);
      if (data.isBrief() && known != nullptr && moves.byChance(i) > std::abs(known->typical) &&
          !contains(identified.not_excited, effect))
        identified.not_excited.push_back(effect);
    }
  }
  for (const std::string& path : changePointsOn(state.model)) {
    const std::string effect = effectOf(path);
    if (!contains(result.effects, effect)) continue;
    ParameterEstimate estimate = estimateOf(path, ModelDocument{}, state.model, 0.0);
    std::tie(estimate.low, estimate.high) = changePointInterval(fitter, state, path, kChangeNats);
    of_effect[effect].push_back(estimate);
  }
  std::map<std::string, std::vector<MeasuredEvidence>> evidence;
  for (const EvidenceSource source :
       {EvidenceSource::kWheels, EvidenceSource::kCurrents, EvidenceSource::kVoltage})
    for (const auto& [name, shown] : evidenceBy(source, fitter, state, result.effects))
      evidence[name].push_back(shown);
  for (const std::string& name : result.effects) {
    FoundEffect effect = foundEffect(name, result, settings, of_effect[name]);
    effect.evidence = evidence[name];
    dropRefutedNames(effect);
    identified.effects.push_back(std::move(effect));
  }
  for (const CandidateTest& test : result.record.candidates)
    if (!contains(result.effects, test.effect) && !isExcited(test, data.isBrief()) &&
        !isOn(effectNamed(test.effect), before))
      identified.not_excited.push_back(test.effect);
  identified.model = state.model;
  identified.model.covariance = knownCovariance(state, covariance);
  identified.model.envelope = envelopeOf(data, state.model.vehicle);
  return identified;
}

}  // namespace tread::gap
