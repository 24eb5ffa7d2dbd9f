// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/identification/core/observations.hpp"
#include "tests/identification/core_rig.hpp"
#include "tools/lab/gap/compare.hpp"
#include "tools/lab/gap/repeat.hpp"
#include "tools/lab/gap/what_if.hpp"

using namespace tread;
using namespace tread::gap;
using namespace tread::gap::samples;

namespace {

/// Share of pairs of drives of one vehicle on one ground that compare reports as different.
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

TEST_CASE("of a hundred pairs of equal logs at most one is said to have changed", "[study]") {
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

TEST_CASE("what several logs share is the vehicle's, what differs is the day's") {
  GapTask task;
  task.model = syntheticVehicle();
  const double slips[] = {0.04, 0.16};
  for (uint64_t day = 0; day < 2; ++day) {
    const ModelDocument truth =
        vehicleWith({{"motor_deadband.speed", 0.1}, {"slip_ratio.slip", slips[day]}});
    task.train.push_back(syntheticDrive(truth, 400.0, 20 + day));
    task.train.back().name = "day" + std::to_string(day + 1);
  }
  const Repetition repetition = repeatLogs(task, kSilent);
  CHECK(repetition.logsThatName("motor_deadband") == 2);
  CHECK(repetition.differs());
  REQUIRE(!repetition.parameters.empty());
  bool deadband = false;
  for (const RepeatedParameter& parameter : repetition.parameters) {
    CAPTURE(parameter.parameter, parameter.values[0], parameter.values[1], parameter.farthest);
    if (parameter.parameter != "motor_deadband.speed") continue;
    deadband = true;
    CHECK_FALSE(parameter.differs);
    CHECK(parameter.common == Approx(0.1).margin(0.01));
  }
  CHECK(deadband);
  for (size_t day = 0; day < 2; ++day) {
    const ModelDocument model = repetition.modelOf(day);
    CHECK(model.vehicle.effects.motor_deadband == Approx(0.1).margin(0.015));
    const double slip = model.vehicle.effects.slip_ratio;
    CHECK((1.0 - slip) * model.vehicle.forward_gain ==
          Approx((1.0 - slips[day]) * task.model.vehicle.forward_gain).epsilon(0.03));
  }
  CHECK(textOf(repetition).find("the day's") != std::string::npos);
  CHECK(textOf(repetition).find("motor_deadband           named in 2 of 2 logs") == 0);
  task.train.push_back(syntheticDrive(syntheticVehicle(), 120.0, 1));
  CHECK_THROWS_WITH(repeatLogs(task, kSilent), Catch::StartsWith("synthetic: only 120 s"));
  task.train.resize(1);
  CHECK_THROWS_WITH(repeatLogs(task, kSilent), "repeat: one log is not enough; give two or more");
}

TEST_CASE("logs of which one is frozen midway repeat nothing, and say which") {
  GapTask task;
  task.model = syntheticVehicle();
  for (uint64_t day = 0; day < 2; ++day) {
    task.train.push_back(syntheticDrive(task.model, 200.0, 40 + day));
    task.train.back().name = "day" + std::to_string(day + 1);
  }
  task.train[1].notes.push_back({"day2", "the INS is frozen", findings::kInsFrozen});
  task.log_notes = task.train[1].notes;
  const Repetition repetition = repeatLogs(task, kSilent);
  CHECK(repetition.alone[0].verdict == GapVerdict::kNoDiscrepancy);
  CHECK(repetition.alone[1].verdict == GapVerdict::kCannotTell);
  CHECK(repetition.together.verdict == GapVerdict::kCannotTell);
  CHECK(textOf(repetition).find("All together: CANNOT_TELL: day2: the INS is frozen.") !=
        std::string::npos);
}

TEST_CASE("logs of one vehicle on one ground agree") {
  const ModelDocument truth = vehicleWith({{"motor_deadband.speed", 0.1}});
  GapTask task;
  task.model = syntheticVehicle();
  for (uint64_t day = 0; day < 3; ++day) {
    task.train.push_back(syntheticDrive(truth, 300.0, 30 + day));
    task.train.back().name = "day" + std::to_string(day + 1);
  }
  const Repetition repetition = repeatLogs(task, kSilent);
  INFO(textOf(repetition));
  CHECK_FALSE(repetition.differs());
  CHECK(repetition.logsThatName("motor_deadband") == 3);
}
