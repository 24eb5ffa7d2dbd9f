// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/discovery.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "common/soundness/core/lag_table.hpp"
#include "common/statistics/statistics.hpp"
#include "modules/identification/core/adequacy.hpp"
#include "modules/identification/core/end_errors.hpp"
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
  const Evidence* wheels = effect.evidenceBy(EvidenceSource::kWheels);
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

bool isExcited(const CandidateTest& test) {
  const double typical = parameterNamed(effectNamed(test.effect), test.parameter).typical;
  return test.detectable <= kInvisible * std::abs(typical);
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

constexpr double kShareOfTypical = 0.1;

bool isAmbiguous(const FoundEffect& effect) {
  if (!effect.group.empty()) return true;
  return std::any_of(effect.runner_ups.begin(), effect.runner_ups.end(),
                     [](const RunnerUp& other) { return other.behind < other.error; });
}

EffectKind kindOf(const ParameterEstimate& estimate) {
  return effectNamed(effectOfPath(estimate.parameter)).kind();
}

/// Whether a term of the INS has changed by a share of its typical size: the ends of executions do
/// not show it, because they start with the same error.
bool hasInstrumentChanged(const ParameterEstimate& estimate) {
  const size_t dot = estimate.parameter.find('.');
  if (dot == std::string::npos || kindOf(estimate) != EffectKind::kMeasurement) return false;
  const double typical = parameterNamed(effectNamed(effectOfPath(estimate.parameter)),
                                        estimate.parameter.substr(dot + 1))
                             .typical;
  return std::abs(estimate.value - estimate.before) > kShareOfTypical * std::abs(typical);
}

/// A change of a given term is a discrepancy if the end error falls with it, or would fall if the
/// new model were right.
/** The scatter of errors hides the gain from a small change: if two models differ by d and the
 * right one has an error of e, the wrong one has the root of e^2 + d^2. */
void dropIrrelevantMoves(GapFinding& finding, double least_gain) {
  const Gap& gap = *finding.gap;
  const double least = 1.0 - least_gain;
  const double share = std::sqrt(1.0 / (least * least) - 1.0);
  const auto falls = [&](const ErrorFigure& before, const ErrorFigure& after,
                         const ErrorFigure& apart) {
    return after.median < least * before.median || apart.median > share * after.median;
  };
  const bool matters = falls(gap.before.position, gap.after.position, gap.apart.position) ||
                       falls(gap.before.yaw, gap.after.yaw, gap.apart.yaw);
  for (ParameterEstimate& estimate : finding.identified.calibrated)
    estimate.moved = estimate.moved && (matters || hasInstrumentChanged(estimate));
  if (!matters) finding.identified.moved_terms.clear();
}

bool anyMoved(const GapFinding& finding) {
  return std::any_of(finding.identified.calibrated.begin(), finding.identified.calibrated.end(),
                     [](const ParameterEstimate& estimate) { return estimate.moved; });
}

GapVerdict verdictWithoutEffects(const GapFinding& finding, bool adequate) {
  bool vehicle = false;
  for (const ParameterEstimate& estimate : finding.identified.calibrated)
    vehicle = vehicle || (estimate.moved && kindOf(estimate) == EffectKind::kVehicle);
  const bool known = finding.before.rest && !finding.before.rest->empty();
  if (!anyMoved(finding))
    return !adequate ? GapVerdict::kNotInCatalogue
           : known   ? GapVerdict::kNothingNew
                     : GapVerdict::kNoDiscrepancy;
  if (!adequate) return GapVerdict::kPartial;
  return vehicle ? GapVerdict::kFound : GapVerdict::kMeasurement;
}

GapVerdict verdictOf(const GapFinding& finding, const std::vector<FoundEffect>& shown,
                     bool adequate) {
  if (!adequate) return GapVerdict::kPartial;
  if (std::any_of(shown.begin(), shown.end(), isAmbiguous)) return GapVerdict::kAmbiguous;
  const bool measurement = std::all_of(shown.begin(), shown.end(), [](const FoundEffect& effect) {
    return effectNamed(effect.name).kind() == EffectKind::kMeasurement;
  });
  // A changed term of the vehicle is a finding, too.
  const bool moved =
      std::any_of(finding.identified.calibrated.begin(), finding.identified.calibrated.end(),
                  [](const ParameterEstimate& estimate) {
                    return estimate.moved && kindOf(estimate) == EffectKind::kVehicle;
                  });
  return measurement && !moved ? GapVerdict::kMeasurement : GapVerdict::kFound;
}

constexpr double kUndescribed = 0.15;  // of the distance: a larger error means another vehicle
constexpr double kLeastWay =
    1.0;  // [m]: below it, noise and patches of ground can cause such errors

/// Whether all that may be added was: a search that ended early or without an effect that a person
/// rejected says nothing about the kernel.
bool searchedWhole(const GapFinding& finding) {
  const std::vector<EffectDecision>& decisions = finding.source.decisions;
  return !finding.search.cut_short &&
         std::all_of(decisions.begin(), decisions.end(),
                     [](const EffectDecision& decision) { return decision.accepted; });
}

/// Effects on a model that is far from the vehicle are not valid names for the deviations.
/** Of cars and holonomic bases, whose kernels are the simpler ones. On tracks noisy positions cause
 * such errors, too, and adequacy judges the rest. */
void refuseUndescribed(GapFinding& finding) {
  if (finding.identified.model.vehicle.layout() == VehicleLayout::kTracks) return;
  if (!finding.gap || exitStatus(finding.verdict) == 0) return;
  if (finding.verdict == GapVerdict::kCannotTell || !searchedWhole(finding)) return;
  const double off = finding.gap->after.position.median;
  const double way = finding.gap->way;
  if (!(way > kLeastWay && off > kUndescribed * way)) return;
  finding.verdict = GapVerdict::kCannotTell;
  finding.reason = "the best model is " + digits(off, 2) + " m off after " +
                   digits(finding.gap->horizon, 0) + " s that lead " + digits(way, 1) +
                   " m away: this vehicle is not what the model describes";
}

/// A size at the end of its plausible range is no measurement.
void refuseOnBound(const ParameterEstimate& estimate, GapFinding& finding) {
  if (!runsToBound(finding.identified.model, freeParameter(finding.before, estimate.parameter)))
    return;
  finding.verdict = GapVerdict::kCannotTell;
  finding.reason = estimate.parameter + " runs to the end of its plausible range";
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
    }
  }
  for (const std::string& path : changePointsOn(state.model)) {
    const std::string effect = effectOf(path);
    if (!contains(result.effects, effect)) continue;
    ParameterEstimate estimate = estimateOf(path, ModelDocument{}, state.model, 0.0);
    std::tie(estimate.low, estimate.high) = changePointInterval(fitter, state, path, kChangeNats);
    of_effect[effect].push_back(estimate);
  }
  std::map<std::string, std::vector<Evidence>> evidence;
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
    if (!contains(result.effects, test.effect) && !isExcited(test) &&
        !isOn(effectNamed(test.effect), before))
      identified.not_excited.push_back(test.effect);
  identified.model = state.model;
  identified.model.covariance = knownCovariance(state, covariance);
  identified.model.envelope = envelopeOf(data, state.model.vehicle);
  return identified;
}

std::string tooLittleDriving(const Observations& data) {
  const int measured = data.measuredBlocks();
  if (measured >= kLeastBlocks) return "";
  double driven = 0.0;
  for (const Drive& drive : data.drives()) driven += drive.driven();
  if (data.blocks() > measured && data.blockLength() > 0.0) driven = measured * data.blockLength();
  return "only " + fixed(driven, 0) +
         " s of measured driving, too little to tell chance from cause: drive at least " +
         fixed(kLeastBlocks * ObservationSettings{}.block, 0) + " s";
}

void judge(GapFinding& finding, double adequacy_alpha, double least_gain) {
  std::vector<FoundEffect> shown;
  std::copy_if(finding.identified.effects.begin(), finding.identified.effects.end(),
               std::back_inserter(shown), isShown);
  if (shown.empty()) dropIrrelevantMoves(finding, least_gain);
  // A dependence explained only by an unnamed term has no name: it counts as unexplained.
  const bool adequate = finding.adequacy.p_value > adequacy_alpha &&
                        finding.identified.unnamed.empty() &&
                        finding.identified.moved_terms.empty();
  if (shown.empty()) {
    finding.verdict = verdictWithoutEffects(finding, adequate);
  } else {
    finding.verdict = verdictOf(finding, shown, adequate);
  }
  if (exitStatus(finding.verdict) == 0 && !finding.search.at_bound.empty()) {
    finding.verdict = GapVerdict::kCannotTell;
    finding.reason = finding.search.at_bound.front() + " runs to the end of its plausible range";
  }
  if (finding.search.cut_short) {
    const bool any = !shown.empty() || anyMoved(finding) || !finding.identified.unnamed.empty() ||
                     !finding.identified.moved_terms.empty();
    finding.verdict = any ? GapVerdict::kPartial : GapVerdict::kCannotTell;
    if (!any)
      finding.reason = "the time limit ended the search before anything was found; give it more";
  }
  for (const ParameterEstimate& estimate : finding.identified.calibrated)
    refuseOnBound(estimate, finding);
  for (const FoundEffect& effect : finding.identified.effects)
    for (const ParameterEstimate& estimate : effect.parameters) refuseOnBound(estimate, finding);
  refuseUndescribed(finding);
}

namespace {

constexpr int kLeastHalf = 10;           // blocks from which effects can be chosen
constexpr double kAdequacyAlpha = 0.01;  // for the variables; half of it more for smooth functions

constexpr double kFastestCar = 15.0;    // [m/s]
constexpr double kNearlyAlways = 0.98;  // of the driving

/// Why the model's equations do not hold for a drive of this vehicle; empty if they hold for all.
std::string beyondTheModel(const GapTask& task) {
  if (!task.model.vehicle.isCar()) return "";
  std::vector<double> speeds;
  for (const Drive& drive : task.train)
    for (const PoseIncrement& increment : poseIncrements(drive))
      speeds.push_back(std::abs(increment.v()));
  const double fastest = quantileOf(std::move(speeds), kNearlyAlways, 0.0);
  if (fastest <= kFastestCar) return "";
  return "it drives at up to " + digits(fastest, 1) + " m/s: beyond " + digits(kFastestCar, 0) +
         " m/s a car is gears, tyres and load transfer, which the model does not have";
}

/// Why no conclusion is possible; empty if one is.
std::string reasonNotToTell(const GapTask& task, const Observations& data) {
  for (const LogNote& note : task.log_notes)
    if (note.fatal) return note.log + ": " + note.what;
  const std::string beyond = beyondTheModel(task);
  return beyond.empty() ? tooLittleDriving(data) : beyond;
}

SearchSettings settingsOf(const GapTask& task) {
  SearchSettings settings;
  settings.seed = task.seed;
  settings.calibrate = task.calibrate;
  if (task.keep_small) settings.least_gain = 0.0;
  for (const EffectDecision& decision : task.decisions)
    (decision.accepted ? settings.accepted : settings.rejected).push_back(decision.effect);
  settings.all_sized = true;
  settings.is_over = task.is_over;
  return settings;
}

/// An accepted effect without a size would be an empty claim.
void requireSized(const FoundTerms& result, const SearchSettings& settings) {
  std::map<std::string, std::string> unsized = result.unsized;
  for (const FreeParameter& parameter : result.state.free) {
    const std::string effect = effectOf(parameter.path);
    if (contains(result.effects, effect) && contains(settings.accepted, effect) &&
        *findParameter(result.state.model, parameter.path) != 0.0 &&
        onBound(result.state.model, parameter))
      unsized[effect] = "its size runs to the end of its plausible range";
  }
  for (const auto& [effect, why] : unsized)
    throw std::invalid_argument(effect + ": accepted, but this drive cannot size it: " + why +
                                "; drive so that it shows, or do not accept it");
}

/// Errors before and after, on driving that was not used for the fit.
struct UnseenErrors {
  Gap gap;
  std::vector<Unseen> parts;  ///< of the new model
};

UnseenErrors errorsOnTest(const GapTask& task, const Observations& test,
                          const ModelDocument& after) {
  UnseenErrors unseen;
  const std::vector<ExecutionError> old = endErrors(test, task.model);
  unseen.gap.before = summaryOf(old);
  unseen.gap.way = medianWay(old);
  unseen.parts.push_back({&test, after, endErrors(test, after), task.train.size()});
  unseen.gap.after = summaryOf(unseen.parts.back().errors);
  unseen.gap.by_chance = chanceOfMedians(old, unseen.parts.back().errors);
  return unseen;
}

/// Alternate blocks: the result of each half predicts the other.
UnseenErrors errorsOnHalves(const ModelDocument& before, const Fitter& fitter,
                            const FoundTerms& result, const std::vector<UnnamedFinding>& unnamed,
                            SearchSettings settings, SearchMemory& memory) {
  const Observations& data = fitter.data();
  UnseenErrors unseen;
  bool& nested = unseen.gap.structure_nested;
  nested = data.measuredBlocks() >= 2 * kLeastHalf && !result.record.cut_short;
  const std::vector<ExecutionError> old = endErrors(data, before);
  unseen.gap.before = summaryOf(old);
  unseen.gap.way = medianWay(old);
  std::vector<std::vector<TermChannel>> channels;
  for (const UnnamedFinding& term : unnamed)
    channels.push_back({termOfPath(result.state.model, term.name + ".0")->channel});
  std::vector<ExecutionError> outside;  // of either half
  settings.all_sized = false;           // half of the driving may not show all of them
  const Progress silent = [](const std::string&) {};
  for (int half : {0, 1}) {
    const Fitter on_half = fitter.onRows(halfMask(data, half));
    std::optional<FoundTerms> alone;
    if (nested) alone = search(on_half, before, settings, memory, silent);
    // Each half of the driving chooses its own terms, as many as all of it did.
    for (size_t i = 0; alone && !alone->record.cut_short && i < channels.size(); ++i)
      addTerm(on_half, alone->state, channels[i], kTermSureOfHalf);
    // Without time left it chooses no effects: they are those of all the driving.
    nested = alone && !alone->record.cut_short;
    const ModelDocument model = nested ? alone->state.model : refitted(on_half, result).model;
    unseen.parts.push_back({&data, model, {}, 0});
    std::vector<ExecutionError>& errors = unseen.parts.back().errors;
    for (const ExecutionError& error : endErrors(data, model))
      if (error.block % 2 != half) errors.push_back(error);
    outside.insert(outside.end(), errors.begin(), errors.end());
  }
  unseen.gap.after = summaryOf(outside);
  unseen.gap.by_chance = chanceOfMedians(old, outside);
  return unseen;
}

/// Widens the intervals of found effects by half of the difference between the two halves of the
/// driving.
/** Blocks give the scatter of a size if its form is right and the other effects are the same; if
 * the halves choose other effects, or one does without it, that adds to the scatter. */
void widenByHalves(const std::vector<Unseen>& halves, IdentifiedModel& identified) {
  for (FoundEffect& effect : identified.effects)
    for (ParameterEstimate& estimate : effect.parameters) {
      if (parameterNamed(effectNamed(effect.name),
                         estimate.parameter.substr(effect.name.size() + 1))
              .role == ParameterRole::kShape)
        continue;
      const double apart = 0.5 * (*findParameter(halves[0].model, estimate.parameter) -
                                  *findParameter(halves[1].model, estimate.parameter));
      estimate.low = estimate.value - std::hypot(estimate.value - estimate.low, apart);
      estimate.high = estimate.value + std::hypot(estimate.high - estimate.value, apart);
    }
}

/// Adds the report's data on unnamed terms: the certainty of their values, and their basis.
void describe(const Fitter& fitter, const ModelDocument& before,
              const std::vector<UnnamedFinding>& unnamed, IdentifiedModel& identified) {
  identified.unnamed = unnamed;
  // The fitter has the conditions of the earlier rest.
  ModelDocument with_old_rest = identified.model;
  with_old_rest.rest = before.rest;
  for (UnnamedFinding& found : identified.unnamed) {
    const UnnamedTerm& term = *termOfPath(identified.model, found.name + ".0");
    for (size_t i = 0; i < term.values.size(); ++i)
      found.deviations.push_back(
          term.values[i] == 0.0 ? 0.0 : knownDeviation(identified.model, termPath(term, i)));
    found.data = termCells(fitter, with_old_rest, term);
  }
}

/// Noise of a model's residuals, channel by channel.
Noise residualNoise(const Fitter& fitter, const ModelDocument& model) {
  const Observations& data = fitter.data();
  const Eigen::VectorXd predicted = data.predict(model);
  return estimateNoise(data.all(), data.residuals(predicted), activityOf(data.all(), predicted),
                       fitter.mask());
}

}  // namespace

GapFinding findGap(const GapTask& task, const Progress& say) {
  const Observations data(task.train, {});
  ModelDocument before = task.model;
  // A calibrated model is treated as new: without priors.
  if (task.calibrate) before.rest.reset();
  const Fitter fitter(data, task.parallel, restConditions(data, before));
  const int blocks = data.measuredBlocks();
  GapFinding finding;
  finding.source = {task.seed, task.log_notes, task.decisions, static_cast<size_t>(blocks),
                    data.blockLength()};
  finding.before = before;
  finding.identified.model = before;
  finding.reason = reasonNotToTell(task, data);
  if (!finding.reason.empty()) return finding;
  say("1 calibrate: " + std::to_string(data.all().size()) + " rows in " + std::to_string(blocks) +
      " blocks");
  say("2-5 test, refit, validate, prune");
  const SearchSettings settings = settingsOf(task);
  SearchMemory memory;
  FoundTerms result = search(fitter, before, settings, memory, say);
  requireSized(result, settings);
  // Detected but irrelevant dependences are not part of the unnamed rest.
  const FitState tested = result.state;
  if (!task.keep_small) dropUnconfirmed({fitter, settings, say, result});
  finding.search = result.record;
  say("6 adequacy");
  finding.adequacy = testAdequacy(fitter, tested, kAdequacyAlpha, task.seed);
  std::vector<UnnamedFinding> unnamed;
  // An effect that a person rejected, or that is irrelevant, would return without its name.
  const bool all_kept = result.state.free.size() == tested.free.size();
  const bool has_terms = !before.vehicle.isOmni();  // its kernel has none
  if (has_terms && !task.named_only && settings.rejected.empty() && all_kept)
    addUnnamedTerms({fitter, settings, say, result}, kAdequacyAlpha, finding.adequacy, unnamed);
  finding.search.cut_short = result.record.cut_short;
  // A rest without anything new stays as it was.
  if (!before.rest || !unnamed.empty() || finding.adequacy.p_value <= kAdequacyAlpha) {
    result.state.model.rest = restOf(fitter, result.state, task.seed);
    countTermsToRest(data, result.state.model);
  } else {
    result.state.model.rest = before.rest;
  }
  finding.identified = identifiedModel(fitter, before, settings, result);
  describe(fitter, before, unnamed, finding.identified);
  say("7 error on driving that was not used");
  std::optional<Observations> test;
  if (!task.test.empty()) test.emplace(task.test, ObservationSettings{});
  const ModelDocument& after = finding.identified.model;
  const UnseenErrors unseen =
      test ? errorsOnTest(task, *test, after)
           : errorsOnHalves(before, fitter, result, unnamed, settings, memory);
  if (!test) widenByHalves(unseen.parts, finding.identified);
  finding.gap = unseen.gap;
  finding.gap->apart = apart(test ? *test : data, task.model, after);
  finding.gap->floor = deadReckoningFloor(task.test.empty() ? task.train : task.test);
  finding.atlas = residualAtlas(data, task.model, after, finding.adequacy.unexplained);
  finding.shown = shownExecutions(unseen.parts, task.model, residualNoise(fitter, after));
  judge(finding, kAdequacyAlpha, settings.least_gain);
  return finding;
}

}  // namespace tread::gap
