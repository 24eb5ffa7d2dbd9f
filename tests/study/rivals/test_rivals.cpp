// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/identification/core_rig.hpp"
#include "tests/study/rivals/rivals.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;

namespace {

/// What a method says of one parameter; 0 where it does not name it.
double valueIn(const rivals::Answer& answer, const std::string& path) {
  for (const ParameterEstimate& one : answer.parameters)
    if (one.parameter == path) return one.value;
  return 0.0;
}

}  // namespace

TEST_CASE("each rival names a large effect of a plain form, with about its size") {
  const Rig rig({{"motor_deadband.speed", 0.15}}, 400.0, 2);
  for (const auto method : {rivals::allParameters, rivals::sparseRegression})
    CHECK(valueIn(method(syntheticVehicle(), rig.drives), "motor_deadband.speed") ==
          Approx(0.15).margin(0.05));
}

TEST_CASE("the threshold of the sparse regression leaves few terms") {
  const Rig rig({{"motor_deadband.speed", 0.15}}, 400.0, 2);
  CHECK(rivals::sparseRegression(syntheticVehicle(), rig.drives).parameters.size() <= 6);
}
