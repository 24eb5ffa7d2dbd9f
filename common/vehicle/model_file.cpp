// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/model_file.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/config/scalars.hpp"

namespace tread {
namespace {

constexpr Range kGain{0.05, 5.0};
constexpr Range kSpread{0.0, 1.0};

void readTracks(ConfigReader& reader, VehicleModel& model) {
  std::string kind;
  reader.choice("kind", kind, {"power", "track_speed"}, true);
  model.kind = kind == "power" ? CommandKind::kPower : CommandKind::kTrackSpeed;
  if (model.kind == CommandKind::kPower)
    reader.number("full_speed", model.full_speed, {0.01, 20.0}, "m/s", true);
  else if (reader.has("full_speed"))
    throw reader.error("full_speed", "is for power commands; track_speed commands are in m/s");
  reader.number("gauge", model.gauge, {0.05, 10.0}, "m", true);
  reader.number("lag", model.lag, {0.0, 5.0}, "s");
  reader.number("delay", model.delay, {0.0, 2.0}, "s");
  reader.number("forward_gain", model.forward_gain, kGain, "");
  reader.number("yaw_gain", model.yaw_gain, kGain, "");
}

void readEffects(ConfigReader reader, VehicleModel& model) {
  const std::vector<Effect>& catalogue = effectCatalogue();
  for (size_t i = 0; i < catalogue.size(); ++i) {
    ConfigReader effect = reader.section(catalogue[i].name);
    for (size_t j = 0; j < catalogue[i].parameters.size(); ++j) {
      const EffectParameter& parameter = catalogue[i].parameters[j];
      effect.number(parameter.name, model.effects[i][j], {parameter.min, parameter.max},
                    parameter.unit);
    }
  }
}

VehicleModel readModel(ConfigReader reader) {
  VehicleModel model;
  reader.text("name", model.name, true);
  readTracks(reader, model);
  readEffects(reader.section("effects"), model);
  ConfigReader spread = reader.section("spread");
  spread.number("forward", model.spread.forward, kSpread, "");
  spread.number("yaw", model.spread.yaw, kSpread, "");
  spread.number("crab", model.spread.crab, kSpread, "rad");
  reader.finish();
  return model;
}

void writeEffects(std::ostringstream& out, const VehicleModel& model) {
  const std::vector<Effect>& catalogue = effectCatalogue();
  bool any = false;
  for (size_t i = 0; i < catalogue.size(); ++i) {
    const std::vector<double>& values = model.effects[i];
    if (std::all_of(values.begin(), values.end(), [](double value) { return value == 0.0; }))
      continue;
    if (!any) out << "effects:\n";
    any = true;
    out << "  " << catalogue[i].name << ":  # " << catalogue[i].sentence << '\n';
    for (size_t j = 0; j < values.size(); ++j) {
      const EffectParameter& parameter = catalogue[i].parameters[j];
      out << "    " << parameter.name << ": " << formatNumber(values[j]) << "  # " << parameter.unit
          << '\n';
    }
  }
}

}  // namespace

VehicleModel readModelFile(const std::string& path) {
  return readModel(ConfigReader::fromFile(path));
}

VehicleModel parseModel(const std::string& text, const std::string& name) {
  return readModel(ConfigReader::fromText(text, name));
}

std::string formatModel(const VehicleModel& model) {
  std::ostringstream out;
  const auto line = [&](const std::string& key, double value, const std::string& comment) {
    out << key << ": " << formatNumber(value) << "  # " << comment << '\n';
  };
  const bool power = model.kind == CommandKind::kPower;
  out << "name: " << formatText(model.name) << '\n';
  out << "kind: " << (power ? "power" : "track_speed") << '\n';
  if (power) line("full_speed", model.full_speed, "m/s, track speed at power 1");
  line("gauge", model.gauge, "m, between the middles of the tracks");
  line("lag", model.lag, "s, time constant of the track speeds");
  line("delay", model.delay, "s, before a command begins to act");
  line("forward_gain", model.forward_gain, "ground speed over mean track speed");
  line("yaw_gain", model.yaw_gain, "yaw rate over that of the track speeds");
  writeEffects(out, model);
  out << "spread:  # standard deviations from one execution to the next\n";
  line("  forward", model.spread.forward, "of the factor on the forward speed");
  line("  yaw", model.spread.yaw, "of the factor on the yaw rate");
  line("  crab", model.spread.crab, "rad, of the direction of travel");
  return out.str();
}

}  // namespace tread
