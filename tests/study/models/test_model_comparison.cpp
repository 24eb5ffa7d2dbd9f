// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/identification/synthetic_drive.hpp"
#include "tests/study/models/comparison_output.hpp"
#include "tests/study/models/model_comparison.hpp"
#include "tests/study/models/twist_dictionary.hpp"

using namespace tread;
using namespace tread::gap;

namespace {

using Hidden = std::vector<std::pair<std::string, double>>;

const Progress kSilent = [](const std::string&) {};

/// The synthetic vehicle according to its data sheet.
ModelDocument idealVehicle() {
  ModelDocument model = syntheticVehicle();
  model.vehicle.lag = 0.0;
  model.vehicle.forward_gain = 1.0;
  model.vehicle.yaw_gain = 1.0;
  return model;
}

ModelDocument with(ModelDocument model, const Hidden& hidden) {
  for (const auto& [path, value] : hidden) *findParameter(model, path) = value;
  return model;
}

ComparisonLog logOf(const ModelDocument& truth, double seconds, uint64_t seed) {
  ComparisonLog log{syntheticDrive(truth, seconds, seed), idealVehicle()};
  log.drive.name = "drive " + std::to_string(seed);
  return log;
}

ComparisonRow rowOf(const ModelDocument& truth, double seconds, uint64_t seed) {
  ComparisonTask task;
  task.logs.push_back(logOf(truth, seconds, seed));
  return compareOnLogs(task, kSilent).nested.at(0);
}

const EndErrors& errorsOf(const ComparisonRow& row, Rung rung) {
  const auto& errors = row.errors[static_cast<size_t>(rung)];
  REQUIRE(errors);
  return *errors;
}

/// Error of the true model: only noise.
EndErrors leastOf(const ModelDocument& truth, double seconds, uint64_t seed) {
  const std::vector<Drive> drives{syntheticDrive(truth, seconds, seed)};
  const Observations data(drives, {});
  return summaryOf(endErrors(data, truth));
}

ExecutionError errorAt(int block, double yaw) {
  ExecutionError error;
  error.block = block;
  error.yaw = yaw;
  return error;
}

}  // namespace

TEST_CASE("a regression that corrects nothing leaves the kernel's simulation as it is") {
  const std::vector<Drive> drives{syntheticDrive(syntheticVehicle(), 60.0, 1)};
  const Observations data(drives, {});
  TwistRegression regression;
  regression.terms = blackBoxTerms();
  regression.coefficients =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(regression.terms.size()));
  const VehicleModel vehicle = syntheticVehicle().vehicle;
  const auto plain = data.simulate(vehicle);
  const auto same = simulateCorrected(data, vehicle, regression);
  REQUIRE(same.size() == plain.size());
  REQUIRE(same[0].size() == plain[0].size());
  for (size_t i = 0; i < plain[0].size(); ++i) {
    CHECK(same[0][i].time == Approx(plain[0][i].time));
    CHECK(same[0][i].T_map_body.x == Approx(plain[0][i].T_map_body.x).margin(1e-9));
    CHECK(same[0][i].T_map_body.yaw == Approx(plain[0][i].T_map_body.yaw).margin(1e-9));
  }
}

TEST_CASE("a slip regression finds drift and pull, with their sizes") {
  const ModelDocument truth =
      with(syntheticVehicle(), {{"centrifugal_drift.time", 0.2}, {"yaw_pull.pull", 0.06}});
  const std::vector<Drive> drives{syntheticDrive(truth, 400.0, 2)};
  const Observations data(drives, {});
  const Fitter fitter(data);
  const TwistRegression found = fitRegression(fitter, syntheticVehicle(), slipTerms(), {});
  REQUIRE(found.terms[1].name == "v omega");
  CHECK(found.coefficients[1] == Approx(-0.2).margin(0.02));
  REQUIRE(found.terms[3].name == "v");
  CHECK(found.coefficients[3] == Approx(0.06).margin(0.015));
  CHECK(found.coefficients[0] == Approx(0.0).margin(0.02));
}

TEST_CASE("the standard error of a difference counts blocks, not executions") {
  std::vector<ExecutionError> first;
  std::vector<ExecutionError> second;
  for (int block : {0, 1, 2, 3})
    for (int i = 0; i < 5; ++i) {
      first.push_back(errorAt(block, 1.0));
      second.push_back(errorAt(block, block % 2 == 0 ? 1.5 : 1.1));
    }
  const MeanDifference yaw = differenceOf(first, second).yaw;
  CHECK(yaw.mean == Approx(0.3));
  // Four blocks of +-0.2: 0.2 sqrt(4 / 3) / sqrt(4); as twenty executions it would be 0.046.
  CHECK(yaw.error == Approx(0.11547).epsilon(1e-3));
}

TEST_CASE("gain and track are all that a vehicle without lag needs") {
  const ModelDocument truth =
      with(idealVehicle(),
           {{"slip_ratio.slip", 0.1}, {"track_width.widening", 0.4}, {"ins_latency.latency", 0.2}});
  const ComparisonRow row = rowOf(truth, 240.0, 3);
  const EndErrors least = leastOf(truth, 240.0, 3);
  CHECK(errorsOf(row, Rung::kIdeal).yaw.median > 2.0 * least.yaw.median);
  for (Rung rung : {Rung::kGains, Rung::kPowertrain, Rung::kSlipRegression}) {
    INFO(rungName(rung));
    CHECK(errorsOf(row, rung).yaw.rms < 1.15 * least.yaw.rms);
    CHECK(errorsOf(row, rung).position.rms < 1.15 * least.position.rms);
  }
  // A hundred terms for two minutes of driving cost accuracy, but not much.
  CHECK(errorsOf(row, Rung::kBlackBox).yaw.rms < 1.3 * least.yaw.rms);
  CHECK(errorsOf(row, Rung::kBlackBox).position.rms < 1.3 * least.position.rms);
}

TEST_CASE("a powertrain is reached by the rung that has one, and not by the one before") {
  const ModelDocument truth = with(syntheticVehicle(), {{"command_delay.delay", 0.15},
                                                        {"actuator_lag.lag", 0.2},
                                                        {"speed_saturation.inverse_limit", 1.5},
                                                        {"track_asymmetry.share", 0.05},
                                                        {"icr_offset.offset", 0.1}});
  const ComparisonRow row = rowOf(truth, 320.0, 4);
  const EndErrors least = leastOf(truth, 320.0, 4);
  CHECK(errorsOf(row, Rung::kGains).yaw.rms > 1.5 * least.yaw.rms);
  CHECK(errorsOf(row, Rung::kPowertrain).yaw.rms < 1.1 * least.yaw.rms);
  CHECK(errorsOf(row, Rung::kPowertrain).position.rms < 1.1 * least.position.rms);
  CHECK(errorsOf(row, Rung::kBlackBox).yaw.rms < 1.2 * least.yaw.rms);
}

TEST_CASE("a drift is reached by slip regression and discovery, which is never behind", "[study]") {
  const ModelDocument truth =
      with(syntheticVehicle(), {{"centrifugal_drift.time", 0.25}, {"yaw_breakaway.rate", 0.1}});
  const ComparisonRow row = rowOf(truth, 440.0, 5);
  const EndErrors least = leastOf(truth, 440.0, 5);
  CHECK(row.structure_nested);
  CHECK(errorsOf(row, Rung::kPowertrain).position.rms > 1.2 * least.position.rms);
  CHECK(errorsOf(row, Rung::kSlipRegression).position.rms <
        errorsOf(row, Rung::kPowertrain).position.rms);
  CHECK(errorsOf(row, Rung::kDiscovered).position.rms < 1.1 * least.position.rms);
  CHECK(errorsOf(row, Rung::kDiscovered).yaw.rms < 1.1 * least.yaw.rms);
  // Few terms cost nothing; forty, most of them superfluous, cost a little on other driving.
  CHECK(errorsOf(row, Rung::kSparse).position.rms < 1.1 * least.position.rms);
  CHECK(errorsOf(row, Rung::kSparse).yaw.rms < 1.1 * least.yaw.rms);
  CHECK(errorsOf(row, Rung::kAllParameters).position.rms < 1.5 * least.position.rms);
  CHECK(errorsOf(row, Rung::kAllParameters).position.rms >
        errorsOf(row, Rung::kSparse).position.rms);
  for (Rung rung : {Rung::kPowertrain, Rung::kSlipRegression, Rung::kBlackBox}) {
    INFO(rungName(rung));
    const auto& behind = row.behind[static_cast<size_t>(rung)];
    REQUIRE(behind);
    CHECK(behind->yaw.mean < 2.0 * behind->yaw.error);
    CHECK(behind->position.mean < 2.0 * behind->position.error);
  }
  for (const ComparisonFold& fold : row.folds) {
    const auto& names = fold.models[static_cast<size_t>(Rung::kDiscovered)]->effects;
    CHECK(std::count(names.begin(), names.end(), "centrifugal_drift") == 1);
  }
}

TEST_CASE("a size that runs to the end of what is plausible is told beside the errors") {
  ComparisonTask task;
  task.logs.push_back(logOf(with(syntheticVehicle(), {{"motor_deadband.speed", 0.15}}), 240.0, 10));
  task.logs[0].ideal.bounds.push_back({"motor_deadband.speed", 0.0, 0.05});
  const ComparisonReport report{compareOnLogs(task, kSilent), "", {"a"}};
  const ComparisonRow& row = report.comparison.nested.at(0);
  for (const ComparisonFold& fold : row.folds) {
    const auto& ends = fold.models[static_cast<size_t>(Rung::kAllParameters)]->at_end;
    CHECK(std::count(ends.begin(), ends.end(), "motor_deadband.speed") == 1);
  }
  CHECK(std::isfinite(errorsOf(row, Rung::kAllParameters).position.rms));
  const std::string text = comparisonText(report);
  const size_t told = text.find("Implausible sizes");
  REQUIRE(told != std::string::npos);
  CHECK(text.find("motor_deadband.speed", told) != std::string::npos);
}

TEST_CASE("a black box expresses what neither slip nor powertrain do") {
  const ModelDocument truth = with(
      syntheticVehicle(), {{"turn_power_limit.inverse_limit", 2.0}, {"turn_speed_loss.loss", 0.3}});
  const ComparisonRow row = rowOf(truth, 380.0, 6);
  CHECK(errorsOf(row, Rung::kBlackBox).yaw.rms <
        0.8 * errorsOf(row, Rung::kSlipRegression).yaw.rms);
  CHECK_FALSE(row.structure_nested);
}

TEST_CASE(
    "pooled logs name the same effect in all folds, and the bytes do not know the order of the "
    "work",
    "[study]") {
  const ModelDocument truth = with(syntheticVehicle(), {{"yaw_pull.pull", 0.08}});
  ComparisonTask task;
  task.pool = true;
  for (uint64_t seed : {7, 8}) task.logs.push_back(logOf(truth, 220.0, seed));
  ComparisonReport one{compareOnLogs(task, kSilent), "", {"a", "b"}};
  task.parallel = [](size_t count, const std::function<void(size_t)>& body) {
    while (count > 0) body(--count);
  };
  ComparisonReport two{compareOnLogs(task, kSilent), "", {"a", "b"}};
  CHECK(comparisonJson(one).dump() == comparisonJson(two).dump());
  CHECK(comparisonText(one) == comparisonText(two));
  REQUIRE(one.comparison.pooled.size() == 2);
  for (const ComparisonRow& row : one.comparison.pooled) {
    REQUIRE(row.folds.size() == 1);
    const auto& names = row.folds[0].models[static_cast<size_t>(Rung::kDiscovered)]->effects;
    CHECK(std::count(names.begin(), names.end(), "yaw_pull") == 1);
  }
  CHECK(comparisonText(one).find("Named in all 2 folds: yaw_pull") != std::string::npos);
}

TEST_CASE("a log that is too short has no rungs, and the reason stands there") {
  const ComparisonRow row = rowOf(syntheticVehicle(), 40.0, 9);
  CHECK(row.remark ==
        "only 40 s of measured driving, too little to tell chance from cause: drive at least "
        "200 s");
  for (const auto& errors : row.errors) CHECK_FALSE(errors);
}
