// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/identification/core/verdict.hpp"
#include "synthetic_drive.hpp"

using namespace tread;
using namespace tread::gap;

namespace {

constexpr double kAlpha = 0.01;
constexpr double kLeastGain = 0.01;

/// A finding without effects, whose model errs as much as before times a factor.
Finding findingWith(const std::vector<Estimate>& calibrated, double error_after) {
  Finding finding;
  finding.before = syntheticVehicle();
  for (const Estimate& estimate : calibrated)
    *findParameter(finding.before, estimate.parameter) = estimate.before;
  finding.identified.model = finding.before;
  for (const Estimate& estimate : calibrated)
    *findParameter(finding.identified.model, estimate.parameter) = estimate.value;
  finding.identified.calibrated = calibrated;
  finding.adequacy.p_value = 0.5;
  Gap gap;
  gap.before.position.median = gap.before.yaw.median = 1.0;
  gap.after.position.median = gap.after.yaw.median = error_after;
  finding.gap = gap;
  return finding;
}

Estimate moved(const std::string& parameter, double before, double now) {
  Estimate estimate;
  estimate.parameter = parameter;
  estimate.before = before;
  estimate.value = now;
  estimate.moved = true;
  return estimate;
}

GapVerdict judged(Finding finding) {
  judge(finding, kAlpha, kLeastGain);
  return finding.verdict;
}

}  // namespace

TEST_CASE("a term of the vehicle that moved is a finding if the end error falls with it") {
  const Estimate width = moved("track_width.widening", 0.2, 0.4);
  CHECK(judged(findingWith({width}, 0.8)) == GapVerdict::kFound);
  CHECK(judged(findingWith({width}, 1.0)) == GapVerdict::kNoDiscrepancy);
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
  Finding finding = findingWith({}, 1.0);
  finding.search.at_bound = {"battery_sag"};
  judge(finding, kAlpha, kLeastGain);
  CHECK(finding.verdict == GapVerdict::kCannotTell);
  CHECK(finding.reason == "battery_sag runs to the end of its plausible range");
}
