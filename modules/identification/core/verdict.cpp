// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "modules/identification/core/diagnostics.hpp"
#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/validation.hpp"

namespace tread::gap {
namespace {

constexpr double kShareOfTypical = 0.1;

bool isAmbiguous(const FoundEffect& effect) {
  if (!effect.group.empty()) return true;
  return std::any_of(effect.runner_ups.begin(), effect.runner_ups.end(),
                     [](const RunnerUp& other) { return other.behind < other.error; });
}

EffectKind kindOf(const Estimate& estimate) {
  return effectNamed(effectOfPath(estimate.parameter)).kind();
}

/// Whether a term of the INS has changed by a share of its typical size: the ends of executions do
/// not show it, since they begin with the same error.
bool hasInstrumentChanged(const Estimate& estimate) {
  const size_t dot = estimate.parameter.find('.');
  if (dot == std::string::npos || kindOf(estimate) != EffectKind::kMeasurement) return false;
  const double typical = parameterNamed(effectNamed(effectOfPath(estimate.parameter)),
                                        estimate.parameter.substr(dot + 1))
                             .typical;
  return std::abs(estimate.value - estimate.before) > kShareOfTypical * std::abs(typical);
}

/// A change of what the model already has is a discrepancy if the end error falls with it.
void dropIrrelevantMoves(Finding& finding, double least_gain) {
  const Gap& gap = *finding.gap;
  const double least = 1.0 - least_gain;
  const bool matters = gap.after.position.median < least * gap.before.position.median ||
                       gap.after.yaw.median < least * gap.before.yaw.median;
  for (Estimate& estimate : finding.identified.calibrated)
    estimate.moved = estimate.moved && (matters || hasInstrumentChanged(estimate));
}

GapVerdict verdictWithoutEffects(const Finding& finding, bool adequate) {
  bool any = false;
  bool vehicle = false;
  for (const Estimate& estimate : finding.identified.calibrated) {
    if (!estimate.moved) continue;
    any = true;
    vehicle = vehicle || kindOf(estimate) == EffectKind::kVehicle;
  }
  if (!any) return adequate ? GapVerdict::kNoDiscrepancy : GapVerdict::kNotInCatalogue;
  if (!adequate) return GapVerdict::kPartial;
  return vehicle ? GapVerdict::kFound : GapVerdict::kMeasurement;
}

GapVerdict verdictOf(const Finding& finding, const std::vector<FoundEffect>& shown, bool adequate) {
  if (!adequate) return GapVerdict::kPartial;
  if (std::any_of(shown.begin(), shown.end(), isAmbiguous)) return GapVerdict::kAmbiguous;
  const bool measurement = std::all_of(shown.begin(), shown.end(), [](const FoundEffect& effect) {
    return effectNamed(effect.name).kind() == EffectKind::kMeasurement;
  });
  // A term of the vehicle that has changed is a finding, too.
  const bool moved =
      std::any_of(finding.identified.calibrated.begin(), finding.identified.calibrated.end(),
                  [](const Estimate& estimate) {
                    return estimate.moved && kindOf(estimate) == EffectKind::kVehicle;
                  });
  return measurement && !moved ? GapVerdict::kMeasurement : GapVerdict::kFound;
}

/// A size at the end of what is plausible is no measurement.
void refuseOnBound(const Estimate& estimate, Finding& finding) {
  if (!runsToBound(finding.identified.model, freeParameter(finding.before, estimate.parameter)))
    return;
  finding.verdict = GapVerdict::kCannotTell;
  finding.reason = estimate.parameter + " runs to the end of its plausible range";
}

}  // namespace

int measuredBlocks(const Observations& data) {
  const std::vector<char> counts = blocksThatCount(data, std::vector<char>(data.all().size(), 1));
  return static_cast<int>(std::count(counts.begin(), counts.end(), char{1}));
}

std::string tooLittleDriving(const Observations& data) {
  const int measured = measuredBlocks(data);
  if (measured >= kLeastBlocks) return "";
  double driven = 0.0;
  for (const Drive& drive : data.drives()) driven += drive.driven();
  if (data.blocks() > measured && data.blockLength() > 0.0) driven = measured * data.blockLength();
  return "only " + fixed(driven, 0) +
         " s of measured driving, too little to tell chance from cause: drive at least " +
         fixed(kLeastBlocks * ObservationSettings{}.block, 0) + " s";
}

void judge(Finding& finding, double adequacy_alpha, double least_gain) {
  const bool adequate = finding.adequacy.p_value > adequacy_alpha;
  std::vector<FoundEffect> shown;
  std::copy_if(finding.identified.effects.begin(), finding.identified.effects.end(),
               std::back_inserter(shown), isShown);
  if (shown.empty()) {
    dropIrrelevantMoves(finding, least_gain);
    finding.verdict = verdictWithoutEffects(finding, adequate);
  } else {
    finding.verdict = verdictOf(finding, shown, adequate);
  }
  if (finding.verdict == GapVerdict::kNoDiscrepancy && !finding.search.at_bound.empty()) {
    finding.verdict = GapVerdict::kCannotTell;
    finding.reason = finding.search.at_bound.front() + " runs to the end of its plausible range";
  }
  for (const Estimate& estimate : finding.identified.calibrated) refuseOnBound(estimate, finding);
  for (const FoundEffect& effect : finding.identified.effects)
    for (const Estimate& estimate : effect.parameters) refuseOnBound(estimate, finding);
}

}  // namespace tread::gap
