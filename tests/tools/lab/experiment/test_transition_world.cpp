// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/vehicle/kernel.hpp"
#include "tests/tools/lab/experiment/small_world.hpp"

namespace tread::experiment {
namespace {

using namespace testing;

std::string replaced(const std::string& what, const std::string& with) {
  std::string text = kSmallWorld;
  text.replace(text.find(what), what.size(), with);
  return text;
}

std::string complaintOf(const std::string& text) {
  try {
    parseTransitionWorld(text, "small.yaml");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

struct Calibrated {
  double g_f, g_psi, slip, asym, del0;
};

/// The calibration's model, implemented independently: end of a pattern of 1 s.
Pose2 endByCalibration(const Calibrated& surface, const TrackCommand& power,
                       const ExecutionNoise& noise) {
  constexpr double kLag = 0.15, kFullSpeed = 1.10, kGauge = 0.60, kFine = 1e-4;
  double v_l = kFullSpeed, v_r = kFullSpeed;
  Pose2 T_start_body;
  for (int i = 0; i < 10000; ++i) {
    const double keep = std::exp(-kFine / kLag);
    v_l = kFullSpeed * power.left + (v_l - kFullSpeed * power.left) * keep;
    v_r = kFullSpeed * power.right + (v_r - kFullSpeed * power.right) * keep;
    const double v = surface.g_f * noise.forward * (v_l + v_r) / 2.0;
    const double omega = surface.g_psi * noise.yaw * (v_r - v_l) / kGauge + surface.asym;
    const double v_y = v * std::tan(surface.del0 + noise.crab) + surface.slip * omega;
    T_start_body = T_start_body * integrate({v, v_y, omega}, kFine);
  }
  return T_start_body;
}

}  // namespace

TEST_CASE("the shipped worlds are the calibration: the same motion to a tenth of a millimetre") {
  const TransitionWorld world = readTransitionWorld(kWorlds + "transitions_asymmetric.yaml");
  REQUIRE(world.surfaces.size() == 4);
  CHECK(world.recordings == 300);
  CHECK(world.paper_reference);
  const Calibrated surfaces[] = {{0.9541, 0.8885, 0.0465, 0.0102, 0.0442},
                                 {0.9840, 0.9737, 0.0048, 0.0301, 0.0501},
                                 {1.0462, 1.2212, -0.0936, 0.0288, 0.0511},
                                 {0.9974, 1.0587, -0.0708, 0.0260, 0.0298}};
  const ExecutionNoise noise{1.02, 0.95, 0.03};
  for (size_t s = 0; s < 4; ++s)
    for (const WorldPattern& pattern : world.patterns) {
      const VehicleModel& model = world.surfaces[s].model;
      REQUIRE(pattern.commands.size() == 20);
      const Pose2 end =
          simulate(model, pattern.commands, world.period, steadyEntry(model, world.entry), noise)
              .back();
      const Pose2 wanted = endByCalibration(surfaces[s], pattern.commands.front(), noise);
      INFO(world.surfaces[s].name << " " << pattern.name);
      CHECK(std::hypot(end.x - wanted.x, end.y - wanted.y) < 1e-4);
      CHECK(std::abs(end.yaw - wanted.yaw) < 1e-4);
    }
}

TEST_CASE("recordings spread as the world says, and a seed gives the same ones") {
  const TransitionWorld world = readTransitionWorld(kWorlds + "transitions_symmetric.yaml");
  const recordings::PatternRecordings recorded = record(world, 3), again = record(world, 3);
  const auto& straight = recorded.surfaces[0].executions[0];
  REQUIRE(straight.size() == 300);
  double mean = 0.0, square = 0.0;
  for (size_t i = 0; i < straight.size(); ++i) {
    CHECK(straight[i].back().x == again.surfaces[0].executions[0][i].back().x);
    const double direction = std::atan2(straight[i].back().y, straight[i].back().x);
    mean += direction / 300.0;
    square += direction * direction / 300.0;
  }
  CHECK(std::sqrt(square - mean * mean) == Approx(0.0474).epsilon(0.15));
  CHECK(record(world, 4).surfaces[0].executions[0][0].back().x != straight[0].back().x);
}

TEST_CASE("what is wrong in a world file is one line with its place") {
  CHECK(complaintOf(kSmallWorld).empty());
  const auto says = [](const std::string& text, const std::string& words) {
    const std::string complaint = complaintOf(text);
    INFO(complaint);
    CHECK(complaint.find("small.yaml:") == 0);
    CHECK(complaint.find(words) != std::string::npos);
    CHECK(complaint.find('\n') == std::string::npos);
  };
  says(replaced("recordings: 40", "recordings: 2"), "recordings");
  says(replaced("recordings: 40", "rekordings: 40"), "rekordings");
  says(replaced("gauge: 0.6", "gauge: -1"), "gauge");
  says(replaced("gauge: 0.6, ", ""), "gauge");
  says(replaced("yaw: 0.06", "yow: 0.06"), "yow");
  says(replaced("[[0.7, 1, 10]]", "[[1.7, 1, 10]]"), "power out of range -1..1");
  says(replaced("[[0.7, 1, 10]]", "[[0.7, 1, 2.5]]"), "samples");
  says(replaced("name: right", "name: left"), "twice");
  says(replaced("name: ice", "name: 'ice, wet'"), "letters");
  says(replaced("[left, left, right]", "[left, port, right]"), "'port'");
  says(replaced("[left, left, right]", "[]"), "at least one pattern");
  says(replaced("kind: transitions\n", ""), "simulator");
  const std::string text = kSmallWorld;
  says(text.substr(0, text.find("  - name: road")), "two surfaces");
}

TEST_CASE("a world of the simulator is refused with a hint") {
  CHECK_THROWS_WITH(readTransitionWorld(kWorlds + "demo.yaml"),
                    Catch::Contains("demo.yaml:1:") && Catch::Contains("kind: transitions"));
}

}  // namespace tread::experiment
