// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/discovery.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include "common/soundness/core/lag_table.hpp"
#include "common/statistics/statistics.hpp"
#include "modules/identification/core/adequacy.hpp"
#include "modules/identification/core/end_errors.hpp"
#include "modules/identification/core/identified_model.hpp"
#include "modules/identification/core/rest.hpp"
#include "modules/identification/core/search_steps.hpp"
#include "modules/identification/core/unnamed.hpp"
#include "modules/identification/core/verdict.hpp"

namespace tread::gap {
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
    if (note.isFatal()) return note.log + ": " + note.what;
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

/// The model at the start: a calibrated one is treated as new, without priors.
ModelDocument modelBefore(const GapTask& task) {
  ModelDocument before = task.model;
  if (task.calibrate) before.rest.reset();
  return before;
}

/// One run of the five steps.
class Discovery {
 public:
  Discovery(const GapTask& task, const Progress& say)
      : task_(task),
        say_(say),
        before_(modelBefore(task)),
        data_(task.train, fromOneMinute()),
        fitter_(data_, task.parallel, restConditions(data_, before_)),
        settings_(settingsOf(task)) {}

  GapFinding run() {
    if (!check()) return finding_;
    searchEffects();
    describeRemainder();
    identify();
    measureErrors();
    return finding_;
  }

 private:
  bool check() {
    const int blocks = data_.measuredBlocks();
    finding_.source = {task_.seed,          task_.log_notes,
                       task_.decisions,     static_cast<size_t>(blocks),
                       data_.blockLength(), data_.isBrief()};
    finding_.before = before_;
    finding_.identified.model = before_;
    finding_.reason = reasonNotToTell(task_, data_);
    if (!finding_.reason.empty()) return false;
    say_("1 check: " + std::to_string(data_.all().size()) + " rows in " + std::to_string(blocks) +
         " blocks");
    return true;
  }

  void searchEffects() {
    say_("2 search: calibrate, test, refit, validate, prune");
    result_ = search(fitter_, before_, settings_, memory_, say_);
    requireSized(result_, settings_);
    tested_ = result_.state;
    if (!task_.keep_small) dropUnconfirmed({fitter_, settings_, say_, result_});
    finding_.search = result_.record;
  }

  void describeRemainder() {
    say_("3 remainder");
    // Detected but irrelevant dependences are not part of the unnamed rest.
    if (!data_.isBrief())
      finding_.adequacy = testAdequacy(fitter_, tested_, kAdequacyAlpha, task_.seed);
    // An effect that a person rejected, or that is irrelevant, would return without its name.
    const bool all_kept = result_.state.free.size() == tested_.free.size();
    // The kernel of a holonomic base has none.
    const bool has_terms = !before_.vehicle.isOmni() && !data_.isBrief();
    if (has_terms && !task_.named_only && settings_.rejected.empty() && all_kept)
      addUnnamedTerms({fitter_, settings_, say_, result_}, kAdequacyAlpha, finding_.adequacy,
                      unnamed_);
    finding_.search.cut_short = result_.record.cut_short;
    ModelDocument& model = result_.state.model;
    // A rest without anything new stays as it was.
    if (!data_.isBrief() &&
        (!before_.rest || !unnamed_.empty() || finding_.adequacy.p_value <= kAdequacyAlpha)) {
      model.rest = restOf(fitter_, result_.state, task_.seed);
      countTermsToRest(data_, model);
    } else {
      model.rest = before_.rest;
    }
  }

  void identify() {
    say_("4 identified model");
    finding_.identified = identifiedModel(fitter_, before_, settings_, result_);
    describe(fitter_, before_, unnamed_, finding_.identified);
  }

  void measureErrors() {
    say_("5 error on driving that was not used, and verdict");
    const ModelDocument& after = finding_.identified.model;
    std::optional<Observations> test;
    if (!task_.test.empty()) test.emplace(task_.test, ObservationSettings{});
    const UnseenErrors unseen =
        test ? errorsOnTest(task_, *test, after)
             : errorsOnHalves(before_, fitter_, result_, unnamed_, settings_, memory_);
    if (!test) widenByHalves(unseen.parts, finding_.identified);
    finding_.gap = unseen.gap;
    finding_.gap->apart = apart(test ? *test : data_, task_.model, after);
    finding_.gap->floor = deadReckoningFloor(test ? task_.test : task_.train);
    finding_.atlas = residualAtlas(data_, task_.model, after, finding_.adequacy.unexplained);
    finding_.shown = shownExecutions(unseen.parts, task_.model, residualNoise(fitter_, after));
    judge(finding_, kAdequacyAlpha, settings_.least_gain);
  }

  const GapTask& task_;
  const Progress& say_;
  const ModelDocument before_;
  const Observations data_;
  const Fitter fitter_;
  const SearchSettings settings_;
  SearchMemory memory_;
  FoundTerms result_;
  FitState tested_;  ///< the result before irrelevant effects were dropped
  std::vector<UnnamedFinding> unnamed_;
  GapFinding finding_;
};

}  // namespace

GapFinding findGap(const GapTask& task, const Progress& say) {
  return Discovery(task, say).run();
}

}  // namespace tread::gap
