// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/missions/world_kind.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/config/config_folder.hpp"
#include "common/vehicle/model_file.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "tools/robot/patterns/recipe.hpp"

namespace tread::missions {
namespace {

std::string worldFolder() {
  return shippedConfig() + "/missions/worlds";
}

/// A drive, payload or battery that changes while driving.
class ChangingVehicle final : public sim::Plant {
 public:
  ChangingVehicle(const sim::VehicleParameters& before, const WorldKind& kind)
      : vehicle_(before), later_(*kind.vehicle), left_to_drive_(kind.after) {}

  void step(const sim::MotorPower& power, const sim::Ground& ground, double dt) override {
    vehicle_.step(power, ground, dt);
    if (left_to_drive_ <= 0.0) return;
    left_to_drive_ -= std::abs(vehicle_.velocity().v_x) * dt;
    if (left_to_drive_ <= 0.0) vehicle_.rebuild(later_);
  }
  Twist2 velocity() const override { return vehicle_.velocity(); }
  const sim::TrackDrive& left() const override { return vehicle_.left(); }
  const sim::TrackDrive& right() const override { return vehicle_.right(); }
  const sim::Battery& battery() const override { return vehicle_.battery(); }
  void stopBody() override { vehicle_.stopBody(); }

 private:
  sim::TrackedVehicle vehicle_;
  sim::VehicleParameters later_;
  double left_to_drive_;  ///< [m] until the change
};

PatternSet shippedOf(ConfigReader patterns) {
  std::string recipe, model;
  patterns.path("recipe", recipe, true);
  patterns.path("model", model, true);
  return patterns::makeSet(ConfigReader::fromFile(recipe), readModelFile(model));
}

}  // namespace

std::vector<std::string> worldKinds() {
  std::vector<std::string> names;
  std::error_code missing;  // without the folder only the default kind is left
  for (const auto& file : std::filesystem::directory_iterator(worldFolder(), missing))
    names.push_back(file.path().stem().string());
  std::sort(names.begin(), names.end());
  names.insert(names.begin(), WorldKind().name);
  return names;
}

WorldKind readWorldKind(const std::string& name, const sim::VehicleParameters& vehicle) {
  WorldKind kind;
  if (name == kind.name) return kind;
  kind.name = name;
  ConfigReader reader = ConfigReader::fromFile(worldFolder() + "/" + name + ".yaml");
  reader.text("between", kind.between);
  for (ConfigReader& surface : reader.sections("surfaces"))
    kind.surfaces.push_back(sim::readSurface(surface));
  if (reader.has("rough")) {
    ConfigReader rough = reader.section("rough");
    sim::readBumps(rough, kind.rough.emplace());
    rough.number("share", kind.rough_share, {0.0, 1.0}, "1");
  }
  if (reader.has("vehicle")) {
    if (vehicle.wheelbase > 0.0) throw reader.error("vehicle", "changes tracked vehicles only");
    reader.number("after", kind.after, {0.0, 1000.0}, "m");
    kind.vehicle = vehicle;
    sim::readVehicle(reader.section("vehicle"), *kind.vehicle);
  }
  if (reader.has("patterns")) kind.shipped = shippedOf(reader.section("patterns"));
  reader.finish();
  return kind;
}

std::vector<sim::SurfaceParameters> surfacesOfKinds() {
  std::vector<sim::SurfaceParameters> surfaces;
  for (const std::string& name : worldKinds()) {
    if (name == WorldKind().name) continue;
    ConfigReader reader = ConfigReader::fromFile(worldFolder() + "/" + name + ".yaml");
    for (ConfigReader& surface : reader.sections("surfaces"))
      surfaces.push_back(sim::readSurface(surface));
  }
  return surfaces;
}

std::unique_ptr<sim::Plant> vehicleOf(const WorldKind& kind, const sim::VehicleParameters& before) {
  if (!kind.changesOnTheWay()) return nullptr;
  return std::make_unique<ChangingVehicle>(before, kind);
}

}  // namespace tread::missions
