// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "modules/identification/core/fit.hpp"

namespace tread::gap {
namespace {

constexpr double kShareOfTypical = 0.1;

bool isAmbiguous(const FoundEffect& effect) {
  if (!effect.group.empty()) return true;
  return std::any_of(effect.runner_ups.begin(), effect.runner_ups.end(),
                     [](const RunnerUp& other) { return other.behind < other.error; });
}

EffectKind kindOf(const Estimate& estimate) {
  return effectNamed(effectOfPath(estimate.parameter)).kind;
}

/// Whether a term of the INS is another by a share of what is usual: where executions end does not
/// show it, since they begin with the same error.
bool isAnotherInstrument(const Estimate& estimate) {
  const size_t dot = estimate.parameter.find('.');
  if (dot == std::string::npos || kindOf(estimate) != EffectKind::kMeasurement) return false;
  const double typical = parameterNamed(effectNamed(effectOfPath(estimate.parameter)),
                                        estimate.parameter.substr(dot + 1))
                             .typical;
  return std::abs(estimate.value - estimate.before) > kShareOfTypical * std::abs(typical);
}

/// A change of what the model already has is a discrepancy if the end error falls with it.
void forgetMovesThatDoNotMatter(Finding& finding, double least_gain) {
  const Gap& gap = *finding.gap;
  const double least = 1.0 - least_gain;
  const bool matters = gap.after.position.median < least * gap.before.position.median ||
                       gap.after.yaw.median < least * gap.before.yaw.median;
  for (Estimate& estimate : finding.calibrated)
    estimate.moved = estimate.moved && (matters || isAnotherInstrument(estimate));
}

Verdict verdictWithoutEffects(const Finding& finding, bool adequate) {
  bool any = false;
  bool vehicle = false;
  for (const Estimate& estimate : finding.calibrated) {
    if (!estimate.moved) continue;
    any = true;
    vehicle = vehicle || kindOf(estimate) == EffectKind::kVehicle;
  }
  if (!any) return adequate ? Verdict::kNoDiscrepancy : Verdict::kNotInCatalogue;
  if (!adequate) return Verdict::kPartial;
  return vehicle ? Verdict::kFound : Verdict::kMeasurement;
}

Verdict verdictOf(const Finding& finding, const std::vector<FoundEffect>& shown, bool adequate) {
  if (!adequate) return Verdict::kPartial;
  if (std::any_of(shown.begin(), shown.end(), isAmbiguous)) return Verdict::kAmbiguous;
  const bool measurement = std::all_of(shown.begin(), shown.end(), [](const FoundEffect& effect) {
    return effect.kind == EffectKind::kMeasurement;
  });
  // A term of the vehicle that is another one now is a finding, too.
  const bool moved = std::any_of(
      finding.calibrated.begin(), finding.calibrated.end(), [](const Estimate& estimate) {
        return estimate.moved && kindOf(estimate) == EffectKind::kVehicle;
      });
  return measurement && !moved ? Verdict::kMeasurement : Verdict::kFound;
}

/// A size at the end of what is plausible is no measurement.
void refuseOnBound(const Estimate& estimate, Finding& finding) {
  if (!runsToBound(finding.after, freeParameter(finding.before, estimate.parameter))) return;
  finding.verdict = Verdict::kCannotTell;
  finding.reason = estimate.parameter + " runs to the end of its plausible range";
}

}  // namespace

void judge(Finding& finding, double adequacy_alpha, double least_gain) {
  const bool adequate = finding.adequacy_p > adequacy_alpha;
  std::vector<FoundEffect> shown;
  std::copy_if(finding.effects.begin(), finding.effects.end(), std::back_inserter(shown), isShown);
  if (shown.empty()) {
    forgetMovesThatDoNotMatter(finding, least_gain);
    finding.verdict = verdictWithoutEffects(finding, adequate);
  } else {
    finding.verdict = verdictOf(finding, shown, adequate);
  }
  if (finding.verdict == Verdict::kNoDiscrepancy && !finding.at_bound.empty()) {
    finding.verdict = Verdict::kCannotTell;
    finding.reason = finding.at_bound.front() + " runs to the end of its plausible range";
  }
  for (const Estimate& estimate : finding.calibrated) refuseOnBound(estimate, finding);
  for (const FoundEffect& effect : finding.effects)
    for (const Estimate& estimate : effect.parameters) refuseOnBound(estimate, finding);
}

}  // namespace tread::gap
