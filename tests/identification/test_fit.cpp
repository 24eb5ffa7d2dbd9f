// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <stdexcept>
#include <thread>

#include "core_rig.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;
using samples::vehicleWith;

namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

/// An INS without errors.
SyntheticNoise noNoise() {
  SyntheticNoise noise;
  noise.gyro = noise.fix = noise.heading = noise.ground = 0.0;
  return noise;
}

/// Runs each body in its own thread, all at the same time.
void threadedFor(size_t count, const std::function<void(size_t)>& body) {
  std::vector<std::thread> threads;
  for (size_t i = 0; i < count; ++i) threads.emplace_back([&body, i] { body(i); });
  for (std::thread& thread : threads) thread.join();
}

void backwardsFor(size_t count, const std::function<void(size_t)>& body) {
  while (count > 0) body(--count);
}

}  // namespace

TEST_CASE("a path that names no parameter is refused, the numbers of a model are none") {
  const ModelDocument model = syntheticVehicle();
  for (const char* path : {"", "slip", "slip_ratio", "slip_ratio.width", "no_effect.size", "lag."})
    CHECK_THROWS_AS(freeParameter(model, path), std::out_of_range);
  for (const char* path : {"lag", "delay", "gauge", "full_speed", "forward_gain", "yaw_gain"}) {
    const FreeParameter free = freeParameter(model, path);
    CHECK(free.path == path);
    CHECK(free.min < free.max);
    CHECK(free.step > 0.0);
    CHECK(free.deviation == kNothing);
  }
}

TEST_CASE("every parameter of the catalogue is free within its bounds, or within the model's") {
  ModelDocument model = syntheticVehicle();
  for (const Effect& effect : effectCatalogue())
    for (const EffectParameter& known : effect.parameters) {
      const FreeParameter free = freeParameter(model, effect.name + "." + known.name);
      INFO(free.path);
      CHECK(free.min >= known.min);
      CHECK(free.max <= known.max);
      if (known.role == ParameterRole::kStrength || known.fitted) CHECK(free.step > 0.0);
      CHECK(free.expected == *findParameter(model, free.path));
    }
  model.bounds.push_back({"slip_ratio.slip", 0.01, 0.02});
  CHECK(freeParameter(model, "slip_ratio.slip").min == 0.01);
  CHECK(freeParameter(model, "slip_ratio.slip").max == 0.02);
}

TEST_CASE("what is known of a parameter counts with one over its variance, nothing known with 0") {
  FitState state;
  state.free.resize(3);
  state.free[0].deviation = 0.1;
  state.free[1].deviation = 4.0;
  const Eigen::MatrixXd precision = priorPrecision(state);
  CHECK(precision(0, 0) == Approx(100.0));
  CHECK(precision(1, 1) == Approx(1.0 / 16.0));
  CHECK(precision.row(2).isZero());
  CHECK(precision(0, 1) == 0.0);
  CHECK(priorPrecision(FitState{}).size() == 0);
}

TEST_CASE("two numbers that a model knows together are held together, each alone may move more") {
  FitState state;
  state.free = {freeParameter(state.model, "delay"), freeParameter(state.model, "lag")};
  for (FreeParameter& one : state.free) one.deviation = 0.1;
  state.model.covariance = {{"lag", "delay"}, {{0.01, -0.0099}, {-0.0099, 0.01}}};
  const Eigen::MatrixXd precision = priorPrecision(state);
  const auto lossOf = [&](double delay, double lag) {
    const Eigen::Vector2d off(delay, lag);
    return off.dot(precision * off);
  };
  CHECK(lossOf(0.05, 0.05) > 5.0 * lossOf(0.05, -0.05));
  CHECK(lossOf(0.05, -0.05) < lossOf(0.05, 0.0));

  // A hand-written matrix must not make a negative precision.
  state.model.covariance.matrix = {{0.01, 0.5}, {0.5, 0.01}};
  const Eigen::MatrixXd held = priorPrecision(state);
  CHECK(held(0, 0) * held(1, 1) > held(0, 1) * held(0, 1));
}

TEST_CASE("a size on its bound ran there, one that is off, a time or a lag taken away did not") {
  ModelDocument model = syntheticVehicle();
  const auto at = [&model](const std::string& path, double share) {
    const FreeParameter free = freeParameter(model, path);
    *findParameter(model, path) = free.min + share * (free.max - free.min);
    return free;
  };
  CHECK(runsToBound(model, at("yaw_pull.pull", 1.0)));
  CHECK(onBound(model, at("yaw_pull.pull", 0.0)));
  CHECK(runsToBound(model, at("yaw_pull.pull", 0.0)));
  CHECK_FALSE(onBound(model, at("yaw_pull.pull", 0.9)));
  CHECK_FALSE(runsToBound(model, at("yaw_pull.pull", 0.9)));
  const FreeParameter deadband = freeParameter(model, "motor_deadband.speed");
  *findParameter(model, deadband.path) = 0.0;
  CHECK_FALSE(runsToBound(model, deadband));
  CHECK(isTime(freeParameter(model, "terrain_change.time_1")));
  CHECK(isTime(freeParameter(model, "centrifugal_drift.time")));
  CHECK_FALSE(isTime(deadband));
  CHECK_FALSE(runsToBound(model, at("terrain_change.time_1", 1.0)));
  const FreeParameter lag = at("actuator_lag.lag", 0.0);
  CHECK(onBound(model, lag));
  CHECK_FALSE(runsToBound(model, lag));
  CHECK(effectOf("slip_ratio.slip") == "slip_ratio");
  CHECK(effectOf("lag") == "lag");
}

TEST_CASE("a column of the Jacobian is the finite difference of predictions") {
  const Rig rig({}, 100.0, 1);
  FitState state = rig.fitter.start(vehicleWith({{"slip_ratio.slip", 0.05}}), {});
  for (const char* path : {"slip_ratio.slip", "yaw_pull.pull", "lag", "lever_arm_y.offset"})
    state.free.push_back(freeParameter(state.model, path));
  rig.fitter.renewJacobian(state);
  for (size_t i = 0; i < state.free.size(); ++i) {
    ModelDocument changed = state.model;
    *findParameter(changed, state.free[i].path) += state.free[i].step;
    const Eigen::VectorXd difference =
        (rig.data.predict(changed) - rig.data.predict(state.model)) / state.free[i].step;
    INFO(state.free[i].path);
    CHECK((state.jacobian.col(static_cast<Eigen::Index>(i)) - difference).norm() <
          1e-6 * difference.norm());
    CHECK(difference.norm() > 0.0);
  }
  CHECK(rig.fitter.secant(state, state.model, 0.1).norm() == 0.0);
}

TEST_CASE("a difference at the upper bound is taken inwards") {
  const Rig rig({}, 60.0, 1);
  ModelDocument model = syntheticVehicle();
  FreeParameter slip = freeParameter(model, "slip_ratio.slip");
  *findParameter(model, slip.path) = slip.max;
  FitState state = rig.fitter.start(model, {slip});
  rig.fitter.renewJacobian(state);
  ModelDocument inside = model;
  *findParameter(inside, slip.path) = slip.max - slip.step;
  const Eigen::VectorXd expected = rig.fitter.secant(state, inside, -slip.step);
  CHECK((state.jacobian.col(0) - expected).norm() < 1e-9 * expected.norm());
}

TEST_CASE("a parameter comes with its column and goes with it") {
  const Rig rig({}, 60.0, 1);
  FitState state = rig.fitter.start(syntheticVehicle(), {});
  const double loss = state.loss;
  for (const char* path : {"slip_ratio.slip", "yaw_pull.pull", "icr_offset.offset"})
    rig.fitter.add(state, freeParameter(state.model, path), 0.01);
  REQUIRE(state.jacobian.cols() == 3);
  CHECK(state.loss != loss);
  CHECK(*findParameter(state.model, "yaw_pull.pull") == 0.01);
  const Eigen::MatrixXd whole = state.jacobian;
  rig.fitter.release(state, 1);
  REQUIRE(state.free.size() == 2);
  CHECK(state.free[1].path == "icr_offset.offset");
  CHECK(state.jacobian.col(0) == whole.col(0));
  CHECK(state.jacobian.col(1) == whole.col(2));
  CHECK(*findParameter(state.model, "yaw_pull.pull") == 0.01);  // held at its value
}

TEST_CASE("without noise a fit finds the numbers that the drive was made with") {
  const samples::Values truth{
      {"slip_ratio.slip", 0.08}, {"yaw_pull.pull", 0.04}, {"lever_arm_y.offset", 0.15}};
  const Rig rig(truth, 100.0, 3, noNoise());
  FitState state = rig.fitter.start(syntheticVehicle(), {});
  for (const auto& [path, value] : truth)
    rig.fitter.add(state, freeParameter(state.model, path), 0.0);
  rig.fitter.fit(state);
  rig.fitter.renewNoise(state);
  rig.fitter.fit(state);
  for (const auto& [path, value] : truth) {
    INFO(path);
    CHECK(*findParameter(state.model, path) == Approx(value).epsilon(0.02));
  }
}

TEST_CASE(
    "a fit lowers the loss to where its slope is 0, and rows that do not count are not seen") {
  const Rig rig({{"slip_ratio.slip", 0.08}, {"yaw_pull.pull", 0.04}}, 120.0, 3);
  std::vector<char> mask;
  for (const Observation& row : rig.data.all()) mask.push_back(row.block % 2 == 0);
  const Fitter part = rig.fitter.onRows(mask);
  FitState state = part.start(syntheticVehicle(), {});
  for (const char* path : {"slip_ratio.slip", "yaw_pull.pull"})
    part.add(state, freeParameter(state.model, path), 0.0);
  const double before = state.loss;
  part.fit(state);
  CHECK(state.loss < before - 10.0);
  const auto lossAt = [&](size_t parameter, double change) {
    ModelDocument model = state.model;
    *findParameter(model, state.free[parameter].path) += change;
    return totalLoss(rig.data.residuals(rig.data.predict(model)), state.scales, mask);
  };
  CHECK(state.loss == Approx(lossAt(0, 0.0)));
  for (size_t i : {0U, 1U})
    for (double change : {-0.005, 0.005}) CHECK(lossAt(i, change) > state.loss - 0.02);
}

TEST_CASE("the normal equations are weighted sums over the rows that count") {
  const Rig rig({{"slip_ratio.slip", 0.08}}, 60.0, 3);
  const FitState state = rig.fitted({{"slip_ratio.slip", 0.0}, {"yaw_pull.pull", 0.0}});
  const Eigen::VectorXd residuals = rig.data.residuals(state.predicted);
  std::vector<char> mask;
  for (const Observation& row : rig.data.all()) mask.push_back(row.block % 2 == 0);
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Eigen::Vector2d pull = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    if (!mask[static_cast<size_t>(i)]) continue;
    const double weight = weightOf(residuals[i], state.scales[i]);
    matrix += weight * state.jacobian.row(i).transpose() * state.jacobian.row(i);
    pull += weight * residuals[i] * state.jacobian.row(i).transpose();
  }
  const Normal normal = normalOf(state, residuals, mask);
  CHECK((normal.matrix - matrix).norm() < 1e-12 * matrix.norm());
  CHECK((normal.pull - pull).norm() < 1e-9 * matrix.norm());
  CHECK(normal.matrix(0, 1) == normal.matrix(1, 0));
}

TEST_CASE("a fit stays within the bounds, and near what was known with certainty") {
  const Rig rig({{"slip_ratio.slip", 0.1}}, 100.0, 4);
  const auto fittedSlip = [&](double max, double expected, double deviation) {
    FitState state = rig.fitter.start(syntheticVehicle(), {});
    FreeParameter slip = freeParameter(state.model, "slip_ratio.slip");
    slip.max = max;
    slip.expected = expected;
    slip.deviation = deviation;
    rig.fitter.add(state, slip, 0.02);
    rig.fitter.fit(state);
    return *findParameter(state.model, "slip_ratio.slip");
  };
  CHECK(fittedSlip(0.5, 0.0, kNothing) == Approx(0.1).margin(0.02));
  CHECK(fittedSlip(0.04, 0.0, kNothing) == 0.04);
  CHECK(fittedSlip(0.5, 0.03, 1e-6) == Approx(0.03).margin(1e-4));
  const double between = fittedSlip(0.5, 0.03, 0.004);
  CHECK(between > 0.03);
  CHECK(between < fittedSlip(0.5, 0.0, kNothing));
}

TEST_CASE("a state without free parameters is fitted already") {
  const Rig rig({}, 60.0, 4);
  FitState state = rig.fitter.start(syntheticVehicle(), {});
  const double loss = state.loss;
  rig.fitter.fit(state);
  rig.fitter.fitRoughly(state);
  CHECK(state.loss == loss);
  CHECK(std::isfinite(loss));
}

TEST_CASE("columns that are made at the same time are those made one after the other, to the bit") {
  const Rig rig({}, 60.0, 4);
  FitState state = rig.fitter.start(syntheticVehicle(), {});
  for (const char* path : {"slip_ratio.slip", "yaw_pull.pull", "lag", "lever_arm_y.offset"})
    state.free.push_back(freeParameter(state.model, path));
  rig.fitter.renewJacobian(state);
  for (const ParallelFor& order : {ParallelFor(backwardsFor), ParallelFor(threadedFor)}) {
    FitState other = state;
    other.jacobian.setZero();
    Fitter(rig.data, order).renewJacobian(other);
    CHECK(other.jacobian == state.jacobian);
  }
}
