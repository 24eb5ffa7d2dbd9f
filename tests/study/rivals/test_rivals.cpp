// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/identification/core_rig.hpp"
#include "tests/study/rivals/rivals.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;

namespace {

/// A method's estimate of one parameter; NaN if it does not name it.
double valueIn(const rivals::Answer& answer, const std::string& path) {
  for (const ParameterEstimate& one : answer.parameters)
    if (one.parameter == path) return one.value;
  return kNotMeasured;
}

}  // namespace

TEST_CASE("each rival names a large effect of a plain form, with about its size") {
  const Rig rig({{"motor_deadband.speed", 0.15}}, 400.0, 2);
  for (const auto method : {rivals::allParameters, rivals::sparseRegression})
    CHECK(valueIn(method(rig.fitter, syntheticVehicle(), false), "motor_deadband.speed") ==
          Approx(0.15).margin(0.05));
}

TEST_CASE("the threshold of the sparse regression leaves few terms") {
  const Rig rig({{"motor_deadband.speed", 0.15}}, 400.0, 2);
  CHECK(rivals::sparseRegression(rig.fitter, syntheticVehicle(), false).parameters.size() <= 6);
}

TEST_CASE("a rival learns from the fitter's rows alone") {
  const std::vector<Drive> drives{
      syntheticDrive(samples::vehicleWith({{"motor_deadband.speed", 0.15}}), 300.0, 3),
      syntheticDrive(syntheticVehicle(), 300.0, 4)};
  const Observations data(drives, {});
  const auto ofDrive = [&data](size_t drive) {
    std::vector<char> mask;
    for (const Observation& row : data.all()) mask.push_back(row.drive == drive);
    return Fitter(data).onRows(mask);
  };
  for (const auto method : {rivals::allParameters, rivals::sparseRegression}) {
    CHECK(valueIn(method(ofDrive(0), syntheticVehicle(), false), "motor_deadband.speed") ==
          Approx(0.15).margin(0.03));
    CHECK(
        std::isnan(valueIn(method(ofDrive(1), syntheticVehicle(), false), "motor_deadband.speed")));
  }
}

TEST_CASE("a rival that calibrates takes wrong gains for gains, and not for effects") {
  const Rig rig({}, 400.0, 5);
  ModelDocument wrong = syntheticVehicle();
  wrong.vehicle.forward_gain *= 1.2;
  wrong.vehicle.yaw_gain *= 0.8;
  for (const auto method : {rivals::allParameters, rivals::sparseRegression}) {
    const rivals::Answer answer = method(rig.fitter, wrong, true);
    CHECK(answer.model.vehicle.forward_gain == Approx(0.95).margin(0.05));
    CHECK(answer.model.vehicle.yaw_gain == Approx(0.68).margin(0.04));
    CHECK(std::isnan(valueIn(answer, "slip_ratio.slip")));
    CHECK(std::isnan(valueIn(answer, "track_width.widening")));
  }
}
