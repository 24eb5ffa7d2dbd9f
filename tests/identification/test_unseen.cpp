// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/end_errors.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;

namespace {

/// Distance of measured and predicted pose at a point of an overlay [m].
double apart(const Overlay& overlay, size_t point) {
  return (overlay.measured[point].position() - overlay.after[point].position()).norm();
}

ShownExecutions shownOf(const Rig& rig, size_t least_executions, const ModelDocument& model) {
  const FitState state = rig.fitter.start(model, {});
  const Noise noise = estimateNoise(rig.data.all(), rig.data.residuals(state.predicted),
                                    activityOf(rig.data.all(), state.predicted), rig.fitter.mask());
  Unseen unseen{&rig.data, model, endErrors(rig.data, model), 2};
  if (unseen.errors.size() > least_executions) unseen.errors.resize(least_executions);
  return shownExecutions({unseen}, syntheticVehicle(), noise);
}

}  // namespace

TEST_CASE("six typical executions and the three worst have a band that grows along the path") {
  const Rig rig({{"motor_deadband.speed", 0.1}}, 300.0, 1);
  const ModelDocument truth = samples::vehicleWith({{"motor_deadband.speed", 0.1}});
  const ShownExecutions shown = shownOf(rig, 1000, truth);
  REQUIRE(shown.overlays.size() == 9);
  CHECK(shown.places.size() == endErrors(rig.data, truth).size());
  int within = 0;
  for (size_t i = 0; i < 9; ++i) {
    const Overlay& overlay = shown.overlays[i];
    CHECK(overlay.drive == 2);
    REQUIRE(overlay.band.size() == overlay.after.size());
    CHECK(overlay.band.front() == 0.0);
    CHECK(overlay.band.back() > 0.5 * overlay.band[10]);
    within += i < 6 && apart(overlay, 20) <= overlay.band.back();
  }
  CHECK(within >= 5);
  CHECK(shown.overlays[5].error_after < shown.overlays[6].error_after);
  CHECK(shown.overlays[6].error_after >= shown.overlays[8].error_after);
}

TEST_CASE("too few executions have no band") {
  const Rig rig({}, 200.0, 1);
  const ShownExecutions shown = shownOf(rig, 12, syntheticVehicle());
  REQUIRE(shown.overlays.size() == 9);
  for (const Overlay& overlay : shown.overlays) CHECK(overlay.band.empty());
  CHECK(shownOf(rig, 0, syntheticVehicle()).overlays.empty());
}

TEST_CASE("executions that are shown are those of the headline's errors, by models without them") {
  GapTask task;
  task.model = syntheticVehicle();
  task.train.push_back(syntheticDrive(syntheticVehicle(), 240.0, 3));
  const Progress silent = [](const std::string&) {};
  const GapFinding nested = findGap(task, silent);
  CHECK(nested.shown.overlays.size() == 9);
  CHECK(nested.shown.places.size() == nested.gap->after.executions);
  task.test.push_back(syntheticDrive(syntheticVehicle(), 60.0, 4));
  const GapFinding tested = findGap(task, silent);
  CHECK(tested.shown.places.size() == tested.gap->after.executions);
  for (const PlaceError& place : tested.shown.places) CHECK(place.drive == 1);
}
