// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/identification/core/discovery.hpp"
#include "synthetic_drive.hpp"
#include "tests/identification/core_rig.hpp"

using namespace tread;
using namespace tread::gap;

namespace {

using samples::kSilent;

using Values = std::vector<std::pair<std::string, double>>;

/// Result of find with a model on a drive of the synthetic vehicle with modified numbers.
GapFinding findOn(const Values& hidden, const ModelDocument& model, double seconds, uint64_t seed,
                  const ParallelFor& parallel = serialFor) {
  ModelDocument truth = syntheticVehicle();
  for (const auto& [path, value] : hidden) *findParameter(truth, path) = value;
  GapTask task;
  task.model = model;
  task.seed = seed;
  task.parallel = parallel;
  task.train.push_back(syntheticDrive(truth, seconds, seed));
  return findGap(task, kSilent);
}

GapFinding findAfter(const Values& hidden, double seconds, uint64_t seed,
                     const ParallelFor& parallel = serialFor) {
  return findOn(hidden, syntheticVehicle(), seconds, seed, parallel);
}

/// The synthetic vehicle with terms of stated uncertainty.
ModelDocument sureOf(const Values& known, double deviation) {
  ModelDocument model = syntheticVehicle();
  for (const auto& [path, value] : known) {
    *findParameter(model, path) = value;
    model.covariance.parameters.push_back(path);
    model.covariance.matrix.emplace_back(known.size(), 0.0);
    model.covariance.matrix.back()[model.covariance.matrix.size() - 1] = deviation * deviation;
  }
  return model;
}

std::vector<std::string> namesIn(const GapFinding& finding) {
  std::vector<std::string> names;
  for (const FoundEffect& effect : finding.identified.effects) names.push_back(effect.name);
  return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("a drive of the model itself shows no discrepancy, and says what it would have seen") {
  const GapFinding finding = findAfter({}, 400.0, 3);
  CHECK(finding.verdict == GapVerdict::kNoDiscrepancy);
  CHECK(finding.identified.effects.empty());
  REQUIRE(!finding.search.candidates.empty());
  REQUIRE(finding.gap);
  CHECK(finding.gap->after.position.median == Approx(finding.gap->before.position.median));
}

TEST_CASE("a hidden effect of the drive is named, sized within its interval, and closes the gap") {
  const GapFinding finding = findAfter({{"motor_deadband.speed", 0.1}}, 400.0, 2);
  CHECK(finding.verdict == GapVerdict::kFound);
  REQUIRE(namesIn(finding) == Names{"motor_deadband"});
  const ParameterEstimate& speed = finding.identified.effects[0].parameters.at(0);
  CHECK(speed.value == Approx(0.1).margin(0.01));
  CHECK(speed.low < speed.value);
  CHECK(speed.value < speed.high);
  CHECK(finding.identified.model.vehicle.effects.motor_deadband == speed.value);
  REQUIRE(finding.gap);
  CHECK(finding.gap->after.position.median < 0.5 * finding.gap->before.position.median);
}

TEST_CASE("an effect of the calibrated set that the model lacks is found, not swallowed") {
  CHECK(namesIn(findAfter({{"slip_ratio.slip", 0.1}}, 400.0, 4)) == Names{"slip_ratio"});
}

TEST_CASE("what the INS does is named as the INS's") {
  const GapFinding finding = findAfter({{"lever_arm_y.offset", 0.1}}, 400.0, 5);
  CHECK(finding.verdict == GapVerdict::kMeasurement);
  CHECK(namesIn(finding) == Names{"lever_arm_y"});
  CHECK(finding.identified.model.vehicle.effects.icr_offset == 0.0);
}

TEST_CASE("what no drive can tell apart is ambiguous, with both names") {
  const GapFinding finding = findAfter({{"icr_offset.offset", 0.1}}, 400.0, 6);
  CHECK(finding.verdict == GapVerdict::kAmbiguous);
  REQUIRE(finding.identified.effects.size() == 1);
  Names both = finding.identified.effects[0].group;
  both.push_back(finding.identified.effects[0].name);
  std::sort(both.begin(), both.end());
  CHECK(both == Names{"icr_offset", "lever_arm_x"});
}

TEST_CASE("a bias of the gyro is found though it moves no pose") {
  const GapFinding finding = findAfter({{"gyro_bias.rate", 0.03}}, 400.0, 10);
  CHECK(finding.verdict == GapVerdict::kMeasurement);
  CHECK(namesIn(finding) == Names{"gyro_bias"});
}

TEST_CASE("a large effect is found in the shortest drive that counts") {
  CHECK(namesIn(findAfter({{"lever_arm_y.offset", 0.1}}, 204.0, 11)) == Names{"lever_arm_y"});
}

TEST_CASE("a term that the model was sure of and that is another now has moved") {
  const GapFinding finding = findOn({{"track_width.widening", 0.4}},
                                    sureOf({{"track_width.widening", 0.2}}, 0.004), 400.0, 12);
  CHECK(finding.verdict == GapVerdict::kFound);
  CHECK(namesIn(finding).empty());
  REQUIRE(!finding.identified.calibrated.empty());
  const ParameterEstimate& width = finding.identified.calibrated.front();
  CHECK(width.parameter == "track_width.widening");
  CHECK(width.moved);
  CHECK(width.value == Approx(0.4).margin(0.03));
}

TEST_CASE("terms that the model is sure of do not give way to what is new") {
  // If both inertias were free, together they would equal the lag.
  const Values known{{"yaw_inertia.lag", 0.05}, {"body_inertia.lag", 0.05}};
  Values hidden = known;
  hidden.emplace_back("actuator_lag.lag", 0.15);
  const GapFinding finding = findOn(hidden, sureOf(known, 0.002), 400.0, 13);
  CHECK(namesIn(finding) == Names{"actuator_lag"});
  for (const ParameterEstimate& estimate : finding.identified.calibrated) CHECK(!estimate.moved);
}

TEST_CASE("95 % intervals hold the truth about as often as they say", "[study]") {
  const Values hidden{{"motor_deadband.speed", 0.1},    {"yaw_breakaway.rate", 0.12},
                      {"track_asymmetry.share", 0.05},  {"lever_arm_y.offset", 0.1},
                      {"slope_pitch.compliance", 0.06}, {"turn_speed_loss.loss", 0.15}};
  int held = 0;
  int named = 0;
  for (uint64_t seed = 100; seed < 136; ++seed) {
    const auto& [path, value] = hidden[seed % hidden.size()];
    for (const FoundEffect& effect : findAfter({{path, value}}, 300.0, seed).identified.effects)
      for (const ParameterEstimate& estimate : effect.parameters) {
        if (estimate.parameter != path) continue;
        ++named;
        held += estimate.low <= value && value <= estimate.high;
      }
  }
  INFO(held << " of " << named);
  CHECK(named >= 32);
  CHECK(held >= 0.85 * named);
}

TEST_CASE("two hidden effects are both named") {
  Names names = namesIn(
      findAfter({{"track_asymmetry.share", 0.05}, {"centrifugal_drift.time", 0.2}}, 500.0, 7));
  std::sort(names.begin(), names.end());
  CHECK(names == Names{"centrifugal_drift", "track_asymmetry"});
}

TEST_CASE("effects that are both found do not stand in each other's place") {
  const GapFinding finding = findAfter({{"speed_saturation.inverse_limit", 1.3},
                                        {"turn_power_limit.inverse_limit", 1.5},
                                        {"turn_speed_loss.loss", 0.15}},
                                       500.0, 7);
  const Names names = namesIn(finding);
  REQUIRE(names.size() > 1);
  for (const FoundEffect& effect : finding.identified.effects)
    for (const RunnerUp& other : effect.runner_ups) {
      INFO(effect.name << " or " << other.effect);
      CHECK(std::find(names.begin(), names.end(), other.effect) == names.end());
    }
}

TEST_CASE("a drive below a minute is too short to tell chance from cause") {
  const GapFinding finding = findAfter({{"motor_deadband.speed", 0.1}}, 50.0, 8);
  CHECK(finding.verdict == GapVerdict::kCannotTell);
  CHECK(finding.reason.find("drive at least 60 s") != std::string::npos);
}

TEST_CASE("a minute names what it shows, and lists what it cannot show") {
  const GapFinding finding = findAfter({{"slip_ratio.slip", 0.15}}, 60.0, 8);
  CHECK(finding.source.brief);
  CHECK(namesIn(finding) == Names{"slip_ratio"});
  CHECK(contains(finding.identified.not_excited, "terrain_change"));
  CHECK_FALSE(contains(finding.identified.not_excited, "slip_ratio"));
  CHECK(finding.adequacy.unexplained.empty());
  CHECK(finding.identified.unnamed.empty());
  for (const ParameterEstimate& size : finding.identified.effects.front().parameters)
    CHECK((size.low < 0.15 && size.high > 0.15));
}

TEST_CASE("chance names nothing in a minute") {
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const GapFinding finding = findAfter({}, 60.0, seed);
    INFO(seed);
    CHECK(exitStatus(finding.verdict) == 0);
    CHECK(namesIn(finding).empty());
  }
}

TEST_CASE(
    "a change of the model's term in a brief drive has the effects beside it that explain it") {
  const Values known{{"right_track_loss.loss", 0.04}};
  const GapFinding finding =
      findOn({{"right_track_loss.loss", 0.04}, {"left_track_loss.loss", 0.12}},
             sureOf(known, 0.003), 60.0, 8);
  REQUIRE_FALSE(finding.identified.effects.empty());
  Names names;
  for (const FoundEffect& found : finding.identified.effects) {
    names.push_back(found.name);
    for (const RunnerUp& other : found.runner_ups) names.push_back(other.effect);
  }
  CHECK(contains(names, "left_track_loss"));
}

TEST_CASE("an effect that a brief drive shows as well as another one is named beside it") {
  const GapFinding finding = findAfter({{"yaw_pull.pull", 0.06}}, 60.0, 8);
  REQUIRE(finding.identified.effects.size() == 1);
  const FoundEffect& found = finding.identified.effects.front();
  Names names = found.group;
  names.push_back(found.name);
  for (const RunnerUp& other : found.runner_ups) names.push_back(other.effect);
  CHECK(contains(names, "yaw_pull"));
  CHECK(names.size() > 1);
}

TEST_CASE(
    "the order of work that may run at the same time does not change a bit of what is found") {
  const GapFinding one = findAfter({{"yaw_pull.pull", 0.06}}, 300.0, 9);
  const auto backwards = [](size_t count, const std::function<void(size_t)>& body) {
    while (count > 0) body(--count);
  };
  const GapFinding other = findAfter({{"yaw_pull.pull", 0.06}}, 300.0, 9, backwards);
  REQUIRE(namesIn(one) == namesIn(other));
  REQUIRE(!one.identified.effects.empty());
  for (size_t i = 0; i < one.identified.effects[0].parameters.size(); ++i) {
    CHECK(one.identified.effects[0].parameters[i].value ==
          other.identified.effects[0].parameters[i].value);
    CHECK(one.identified.effects[0].parameters[i].low ==
          other.identified.effects[0].parameters[i].low);
  }
  CHECK(one.gap->after.yaw.rms == other.gap->after.yaw.rms);
}

TEST_CASE("a limit that is given higher than the drive goes, and is lower, is what has moved") {
  ModelDocument model = syntheticVehicle();
  model.vehicle.effects.speed_saturation = 1.0 / 1.6;
  for (const uint64_t seed : {11U, 12U}) {
    const GapFinding finding =
        findOn({{"speed_saturation.inverse_limit", 1.0 / 0.7}}, model, 400.0, seed);
    CHECK(finding.verdict == GapVerdict::kFound);
    CHECK(namesIn(finding).empty());
    int limits = 0;
    for (const ParameterEstimate& estimate : finding.identified.calibrated) {
      if (estimate.parameter != "speed_saturation.inverse_limit") continue;
      ++limits;
      CHECK(estimate.moved);
      CHECK(estimate.value == Approx(1.0 / 0.7).epsilon(0.03));
      CHECK(estimate.before == Approx(1.0 / 1.6));
    }
    CHECK(limits == 1);
  }
}

TEST_CASE("a term that the drive does not feel stays as it is and has no interval") {
  ModelDocument model = syntheticVehicle();
  model.vehicle.effects.speed_saturation = 1.0 / 3.0;
  model.vehicle.effects.grip_limit = 1.0 / 2.0;
  const GapFinding finding = findOn({}, model, 400.0, 14);
  CHECK(finding.verdict == GapVerdict::kNoDiscrepancy);
  int terms = 0;
  for (const ParameterEstimate& estimate : finding.identified.calibrated) {
    if (estimate.parameter.find("limit") == std::string::npos) continue;
    ++terms;
    CHECK(std::isinf(estimate.low));
    CHECK(std::isinf(estimate.high));
    CHECK_FALSE(estimate.moved);
    CHECK(estimate.value == estimate.before);
  }
  CHECK(terms == 2);
}
