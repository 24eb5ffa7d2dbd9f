// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <random>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "common/vehicle/kernel.hpp"

using namespace tread;

TEST_CASE("The motion follows the equations of the calibration") {
  VehicleModel model;
  model.kind = CommandKind::kTrackSpeed;
  model.gauge = 0.6;
  model.forward_gain = 0.9541;
  model.yaw_gain = 0.8885;
  model.effects.icr_offset = -0.0465;
  model.effects.yaw_rate_offset = 0.0102;
  model.effects.crab = 0.0442;
  const ExecutionNoise noise{1.01, 0.97, -0.02};
  const double v = 0.9541 * 1.01 * (0.6 + 1.1) / 2.0;
  const double omega = 0.8885 * 0.97 * (1.1 - 0.6) / 0.6 + 0.0102;
  const Twist2 twist = VehicleKernel(model, steadyEntry(model, {0.6, 1.1}), noise).twist();
  CHECK(twist.v_x == Approx(v));
  CHECK(twist.omega == Approx(omega));
  CHECK(twist.v_y == Approx(v * std::tan(0.0442 - 0.02) + 0.0465 * omega));
}

TEST_CASE("Noise has the spread that it is given") {
  std::mt19937_64 random(7);
  const ExecutionSpread spread{0.044, 0.122, 0.025};
  constexpr int kDraws = 20000;
  double sum[3] = {};
  double square[3] = {};
  for (int i = 0; i < kDraws; ++i) {
    const ExecutionNoise noise = drawNoise(spread, random);
    const double off[3] = {noise.forward - 1.0, noise.yaw - 1.0, noise.crab};
    for (int j = 0; j < 3; ++j) {
      sum[j] += off[j];
      square[j] += off[j] * off[j];
    }
  }
  const double expected[3] = {spread.forward, spread.yaw, spread.crab};
  for (int j = 0; j < 3; ++j) {
    CHECK(std::abs(sum[j] / kDraws) < 0.03 * expected[j]);
    CHECK(std::sqrt(square[j] / kDraws) == Approx(expected[j]).epsilon(0.02));
  }
}

TEST_CASE("The same seed draws the same noise, another seed other noise") {
  std::mt19937_64 first(3);
  std::mt19937_64 second(3);
  std::mt19937_64 other(4);
  const ExecutionSpread spread{0.1, 0.1, 0.1};
  for (int i = 0; i < 10; ++i) {
    const ExecutionNoise a = drawNoise(spread, first);
    const ExecutionNoise b = drawNoise(spread, second);
    const ExecutionNoise c = drawNoise(spread, other);
    CHECK((a.forward == b.forward && a.yaw == b.yaw && a.crab == b.crab));
    CHECK((a.forward != c.forward && a.yaw != c.yaw && a.crab != c.crab));
  }
}

TEST_CASE("Without spread every execution is the mean one") {
  std::mt19937_64 random(1);
  const ExecutionNoise noise = drawNoise({}, random);
  CHECK(noise.forward == 1.0);
  CHECK(noise.yaw == 1.0);
  CHECK(noise.crab == 0.0);
}
