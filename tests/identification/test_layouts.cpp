// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <set>

#include "foreign_car.hpp"
#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/discovery.hpp"
#include "synthetic_drive.hpp"
#include "tests/identification/core_rig.hpp"

using namespace tread;
using namespace tread::gap;

namespace {

/// Result of find with a model on a drive of its vehicle with modified numbers.
GapFinding findWith(const ModelDocument& model, const samples::Values& hidden, uint64_t seed) {
  ModelDocument truth = model;
  for (const auto& [path, value] : hidden) *findParameter(truth, path) = value;
  GapTask task;
  task.model = model;
  task.seed = seed;
  task.train.push_back(syntheticDrive(truth, 240.0, seed));
  return findGap(task, samples::kSilent);
}

void checkFound(const GapFinding& finding, GapVerdict verdict, const std::string& name,
                double size) {
  CHECK(finding.verdict == verdict);
  REQUIRE(finding.identified.effects.size() == 1);
  const FoundEffect& found = finding.identified.effects.front();
  CHECK(found.name == name);
  CHECK(found.parameters.front().low < size);
  CHECK(found.parameters.front().high > size);
}

}  // namespace

TEST_CASE("a car and a holonomic base that have not changed have no discrepancy") {
  CHECK(findWith(syntheticCar(), {}, 3).verdict == GapVerdict::kNoDiscrepancy);
  CHECK(findWith(syntheticOmni(), {}, 3).verdict == GapVerdict::kNoDiscrepancy);
}

TEST_CASE("a car's steering effects are told by name and size") {
  const auto [name, size] =
      GENERATE(table<std::string, double>({{"steering_offset.angle", 0.02},
                                           {"steering_play.play", 0.06},
                                           {"steering_rate.inverse_limit", 1.2}}));
  checkFound(findWith(syntheticCar(), {{name, size}}, 3), GapVerdict::kFound, effectOf(name), size);
}

TEST_CASE("of a holonomic base a wheel, a direction and the INS are told apart") {
  checkFound(findWith(syntheticOmni(), {{"wheel_3_loss.loss", 0.1}}, 3), GapVerdict::kFound,
             "wheel_3_loss", 0.1);
  checkFound(findWith(syntheticOmni(), {{"sideways_loss.loss", 0.1}}, 3), GapVerdict::kFound,
             "sideways_loss", 0.1);
  checkFound(findWith(syntheticOmni(), {{"ins_latency.latency", 0.15}}, 3),
             GapVerdict::kMeasurement, "ins_latency", 0.15);
}

TEST_CASE("a holonomic base that drives unlike it turns is named before a scale of its INS") {
  const GapFinding finding = findWith(syntheticOmni(), {{"position_scale.scale", 0.08}}, 3);
  checkFound(finding, GapVerdict::kAmbiguous, "translation_loss", -0.08);
  CHECK(contains(finding.identified.effects.front().group, "position_scale"));
}

TEST_CASE("a full-size car at its usual speed ends without a name") {
  GapTask task;
  task.model = syntheticCar();
  task.train.push_back(fullSizeDrive(300.0, 1));
  const GapFinding finding = findGap(task, samples::kSilent);
  CHECK(finding.verdict == GapVerdict::kCannotTell);
  CHECK(finding.reason.find("load transfer") != std::string::npos);
}

TEST_CASE("a full-size car at walking speed ends without a name", "[study]") {
  GapTask task;
  task.model = syntheticCar();
  task.model.vehicle.full_speed = 30.0;
  task.model.vehicle.wheelbase = 2.7;
  task.model.vehicle.lag = 2.0;
  task.calibrate = GENERATE(false, true);
  task.train.push_back(fullSizeDrive(400.0, 2, 8.0));
  CHECK(findGap(task, samples::kSilent).verdict == GapVerdict::kCannotTell);
}

TEST_CASE("no effect is tried of a vehicle that cannot have it") {
  for (const ModelDocument& model : {syntheticVehicle(), syntheticCar(), syntheticOmni()}) {
    const std::vector<Drive> drives{syntheticDrive(model, 60.0, 1)};
    const Observations data(drives, {});
    std::set<std::string> tried;
    for (const Candidate& candidate : candidatesFor(model, excitationOf(data, model)))
      tried.insert(candidate.effect);
    for (const std::string& name : tried) CHECK(effectNamed(name).isOf(model.vehicle.layout()));
    CHECK(tried.count("track_width") == (model.vehicle.isCar() ? 0 : 1));
    CHECK(tried.count("steering_play") == (model.vehicle.isCar() ? 1 : 0));
    CHECK(tried.count("wheel_1_loss") == (model.vehicle.isOmni() ? 1 : 0));
  }
}
