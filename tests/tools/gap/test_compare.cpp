// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/identification/core/observations.hpp"
#include "tests/identification/core_rig.hpp"
#include "tools/gap/questions.hpp"

using namespace tread;
using namespace tread::gap;
using namespace tread::gap::samples;

namespace {

/// Share of the pairs of drives of one vehicle on one ground of which compare says that they
/// differ.
double falseAlarms(const ModelDocument& vehicle, double seconds, uint64_t drives) {
  std::vector<LogFit> fits;
  for (uint64_t seed = 1; seed <= drives; ++seed)
    fits.push_back(fitLog(vehicle, syntheticDrive(vehicle, seconds, seed)));
  size_t alarms = 0;
  for (size_t i = 0; i < fits.size(); ++i)
    for (size_t j = 0; j < i; ++j) alarms += changeBetween(fits[j], fits[i]).anyMoved() ? 1 : 0;
  return static_cast<double>(alarms) / static_cast<double>(fits.size() * (fits.size() - 1) / 2);
}

}  // namespace

TEST_CASE("of a hundred pairs of equal logs at most one is said to have changed") {
  CHECK(falseAlarms(syntheticVehicle(), 400.0, 40) <= 0.01);
  CHECK(falseAlarms(syntheticVehicle(), 200.0, 24) <= 0.01);
  const ModelDocument with_effects =
      vehicleWith({{"icr_offset.offset", 0.05}, {"turn_power_limit.inverse_limit", 1.5}});
  CHECK(falseAlarms(with_effects, 240.0, 24) <= 0.01);
}

TEST_CASE("a change of the ground is said to be one") {
  const LogFit before = fitLog(syntheticVehicle(), syntheticDrive(syntheticVehicle(), 400.0, 1));
  const ModelDocument sand = vehicleWith({{"yaw_gain", 0.6}});
  const LogFit after = fitLog(syntheticVehicle(), syntheticDrive(sand, 400.0, 2));
  const LogChange change = changeBetween(before, after);
  for (const Movement& movement : change.movements)
    CHECK(change.moved(movement) == (movement.parameter == "yaw_gain"));
}

TEST_CASE("fewer blocks and more parameters want larger differences") {
  CHECK(neededSigmas(100000, 1) == Approx(3.0).epsilon(1e-3));
  CHECK(neededSigmas(10, 1) > 4.0);
  CHECK(neededSigmas(10, 8) > neededSigmas(10, 1));
  CHECK(neededSigmas(20, 4) < neededSigmas(10, 4));
  CHECK(normalQuantileOf(0.05) == Approx(kNormal975).epsilon(1e-6));
  CHECK(chanceBeyond(3.0) == Approx(0.0027).epsilon(0.01));
}

TEST_CASE("a log below ten blocks is refused in the words of find") {
  const Drive drive = syntheticDrive(syntheticVehicle(), 120.0, 1);
  CHECK_THROWS_WITH(fitLog(syntheticVehicle(), drive),
                    "synthetic: only 120 s of measured driving, too little to tell chance from "
                    "cause: drive at least 200 s");
}
