// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <set>

#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/verdict.hpp"
#include "synthetic_drive.hpp"

using namespace tread;
using namespace tread::gap;

namespace {

constexpr double kAlpha = 0.01;
constexpr double kLeastGain = 0.01;

/// A finding without effects, whose model has the old errors times a factor.
GapFinding findingWith(const std::vector<ParameterEstimate>& calibrated, double error_after) {
  GapFinding finding;
  finding.before = syntheticVehicle();
  for (const ParameterEstimate& estimate : calibrated)
    *findParameter(finding.before, estimate.parameter) = estimate.before;
  finding.identified.model = finding.before;
  for (const ParameterEstimate& estimate : calibrated)
    *findParameter(finding.identified.model, estimate.parameter) = estimate.value;
  finding.identified.calibrated = calibrated;
  finding.adequacy.p_value = 0.5;
  Gap gap;
  gap.before.position.median = gap.before.yaw.median = 1.0;
  gap.after.position.median = gap.after.yaw.median = error_after;
  finding.gap = gap;
  return finding;
}

ParameterEstimate moved(const std::string& parameter, double before, double now) {
  ParameterEstimate estimate;
  estimate.parameter = parameter;
  estimate.before = before;
  estimate.value = now;
  estimate.moved = true;
  return estimate;
}

GapVerdict judged(GapFinding finding) {
  judge(finding, kAlpha, kLeastGain);
  return finding.verdict;
}

}  // namespace

TEST_CASE("a term of the vehicle that moved is a finding if the end error falls with it") {
  const ParameterEstimate width = moved("track_width.widening", 0.2, 0.4);
  CHECK(judged(findingWith({width}, 0.8)) == GapVerdict::kFound);
  CHECK(judged(findingWith({width}, 1.0)) == GapVerdict::kNoDiscrepancy);
}

TEST_CASE("of a vehicle that the best model is far from nothing is named") {
  GapFinding finding = findingWith({moved("track_width.widening", 0.2, 0.4)}, 0.8);
  finding.gap->way = 10.0;
  CHECK(judged(finding) == GapVerdict::kFound);
  finding.gap->way = 3.0;
  CHECK(judged(finding) == GapVerdict::kFound);  // on tracks it may be noise
  finding.identified.model.vehicle.wheelbase = 0.9;
  CHECK(judged(finding) == GapVerdict::kCannotTell);
  GapFinding rejected = finding;
  rejected.source.decisions = {{"grip_limit", false, ""}};
  CHECK(judged(rejected) == GapVerdict::kFound);
  finding.search.cut_short = true;
  CHECK(judged(finding) == GapVerdict::kPartial);
}

TEST_CASE("a term that moved is a finding if the end error would fall were the new model right") {
  GapFinding finding = findingWith({moved("track_width.widening", 0.2, 0.4)}, 1.0);
  finding.gap->apart.yaw.median = 0.1;  // of an error of 1: it would be 1.005
  CHECK(judged(finding) == GapVerdict::kNoDiscrepancy);
  finding.gap->apart.yaw.median = 0.2;
  CHECK(judged(finding) == GapVerdict::kFound);
}

TEST_CASE("a number of the nominal model that moved is a finding of the vehicle, too") {
  CHECK(judged(findingWith({moved("delay", 0.1, 0.3)}, 0.8)) == GapVerdict::kFound);
}

TEST_CASE("a term of the INS that moved counts even where executions end the same") {
  CHECK(judged(findingWith({moved("ins_latency.latency", 0.3, 0.6)}, 1.0)) ==
        GapVerdict::kMeasurement);
  CHECK(judged(findingWith({moved("ins_latency.latency", 0.3, 0.301)}, 1.0)) ==
        GapVerdict::kNoDiscrepancy);
}

TEST_CASE("what was seen but has no plausible size is not nothing") {
  GapFinding finding = findingWith({}, 1.0);
  finding.search.at_bound = {"battery_sag"};
  judge(finding, kAlpha, kLeastGain);
  CHECK(finding.verdict == GapVerdict::kCannotTell);
  CHECK(finding.reason == "battery_sag runs to the end of its plausible range");
}

namespace {

FoundEffect foundEffect(const std::string& name) {
  FoundEffect effect;
  effect.name = name;
  effect.p_value = 0.001;
  return effect;
}

/// A finding with these effects, adequate or not.
GapFinding findingOf(const std::vector<FoundEffect>& effects, double adequacy = 0.5) {
  GapFinding finding = findingWith({}, 0.5);
  finding.identified.effects = effects;
  finding.adequacy.p_value = adequacy;
  return finding;
}

}  // namespace

TEST_CASE("nothing found is no discrepancy only if nothing is left over") {
  CHECK(judged(findingOf({})) == GapVerdict::kNoDiscrepancy);
  CHECK(judged(findingOf({}, 0.001)) == GapVerdict::kNotInCatalogue);
  CHECK(judged(findingOf({}, kAlpha)) == GapVerdict::kNotInCatalogue);
}

TEST_CASE("with a known rest nothing found is nothing new, and what is left over is new") {
  GapFinding finding = findingOf({});
  finding.before.rest = {{"along", "v", 0.1, 0.01}};
  CHECK(judged(finding) == GapVerdict::kNothingNew);
  finding.adequacy.p_value = 0.001;
  CHECK(judged(finding) == GapVerdict::kNotInCatalogue);
  finding.adequacy.p_value = 0.5;
  finding.before.rest->clear();
  CHECK(judged(finding) == GapVerdict::kNoDiscrepancy);
}

TEST_CASE("a search that was cut short is partial with what it has, and cannot tell without") {
  GapFinding finding = findingOf({foundEffect("slip_ratio")});
  finding.search.cut_short = true;
  CHECK(judged(finding) == GapVerdict::kPartial);
  finding.identified.effects.clear();
  CHECK(judged(finding) == GapVerdict::kCannotTell);
  GapFinding width = findingWith({moved("track_width.widening", 0.2, 0.4)}, 0.8);
  width.search.cut_short = true;
  CHECK(judged(width) == GapVerdict::kPartial);
}

TEST_CASE("effects that leave something over are part of the answer") {
  CHECK(judged(findingOf({foundEffect("slip_ratio")}, 0.001)) == GapVerdict::kPartial);
  CHECK(judged(findingOf({foundEffect("slip_ratio")})) == GapVerdict::kFound);
  GapFinding width = findingWith({moved("track_width.widening", 0.2, 0.4)}, 0.8);
  width.adequacy.p_value = 0.001;
  CHECK(judged(width) == GapVerdict::kPartial);
}

TEST_CASE(
    "effects of the INS alone are a matter of measurement, one of the vehicle beside is not") {
  CHECK(judged(findingOf({foundEffect("gyro_bias")})) == GapVerdict::kMeasurement);
  CHECK(judged(findingOf({foundEffect("gyro_bias"), foundEffect("lever_arm_y")})) ==
        GapVerdict::kMeasurement);
  CHECK(judged(findingOf({foundEffect("gyro_bias"), foundEffect("slip_ratio")})) ==
        GapVerdict::kFound);
  GapFinding with_width = findingWith({moved("track_width.widening", 0.2, 0.4)}, 0.8);
  with_width.identified.effects = {foundEffect("gyro_bias")};
  CHECK(judged(with_width) == GapVerdict::kFound);
}

TEST_CASE("an effect that has its like is ambiguous: of its group, or within the error behind it") {
  FoundEffect group = foundEffect("icr_offset");
  group.group = {"lever_arm_x"};
  CHECK(judged(findingOf({group})) == GapVerdict::kAmbiguous);
  CHECK(judged(findingOf({foundEffect("slip_ratio"), group})) == GapVerdict::kAmbiguous);
  FoundEffect close = foundEffect("slip_ratio");
  close.runner_ups = {{"track_width", 20.0, 5.0}, {"quadratic_drag", 4.0, 5.0}};
  CHECK(judged(findingOf({close})) == GapVerdict::kAmbiguous);
  close.runner_ups.pop_back();
  CHECK(judged(findingOf({close})) == GapVerdict::kFound);
  CHECK(judged(findingOf({group}, 0.001)) == GapVerdict::kPartial);
}

TEST_CASE("what a person accepted and no test shows makes no verdict") {
  FoundEffect accepted = foundEffect("yaw_pull");
  accepted.accepted = true;
  CHECK(isShown(accepted));
  accepted.p_value = 0.5;
  CHECK_FALSE(isShown(accepted));
  CHECK(judged(findingOf({accepted})) == GapVerdict::kNoDiscrepancy);
  CHECK(judged(findingOf({accepted, foundEffect("slip_ratio")})) == GapVerdict::kFound);
  accepted.accepted = false;
  CHECK(isShown(accepted));
}

TEST_CASE("a size at the end of its range tells nothing, and says of which parameter") {
  GapFinding finding = findingOf({foundEffect("slip_ratio")});
  const double most = freeParameter(finding.before, "slip_ratio.slip").max;
  ParameterEstimate slip;
  slip.parameter = "slip_ratio.slip";
  slip.value = most;
  finding.identified.effects[0].parameters = {slip};
  finding.identified.model.vehicle.effects.slip_ratio = most;
  judge(finding, kAlpha, kLeastGain);
  CHECK(finding.verdict == GapVerdict::kCannotTell);
  CHECK(finding.reason == "slip_ratio.slip runs to the end of its plausible range");
  finding.identified.model.vehicle.effects.slip_ratio = 0.5 * most;
  finding.reason.clear();
  judge(finding, kAlpha, kLeastGain);
  CHECK(finding.verdict == GapVerdict::kFound);
  CHECK(finding.reason.empty());
}

TEST_CASE("every verdict has a name of its own, and 0 or an exit status of its own") {
  std::set<std::string> names;
  std::set<int> statuses;
  for (const GapVerdict verdict :
       {GapVerdict::kNoDiscrepancy, GapVerdict::kNothingNew, GapVerdict::kFound,
        GapVerdict::kAmbiguous, GapVerdict::kPartial, GapVerdict::kNotInCatalogue,
        GapVerdict::kMeasurement, GapVerdict::kCannotTell}) {
    CHECK(names.insert(verdictName(verdict)).second);
    const int status = exitStatus(verdict);
    CHECK((status == 0 || (status >= 10 && status <= 15 && statuses.insert(status).second)));
  }
}
