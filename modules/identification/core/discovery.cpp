// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/discovery.hpp"

#include <map>
#include <optional>
#include <stdexcept>

#include "modules/identification/core/adequacy.hpp"
#include "modules/identification/core/end_errors.hpp"

namespace tread::gap {
namespace {

constexpr int kLeastHalf = 10;           // blocks from which effects can be chosen, too
constexpr double kAdequacyAlpha = 0.01;  // with the tests' 2 %: 3 % false alarms altogether

/// Why nothing can be concluded; empty if something can.
std::string reasonNotToTell(const GapTask& task, const Observations& data) {
  for (const LogNote& note : task.log_notes)
    if (note.fatal) return note.log + ": " + note.what;
  return tooLittleDriving(data);
}

SearchSettings settingsOf(const GapTask& task) {
  SearchSettings settings;
  settings.seed = task.seed;
  settings.calibrate = task.calibrate;
  if (task.keep_small) settings.least_gain = 0.0;
  for (const Decision& decision : task.decisions)
    (decision.accepted ? settings.accepted : settings.rejected).push_back(decision.effect);
  settings.all_sized = true;
  return settings;
}

/// An accepted effect without a size would be a claim about nothing.
void requireSized(const SearchResult& result, const SearchSettings& settings) {
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
                                "; drive what shows it, or do not accept it");
}

/// Errors before and after on driving that was not used for the fit.
struct UnseenErrors {
  Gap gap;
  std::vector<Unseen> parts;  ///< of the new model
};

UnseenErrors errorsOnTest(const GapTask& task, const Observations& test,
                          const ModelDocument& after) {
  UnseenErrors unseen;
  unseen.gap.before = summaryOf(endErrors(test, task.model));
  unseen.parts.push_back({&test, after, endErrors(test, after), task.train.size()});
  unseen.gap.after = summaryOf(unseen.parts.back().errors);
  return unseen;
}

/// Alternate blocks: what one half found predicts the other.
UnseenErrors errorsOnHalves(const GapTask& task, const Fitter& fitter, const SearchResult& result,
                            SearchSettings settings, SearchMemory& memory) {
  const Observations& data = fitter.data();
  UnseenErrors unseen;
  unseen.gap.structure_nested = data.measuredBlocks() >= 2 * kLeastHalf;
  unseen.gap.before = summaryOf(endErrors(data, task.model));
  std::vector<ExecutionError> outside;  // of either half
  settings.all_sized = false;           // half of the driving may not show all
  const Progress silent = [](const std::string&) {};
  for (int half : {0, 1}) {
    const Fitter on_half = fitter.onRows(halfMask(data, half));
    const ModelDocument model =
        unseen.gap.structure_nested
            ? search(on_half, task.model, settings, memory, silent).state.model
            : refitted(on_half, result).model;
    unseen.parts.push_back({&data, model, {}, 0});
    std::vector<ExecutionError>& errors = unseen.parts.back().errors;
    for (const ExecutionError& error : endErrors(data, model))
      if (error.block % 2 != half) errors.push_back(error);
    outside.insert(outside.end(), errors.begin(), errors.end());
  }
  unseen.gap.after = summaryOf(outside);
  return unseen;
}

/// Noise of what a model leaves, channel by channel.
Noise residualNoise(const Fitter& fitter, const ModelDocument& model) {
  const Observations& data = fitter.data();
  const Eigen::VectorXd predicted = data.predict(model);
  return estimateNoise(data.all(), data.residuals(predicted), activityOf(data.all(), predicted),
                       fitter.mask());
}

}  // namespace

Finding findGap(const GapTask& task, const Progress& say) {
  const Observations data(task.train, {});
  const Fitter fitter(data, task.parallel);
  const int blocks = data.measuredBlocks();
  Finding finding;
  finding.source = {task.seed, task.log_notes, task.decisions, static_cast<size_t>(blocks),
                    data.blockLength()};
  finding.before = task.model;
  finding.identified.model = task.model;
  finding.reason = reasonNotToTell(task, data);
  if (!finding.reason.empty()) return finding;
  say("1 calibrate: " + std::to_string(data.all().size()) + " rows in " + std::to_string(blocks) +
      " blocks");
  say("2-5 test, refit, validate, prune");
  const SearchSettings settings = settingsOf(task);
  SearchMemory memory;
  SearchResult result = search(fitter, task.model, settings, memory, say);
  requireSized(result, settings);
  // What was seen but does not matter is no rest without a name.
  const FitState tested = result.state;
  if (!task.keep_small) dropUnconfirmed({fitter, settings, say, result});
  finding.identified = identifiedModel(fitter, task.model, settings, result);
  finding.search = result.record;
  say("6 adequacy");
  finding.adequacy = testAdequacy(fitter, tested, kAdequacyAlpha, task.seed);
  say("7 error on driving that was not used");
  std::optional<Observations> test;
  if (!task.test.empty()) test.emplace(task.test, ObservationSettings{});
  const ModelDocument& after = finding.identified.model;
  const UnseenErrors unseen = test ? errorsOnTest(task, *test, after)
                                   : errorsOnHalves(task, fitter, result, settings, memory);
  finding.gap = unseen.gap;
  finding.gap->floor = deadReckoningFloor(task.test.empty() ? task.train : task.test);
  finding.atlas = residualAtlas(data, task.model, after);
  finding.shown = shownExecutions(unseen.parts, task.model, residualNoise(fitter, after));
  judge(finding, kAdequacyAlpha, settings.least_gain);
  return finding;
}

}  // namespace tread::gap
