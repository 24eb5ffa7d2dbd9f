// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/pattern/pattern_file.hpp"
#include "common/recordings/average.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"
#include "tests/tools/robot/patterns/patterns_program.hpp"
#include "tools/robot/patterns/recipe.hpp"

using namespace tread;
using namespace tread::patterns;

namespace {

using kit::kConfigFolder;
using kit::shipped;

ModelDocument grass() {
  return readModelDocument(kConfigFolder + "models/teodor_grass.yaml");
}

bool same(const recordings::Execution& a, const recordings::Execution& b) {
  for (size_t t = 0; t < a.size(); ++t)
    if (a[t].x != b[t].x || a[t].y != b[t].y || a[t].yaw != b[t].yaw) return false;
  return a.size() == b.size();
}

}  // namespace

TEST_CASE("What a model recorded averages to what the model predicts, ends scattered as it says") {
  const PatternSet set = shipped();
  ModelRecording how;
  how.executions = 400;
  const auto recorded = recordModel(set, grass(), "grass", how);
  std::vector<recordings::AverageNote> notes;
  const PatternSet averaged = recordings::averageSet(set, recorded, {}, notes);
  for (const MotionPattern& pattern : averaged.patterns()) {
    INFO(pattern.name);
    MotionPattern predicted = pattern;
    predict(grass().vehicle, set.periodSeconds(), set.classNamed(pattern.entry_class), predicted);
    CHECK(std::hypot(pattern.end().x - predicted.end().x, pattern.end().y - predicted.end().y) <
          0.012);
    CHECK(std::abs(pattern.end().yaw - predicted.end().yaw) < 0.025);
    // Plus INS noise of 3 mm and 1 mrad.
    CHECK(pattern.end_covariance[0] ==
          Approx(predicted.end_covariance[0] + 9e-6).epsilon(0.4).margin(4e-6));
    CHECK(pattern.end_covariance[5] ==
          Approx(predicted.end_covariance[5] + 1e-6).epsilon(0.3).margin(1e-6));
  }
}

TEST_CASE("The same seed records the same, another seed or surface does not") {
  ModelRecording how;
  how.executions = 2;
  const auto first = recordModel(shipped(), grass(), "grass", how);
  CHECK(
      same(first.executions[3][1], recordModel(shipped(), grass(), "grass", how).executions[3][1]));
  CHECK_FALSE(
      same(first.executions[3][1], recordModel(shipped(), grass(), "lawn", how).executions[3][1]));
  how.seed = 2;
  CHECK_FALSE(
      same(first.executions[3][1], recordModel(shipped(), grass(), "grass", how).executions[3][1]));
}

TEST_CASE("Patterns of one vehicle are not recorded on the model of another") {
  const ModelDocument warthog = readModelDocument(kConfigFolder + "models/warthog_nominal.yaml");
  CHECK_THROWS_WITH(
      recordModel(shipped(), warthog, "x", {}),
      Catch::Contains(
          "the patterns command left [1], right [1], the model takes left [m/s], right [m/s]"));
}

TEST_CASE("What the model file says of the INS is in what is recorded") {
  ModelRecording how;
  how.executions = 1;
  how.position = how.yaw = 0.0;
  ModelDocument still = grass();
  still.vehicle.spread = {};
  ModelDocument askew = still;
  askew.measurement.heading_misalignment = 0.1;
  const PatternSet set = shipped();
  const auto plain = recordModel(set, still, "grass", how);
  const auto seen = recordModel(set, askew, "grass", how);
  for (size_t p = 0; p < set.patterns().size(); ++p) {
    const Pose2& straight = plain.executions[p][0].back();
    const Pose2& turned = seen.executions[p][0].back();
    CAPTURE(set.patterns()[p].name);
    CHECK(std::hypot(turned.x, turned.y) ==
          Approx(std::hypot(straight.x, straight.y)).margin(1e-6));
    CHECK(turned.yaw == Approx(straight.yaw).margin(1e-9));
    if (straight.x > 0.3)
      CHECK(std::atan2(turned.y, turned.x) - std::atan2(straight.y, straight.x) ==
            Approx(0.1).margin(1e-6));
  }
  // In steady motion a late INS makes no difference; at the start it still shows standstill.
  ModelDocument late = still;
  late.measurement.ins_latency = 0.2;
  const auto of_late = recordModel(set, late, "grass", how);
  for (size_t p = 0; p < set.patterns().size(); ++p) {
    const Pose2& now = plain.executions[p][0].back();
    const Pose2& said = of_late.executions[p][0].back();
    if (set.patterns()[p].name == "straight") CHECK(said.x == Approx(now.x).margin(1e-6));
    if (set.patterns()[p].name == "start") CHECK(said.x < now.x - 0.15);
  }
}
