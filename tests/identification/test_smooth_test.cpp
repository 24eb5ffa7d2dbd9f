// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>

#include "core_rig.hpp"
#include "modules/identification/core/adequacy.hpp"
#include "modules/identification/core/smooth_test.hpp"

// Functions of all conditions together that are in no list of variables.

using namespace tread;
using namespace tread::gap;
using samples::blockNoise;
using samples::Rig;

namespace {

const Variable& inputNamed(const std::vector<Variable>& inputs, const std::string& name) {
  return *std::find_if(inputs.begin(), inputs.end(),
                       [&name](const Variable& input) { return input.name == name; });
}

/// Noise plus, along, a wave over the pitch.
Eigen::VectorXd wavedNoise(const Rig& rig, uint64_t seed, double size) {
  const std::vector<Variable> inputs = inputsOf(rig.data, syntheticVehicle());
  const Eigen::VectorXd& pitch = inputNamed(inputs, "pitch").values;
  Eigen::VectorXd residuals = blockNoise(rig.data, seed, 0.1);
  for (size_t i = 0; i < rig.data.all().size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (rig.data.all()[i].channel == ObservedRate::kAlong)
      residuals[at] += size * std::cos(17.0 * pitch[at]);
  }
  return residuals;
}

}  // namespace

TEST_CASE("a wave over a condition, which no variable follows, is found and named by it") {
  const Rig rig({}, 400.0, 3);
  const FitState state = rig.stateOf(wavedNoise(rig, 3, 1.0), 1.0);
  const std::vector<SmoothRest> rests =
      smoothRests(rig.fitter, state, inputsOf(rig.data, state.model), {}, 0.005, 3);
  REQUIRE(rests.size() == 3);
  for (const SmoothRest& rest : rests) {
    const bool along = rest.channels.front() == ObservedRate::kAlong;
    CHECK((rest.p_value <= 0.005) == along);
    REQUIRE(rest.variable == (along ? "pitch" : ""));
  }
  // The fitted function follows the wave where it is, and is zero elsewhere.
  const Eigen::VectorXd& fitted = rests[1].function;
  const Eigen::VectorXd wave = wavedNoise(rig, 3, 1.0) - wavedNoise(rig, 3, 0.0);
  CHECK(fitted.dot(wave) > 0.7 * fitted.norm() * wave.norm());
  for (size_t i = 0; i < rig.data.all().size(); ++i)
    if (rig.data.all()[i].channel != ObservedRate::kAlong)
      REQUIRE(fitted[static_cast<Eigen::Index>(i)] == 0.0);
}

TEST_CASE("a condition that is constant or was not measured is never named") {
  const Rig rig({}, 400.0, 3);
  Eigen::VectorXd residuals = blockNoise(rig.data, 3, 0.1);
  std::vector<Variable> inputs = inputsOf(rig.data, syntheticVehicle());
  // The residual is proportional to the speed: functions with a constant represent it, too.
  for (size_t i = 0; i < rig.data.all().size(); ++i)
    if (rig.data.all()[i].channel == ObservedRate::kAlong)
      residuals[static_cast<Eigen::Index>(i)] += inputs[0].values[static_cast<Eigen::Index>(i)];
  for (Variable& input : inputs)
    if (input.name == "voltage drop" || input.name == "pitch" || input.name == "roll")
      input.values.setConstant(0.3);
  for (uint64_t seed = 1; seed <= 5; ++seed)
    for (const SmoothRest& rest :
         smoothRests(rig.fitter, rig.stateOf(residuals, 1.0), inputs, {}, 0.005, seed)) {
      CHECK(rest.variable != "voltage drop");
      CHECK(rest.variable != "pitch");
      CHECK(rest.variable != "roll");
    }
}

TEST_CASE("the adequacy test tells of a function without a variable by its condition") {
  const Rig rig({}, 400.0, 3);
  const Adequacy adequacy =
      testAdequacy(rig.fitter, rig.stateOf(wavedNoise(rig, 3, 1.0), 1.0), 0.01, 3);
  CHECK(adequacy.p_value <= 0.01);
  REQUIRE(adequacy.unexplained.size() == 1);
  CHECK(adequacy.unexplained[0].channel == "along");
  CHECK(adequacy.unexplained[0].variable == "pitch");
}

TEST_CASE("what the free parameters can still explain is no function that is left") {
  const Rig rig({}, 400.0, 4);
  FitState state = rig.stateOf(blockNoise(rig.data, 4), 1.0);
  const std::vector<Variable> inputs = inputsOf(rig.data, state.model);
  const Eigen::VectorXd turned = inputNamed(inputs, "yaw rate").values;
  state.predicted -= 2.0 * turned;
  const auto chance = [&] {
    return smoothRests(rig.fitter, state, inputs, {}, 0.0, 4).front().p_value;
  };
  CHECK(chance() <= 0.005);
  state.free.push_back(freeParameter(state.model, "yaw_gain"));
  state.jacobian = turned;
  CHECK(chance() > 0.05);
}

TEST_CASE("the order in which channels are tested changes no bit of what is left") {
  const Rig rig({}, 300.0, 5);
  const FitState state = rig.stateOf(wavedNoise(rig, 5, 1.0), 1.0);
  const Fitter backwards(rig.data, [](size_t count, const std::function<void(size_t)>& run) {
    for (size_t i = count; i-- > 0;) run(i);
  });
  const std::vector<Variable> inputs = inputsOf(rig.data, state.model);
  const auto one = smoothRests(rig.fitter, state, inputs, {}, 0.01, 5);
  const auto other = smoothRests(backwards, state, inputs, {}, 0.01, 5);
  for (size_t i = 0; i < one.size(); ++i) {
    CHECK(one[i].p_value == other[i].p_value);
    CHECK(one[i].score == other[i].score);
    CHECK(one[i].variable == other[i].variable);
  }
}
