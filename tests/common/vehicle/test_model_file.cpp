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
    parseModelDocument(text, "m.yaml").vehicle;
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
  const VehicleModel model = parseModelDocument(kHead, "m.yaml").vehicle;
  CHECK(model.forward_gain == 1.0);
  CHECK(model.yaw_gain == 1.0);
  CHECK(model.lag == 0.0);
  CHECK(model.effects.icr_offset == 0.0);
  CHECK(model.spread.yaw == 0.0);
}

TEST_CASE("A model file comes back bit for bit") {
  ModelDocument document = parseModelDocument(kHead, "m.yaml");
  VehicleModel& model = document.vehicle;
  model.name = "a: b";
  model.lag = 0.1 + 0.05;
  model.delay = 1.0 / 3.0;
  model.forward_gain = 0.95 * 1.01;
  model.step = 0.1 / 3.0;
  model.spread = {0.1 / 3.0, 0.2, 0.3};
  for (const Effect& effect : effectCatalogue())
    for (const EffectParameter& parameter : effect.parameters)
      if (parameter.vehicle != nullptr && effect.isOf(VehicleLayout::kTracks))
        model.effects.*parameter.vehicle =
            parameter.typical * (1.0 + 1e-15) / 3.0 +
            10.0 / 3.0 * (parameter.name == "time_constant" ? 1.0 : 0.0);
  const std::string text = formatModelDocument(document);
  const VehicleModel again = parseModelDocument(text, "again.yaml").vehicle;
  CHECK(again.name == model.name);
  CHECK(again.lag == model.lag);
  CHECK(again.delay == model.delay);
  CHECK(again.forward_gain == model.forward_gain);
  CHECK(again.step == model.step);
  CHECK(again.spread.forward == model.spread.forward);
  for (const Effect& effect : effectCatalogue())
    for (const EffectParameter& parameter : effect.parameters) {
      INFO(effect.name << "." << parameter.name);
      if (parameter.vehicle != nullptr)
        CHECK(again.effects.*parameter.vehicle == model.effects.*parameter.vehicle);
    }
  CHECK(formatModelDocument(parseModelDocument(text, "again.yaml")) == text);
}

TEST_CASE("Effects that are off are left out of a model file, also those with a default shape") {
  const std::string text = formatModelDocument(parseModelDocument(kHead, "m.yaml"));
  CHECK(text.find("effects") == std::string::npos);
  CHECK(text.find("measurement") == std::string::npos);
}

TEST_CASE("A limit may stand in a file as itself or as its reciprocal, not as both") {
  const std::string effect = kHead + "effects:\n  turn_power_limit:\n    ";
  const ModelDocument itself = parseModelDocument(effect + "limit: 2\n", "m.yaml");
  const VehicleModel reciprocal =
      parseModelDocument(effect + "inverse_limit: 0.5\n", "m.yaml").vehicle;
  CHECK(itself.vehicle.effects.turn_power_limit == 0.5);
  CHECK(reciprocal.effects.turn_power_limit == 0.5);
  CHECK(formatModelDocument(itself).find("inverse_limit: 0.5  # s/rad: limit 2 rad/s") !=
        std::string::npos);
  expectError(effect + "limit: 2\n    inverse_limit: 0.5\n", "7", "one of them");
  expectError(effect + "limit: 0\n", "7", "0.1..1e+09 rad/s");
}

TEST_CASE("Bad model files are refused with file, line and what is allowed") {
  expectError(kHead + "gain: 1\n", "5", "gain");
  expectError(kHead + "lag: fast\n", "5", "0..5 s");
  expectError(kHead + "lag: -0.1\n", "5", "0..5 s");
  expectError(kHead + "yaw_gain: .nan\n", "5", "nan");
  expectError(kHead + "step: 0\n", "5", "5e-04..0.1 s");
  expectError(kHead + "effects:\n  icr_ofset:\n    offset: 0.1\n", "6", "icr_offset");
  expectError(kHead + "effects:\n  icr_offset:\n    offset: 2\n", "7", "-0.5..0.5 m");
  expectError(kHead + "effects:\n  icr_offset:\n    angle: 0.1\n", "7", "offset");
  expectError(kHead + "effects:\n  yaw_pull:\n    rate: 0.1\n", "7", "pull");
  expectError(kHead + "effects:\n  gyro_bias:\n    rate: 0.1\n", "6", "gyro_bias");
  expectError(kHead + "measurement:\n  slip_ratio:\n    slip: 0.1\n", "6", "slip_ratio");
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
