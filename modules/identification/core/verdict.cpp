// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "modules/identification/core/pruning.hpp"
#include "modules/identification/core/search.hpp"

namespace tread::gap {
namespace {

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

bool anyMoved(const GapFinding& finding, bool of_vehicle = false) {
  return std::any_of(finding.identified.calibrated.begin(), finding.identified.calibrated.end(),
                     [&](const ParameterEstimate& estimate) {
                       return estimate.moved &&
                              (!of_vehicle || kindOf(estimate) == EffectKind::kVehicle);
                     });
}

GapVerdict verdictWithoutEffects(const GapFinding& finding, bool adequate) {
  const bool known = finding.before.rest && !finding.before.rest->empty();
  if (!anyMoved(finding))
    return !adequate ? GapVerdict::kNotInCatalogue
           : known   ? GapVerdict::kNothingNew
                     : GapVerdict::kNoDiscrepancy;
  if (!adequate) return GapVerdict::kPartial;
  return anyMoved(finding, true) ? GapVerdict::kFound : GapVerdict::kMeasurement;
}

GapVerdict verdictOf(const GapFinding& finding, const std::vector<FoundEffect>& shown,
                     bool adequate) {
  if (!adequate) return GapVerdict::kPartial;
  if (std::any_of(shown.begin(), shown.end(), isAmbiguous)) return GapVerdict::kAmbiguous;
  const bool measurement = std::all_of(shown.begin(), shown.end(), [](const FoundEffect& effect) {
    return effectNamed(effect.name).kind() == EffectKind::kMeasurement;
  });
  // A changed term of the vehicle is a finding, too.
  return measurement && !anyMoved(finding, true) ? GapVerdict::kMeasurement : GapVerdict::kFound;
}

/// Whether the drive would have shown any effect that the model does not have.
bool anyExcited(const GapFinding& finding) {
  const std::vector<std::string>& unseen = finding.identified.not_excited;
  const std::vector<CandidateTest>& tests = finding.search.candidates;
  return std::any_of(tests.begin(), tests.end(), [&unseen](const CandidateTest& test) {
    return !contains(unseen, test.effect);
  });
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
  if (finding.source.brief && exitStatus(finding.verdict) == 0 && !anyExcited(finding)) {
    finding.verdict = GapVerdict::kCannotTell;
    finding.reason = "no effect of the catalogue would have shown in this drive in its usual size";
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

}  // namespace tread::gap
