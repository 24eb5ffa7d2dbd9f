// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <filesystem>
#include <string>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"

using namespace tread;

namespace {

const std::string kHead = "name: m\nkind: power\nfull_speed: 1.1\ngauge: 0.6\n";  // 4 lines

void expectError(const std::string& text, const std::string& place, const std::string& part) {
  std::string message = "no error";
  try {
    parseModel(text, "m.yaml");
  } catch (const ConfigError& error) {
    message = error.what();
  }
  INFO(message);
  CHECK(message.find("m.yaml:" + place + ": ") == 0);
  CHECK(message.find(part) != std::string::npos);
  CHECK(message.find('\n') == std::string::npos);
}

}  // namespace

TEST_CASE("What a model file does not name is nominal") {
  const VehicleModel model = parseModel(kHead, "m.yaml");
  CHECK(model.forward_gain == 1.0);
  CHECK(model.yaw_gain == 1.0);
  CHECK(model.lag == 0.0);
  CHECK(model.effect("sideslip", "lever") == 0.0);
  CHECK(model.spread.yaw == 0.0);
}

TEST_CASE("A model file comes back bit for bit") {
  VehicleModel model = parseModel(kHead, "m.yaml");
  model.name = "a: b";
  model.lag = 0.1 + 0.05;
  model.delay = 1.0 / 3.0;
  model.forward_gain = 0.95 * 1.01;
  model.effect("sideslip", "lever") = -1.0 / 7.0;
  model.effect("crab", "angle") = 1e-17;
  model.spread = {0.1 / 3.0, 0.2, 0.3};
  const VehicleModel again = parseModel(formatModel(model), "again.yaml");
  CHECK(again.name == model.name);
  CHECK(again.lag == model.lag);
  CHECK(again.delay == model.delay);
  CHECK(again.forward_gain == model.forward_gain);
  CHECK(again.effects == model.effects);
  CHECK(again.spread.forward == model.spread.forward);
  CHECK(formatModel(again) == formatModel(model));
}

TEST_CASE("Bad model files are refused with file, line and what is allowed") {
  expectError(kHead + "gain: 1\n", "5", "gain");
  expectError(kHead + "lag: fast\n", "5", "0..5 s");
  expectError(kHead + "lag: -0.1\n", "5", "0..5 s");
  expectError(kHead + "yaw_gain: .nan\n", "5", "nan");
  expectError(kHead + "effects:\n  slideslip:\n    lever: 0.1\n", "6", "sideslip");
  expectError(kHead + "effects:\n  sideslip:\n    lever: 2\n", "7", "-0.5..0.5 m/rad");
  expectError(kHead + "effects:\n  sideslip:\n    angle: 0.1\n", "7", "lever");
  expectError("name: m\nkind: power\ngauge: 0.6\n", "1", "full_speed");
  expectError("name: m\nkind: track_speed\ngauge: 1\nfull_speed: 1\n", "4", "track_speed");
  expectError("name: m\nkind: torque\ngauge: 1\n", "2", "track_speed");
}

TEST_CASE("Every shipped model file can be read and is named like its file") {
  int models = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(std::string(TREAD_SOURCE_DIR) + "/config/models")) {
    if (file.path().extension() != ".yaml") continue;
    const VehicleModel model = readModelFile(file.path().string());
    CHECK(model.name == file.path().stem().string());
    ++models;
  }
  CHECK(models >= 6);
}

TEST_CASE("The Warthog on asphalt turns with half the yaw rate of its wheels") {
  const std::string folder = std::string(TREAD_SOURCE_DIR) + "/config/models/";
  const VehicleModel asphalt = readModelFile(folder + "warthog_asphalt.yaml");
  const VehicleModel nominal = readModelFile(folder + "warthog_nominal.yaml");
  CHECK(asphalt.kind == CommandKind::kTrackSpeed);
  const TrackCommand command{2.0 - 0.54, 2.0 + 0.54};
  CHECK(steadyTwist(nominal, command).v_x == Approx(2.0));
  CHECK(steadyTwist(nominal, command).omega == Approx(1.0));
  CHECK(steadyTwist(asphalt, command).v_x == Approx(1.9));
  CHECK(steadyTwist(asphalt, command).omega == Approx(0.49));
}
