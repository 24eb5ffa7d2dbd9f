// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"

using namespace tread;

namespace {

const std::map<std::string, TrackCommand> kPaperPatterns{{"straight", {1.0, 1.0}},
                                                         {"left", {0.8, 1.0}},
                                                         {"right", {1.0, 0.8}},
                                                         {"hard_left", {0.55, 1.0}},
                                                         {"hard_right", {1.0, 0.55}}};

VehicleModel teodor(const std::string& surface) {
  return readModelFile(std::string(TREAD_SOURCE_DIR) + "/config/models/teodor_" + surface +
                       ".yaml");
}

Pose2 endOf(const VehicleModel& model, const TrackCommand& command) {
  return simulate(model, std::vector<TrackCommand>(20, command), 0.05,
                  steadyEntry(model, {1.0, 1.0}))
      .back();
}

}  // namespace

TEST_CASE("The paper's five patterns of one second end where the calibration's equations say") {
  for (const std::string surface : {"cinder", "tarmac", "grass", "gravel"}) {
    const VehicleModel model = teodor(surface);
    CHECK(model.full_speed == 1.1);
    CHECK(model.gauge == 0.6);
    CHECK(model.lag == 0.15);
    // Share of a second that a lag of 0.15 s leaves of a command step.
    const double share = 1.0 - 0.15 * (1.0 - std::exp(-1.0 / 0.15));
    for (const auto& [name, command] : kPaperPatterns) {
      INFO(surface << " " << name);
      const Pose2 end = endOf(model, command);
      const double turn = model.yaw_gain * 1.1 * (command.right - command.left) / 0.6 * share;
      CHECK(end.yaw == Approx(turn).margin(1e-9));
      CHECK(end.x > 0.7);
      CHECK(end.x <= 1.1 * model.forward_gain + 1e-9);
      CHECK(end.y * turn >= 0.0);
      CHECK(std::abs(end.y) < 0.45);
    }
  }
}

TEST_CASE("Grass turns more than gravel, tarmac and cinder, in this order") {
  double last = 10.0;
  for (const std::string surface : {"grass", "gravel", "tarmac", "cinder"}) {
    const double yaw = endOf(teodor(surface), {0.55, 1.0}).yaw;
    CHECK(yaw < last);
    last = yaw;
  }
}

TEST_CASE("Left and right are mirrored on every calibrated surface") {
  for (const std::string surface : {"cinder", "tarmac", "grass", "gravel"}) {
    const VehicleModel model = teodor(surface);
    const Pose2 left = endOf(model, {0.55, 1.0});
    const Pose2 right = endOf(model, {1.0, 0.55});
    CHECK(left.x == right.x);
    CHECK(left.y == -right.y);
    CHECK(left.yaw == -right.yaw);
  }
}
