// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/simulator_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "common/report/text.hpp"
#include "common/vehicle/robot_description.hpp"

namespace tread::sim {
namespace {

constexpr Range kPlace{-100000.0, 100000.0};  // [m]
constexpr Range kSize{0.001, 10000.0};        // [m]
constexpr Range kAngle{-10.0, 10.0};          // [rad]
constexpr int64_t kMirrorTurn = 25'000;       // [us] of a laser
/// A belt lighter than this share of the vehicle would oscillate on the ground's spring in steps of
/// 1 ms.
constexpr double kLightestTrack = 0.02;

std::vector<Eigen::Vector2d> readCorners(ConfigReader& reader) {
  std::vector<std::vector<double>> rows;
  reader.table("corners", rows, 2, kPlace, "m");
  std::vector<Eigen::Vector2d> corners;
  corners.reserve(rows.size());
  for (const auto& row : rows) corners.emplace_back(row[0], row[1]);
  return corners;
}

Eigen::Vector2d readPoint(ConfigReader& reader, const std::string& key) {
  std::vector<double> values;
  reader.numbers(key, values, 2, kPlace, "m", true);
  return {values[0], values[1]};
}

SurfaceRegion readRegion(ConfigReader& reader) {
  SurfaceRegion region;
  reader.text("surface", region.surface, true);
  std::vector<double> strip;
  reader.numbers("strip", strip, 4, kPlace, "m");
  double width = 2.0;
  reader.number("width", width, kSize, "m");
  region.corners = readCorners(reader);
  if (strip.empty() == region.corners.empty())
    throw reader.error("surface", "give either corners or a strip from x, y to x, y");
  if (strip.empty()) return region;
  const Eigen::Vector2d from(strip[0], strip[1]), to(strip[2], strip[3]);
  if ((to - from).norm() < 0.001) throw reader.error("strip", "its two ends must differ");
  return stripRegion(region.surface, from, to, width);
}

Obstacle readObstacle(ConfigReader& reader) {
  Obstacle obstacle;
  std::vector<double> box;
  double length = 1.0, width = 1.0;
  reader.numbers("box", box, 3, kPlace, "m, m, rad");
  reader.number("length", length, kSize, "m");
  reader.number("width", width, kSize, "m");
  reader.number("height", obstacle.height, {0.05, 100.0}, "m");
  reader.number("radius", obstacle.radius, kSize, "m");
  const bool disc = reader.has("disc");
  if (disc) obstacle.centre = readPoint(reader, "disc");
  obstacle.corners = readCorners(reader);
  const int shapes = (box.empty() ? 0 : 1) + (disc ? 1 : 0) + (obstacle.corners.empty() ? 0 : 1);
  const std::string any = disc ? "disc" : box.empty() ? "corners" : "box";
  if (shapes != 1) throw reader.error(any, "an obstacle is one of box, disc or corners");
  if (!box.empty())
    obstacle.corners = boxObstacle({box[0], box[1], box[2]}, length, width, 1.0).corners;
  reader.text("name", obstacle.name);
  if (const auto fault = obstacleFault(obstacle)) throw reader.error(any, *fault);
  return obstacle;
}

Terrain readTerrain(ConfigReader reader) {
  Terrain terrain;
  for (ConfigReader& item : reader.sections("waves")) {
    TerrainWave wave;
    std::vector<double> k;
    item.number("amplitude", wave.amplitude, {-20.0, 20.0}, "m", true);
    item.numbers("k", k, 2, {-20.0, 20.0}, "rad/m", true);
    item.number("phase", wave.phase, kAngle, "rad");
    wave.k = {k[0], k[1]};
    terrain.waves.push_back(wave);
  }
  for (ConfigReader& item : reader.sections("bumps")) {
    TerrainBump bump;
    bump.centre = readPoint(item, "centre");
    item.number("height", bump.height, {-20.0, 20.0}, "m", true);
    item.number("radius", bump.radius, {0.1, 1000.0}, "m", true);
    terrain.bumps.push_back(bump);
  }
  return terrain;
}

RoughRegion readRough(ConfigReader& reader) {
  RoughRegion region;
  region.corners = readCorners(reader);
  readBumps(reader, region);
  const std::string fault = faultOf(region);
  if (!fault.empty()) throw reader.error("corners", fault);
  return region;
}

void readBody(ConfigReader& reader, VehicleParameters& vehicle, bool required) {
  reader.number("mass", vehicle.mass, {5.0, 2000.0}, "kg", required);
  reader.number("yaw_inertia", vehicle.yaw_inertia, {0.05, 500.0}, "kg m2", required);
  reader.number("gauge", vehicle.gauge, {0.2, 2.0}, "m");
  if (vehicle.wheels.empty()) {
    reader.number("contact_length", vehicle.contact_length, {0.2, 3.0}, "m", required);
    reader.number("centre", vehicle.centre, {-0.5, 0.5}, "m", required);
  }
  reader.number("mass_height", vehicle.mass_height, {0.0, 2.0}, "m", required);
  if (vehicle.wheelbase > 0.0)
    reader.number("steering_rate", vehicle.steering_rate, {0.1, 10.0}, "rad/s");
  reader.number("mass_ahead", vehicle.mass_ahead, {-0.15, 0.15}, "m");
}

void readDrive(ConfigReader& reader, DriveParameters& drive, bool required) {
  reader.number("free_speed", drive.free_speed, {0.1, 5.0}, "m/s");
  reader.number("stiffness", drive.stiffness, {10.0, 50000.0}, "N s/m", required);
  reader.number("force_limit", drive.force_limit, {5.0, 20000.0}, "N", required);
  reader.number("power_lag", drive.power_lag, {0.001, 2.0}, "s");
  reader.number("dead_power", drive.dead_power, {0.0, 0.5}, "");
  reader.number("track_mass", drive.track_mass, {0.3, 500.0}, "kg", required);
  reader.number("gear_friction", drive.gear_friction, {0.0, 2000.0}, "N", required);
  reader.number("brake_force", drive.brake_force, {0.0, 20000.0}, "N", required);
}

void readBattery(ConfigReader& reader, VehicleParameters& vehicle) {
  DriveParameters& drive = vehicle.drive;
  reader.number("charge", vehicle.charge, {0.0, 1.0}, "");
  reader.number("full_voltage", drive.full_voltage, {20.0, 32.0}, "V");
  reader.number("empty_voltage", drive.empty_voltage, {10.0, 32.0}, "V");
  reader.number("inner_resistance", drive.inner_resistance, {0.0, 0.2}, "ohm");
  double capacity = drive.capacity / 3600.0;
  reader.number("capacity", capacity, {0.1, 1000.0}, "Ah");
  drive.capacity = capacity * 3600.0;
  reader.number("idle_current", drive.idle_current, {0.0, 100.0}, "A");
  if (drive.empty_voltage > drive.full_voltage)
    throw reader.error("empty_voltage", "must not be above full_voltage");
}

/// For a rotating range finder: its field of view in a revolution; the scan is the forward part.
void readLaser(ConfigReader reader, LaserParameters& laser) {
  int64_t beams = laser.beams;
  double rate = 1e6 / static_cast<double>(laser.period_us);
  double field_of_view = laser.field_of_view * 180.0 / kPi;
  reader.integer("beams", beams, {2.0, 8000.0}, "1");
  reader.number("rate", rate, {1.0, 100.0}, "Hz");
  reader.number("field_of_view", field_of_view, {1.0, 360.0}, "deg");
  reader.number("range_max", laser.range_max, {1.0, 300.0}, "m");
  reader.number("range_noise", laser.range_noise, {0.0, 1.0}, "m");
  laser.beams = static_cast<int>(beams);
  // A conversion back and forth may change a number's last digit, and thereby the mission of a
  // seed.
  if (reader.has("field_of_view")) laser.field_of_view = field_of_view * kPi / 180.0;
  laser.period_us = std::llround(1e6 / rate);
  // A slow one skips revolutions: its mirror makes 40 a second.
  const int64_t turn = std::min<int64_t>(laser.period_us, kMirrorTurn);
  laser.sweep_us = std::llround(static_cast<double>(turn) * field_of_view / 360.0);
}

constexpr int64_t kRowEvery = 20'000;  // [us]
constexpr const char* kHeader =
    "utime_us,x_m,y_m,yaw_rad,v_mps,left,right,surface,contacts,distance_m";
constexpr int64_t kFlushEvery = 500'000;  // [us]

}  // namespace

SurfaceParameters readSurface(ConfigReader& reader) {
  std::vector<std::string> known;
  for (const SurfaceParameters& surface : builtInSurfaces()) known.push_back(surface.name);
  std::string name, like = "grass";
  reader.text("name", name, true);
  reader.choice("like", like, known);
  SurfaceParameters surface = *builtInSurface(like);
  surface.name = name;
  reader.number("friction", surface.friction, {0.01, 2.0}, "");
  reader.number("shear_displacement", surface.shear_displacement, {0.004, 0.5}, "m");
  reader.number("lateral_displacement", surface.lateral_displacement, {0.004, 0.5}, "m");
  reader.number("resistance_constant", surface.resistance_constant, {0.0, 0.3}, "");
  reader.number("resistance_viscous", surface.resistance_viscous, {0.0, 1.0}, "s/m");
  reader.number("scrub_resistance", surface.scrub_resistance, {0.0, 5.0}, "s/m");
  reader.number("pressure_offset", surface.pressure_offset, {-0.1, 0.1}, "m");
  reader.number("spread_forward", surface.spread.forward, {0.0, 0.3}, "");
  reader.number("spread_yaw", surface.spread.yaw, {0.0, 0.5}, "");
  reader.number("spread_heading", surface.spread.heading, {0.0, 0.3}, "rad");
  return surface;
}

void readBumps(ConfigReader& reader, RoughRegion& region) {
  reader.number("rms", region.rms, {0.0, 0.5}, "m");
  reader.number("shortest", region.shortest, {0.2, 100.0}, "m");
  reader.number("longest", region.longest, {0.2, 100.0}, "m");
  auto seed = static_cast<int64_t>(region.seed);
  reader.integer("seed", seed, {0.0, 1e15}, "1");
  region.seed = static_cast<uint64_t>(seed);
  if (region.shortest >= region.longest) throw reader.error("longest", "must be above shortest");
}

WorldDescription readWorld(ConfigReader reader) {
  WorldDescription world;
  reader.text("name", world.name);
  std::vector<double> bounds{world.bounds.low.x(), world.bounds.low.y(), world.bounds.high.x(),
                             world.bounds.high.y()};
  reader.numbers("bounds", bounds, 4, kPlace, "m");
  world.bounds = {{bounds[0], bounds[1]}, {bounds[2], bounds[3]}};
  reader.text("base_surface", world.base_surface);
  for (ConfigReader& item : reader.sections("surfaces"))
    world.surfaces.push_back(readSurface(item));
  for (ConfigReader& item : reader.sections("regions")) world.regions.push_back(readRegion(item));
  world.terrain = readTerrain(reader.section("terrain"));
  for (ConfigReader& item : reader.sections("rough")) world.rough.push_back(readRough(item));
  for (ConfigReader& item : reader.sections("obstacles"))
    world.obstacles.push_back(readObstacle(item));
  reader.finish();
  if (const auto fault = worldFault(world)) throw reader.error("base_surface", *fault);
  return world;
}

WorldDescription readWorld(const std::string& path) {
  return readWorld(ConfigReader::fromFile(path));
}

WorldDescription parseWorld(const std::string& text, const std::string& name) {
  return readWorld(ConfigReader::fromText(text, name));
}

void readVehicle(ConfigReader reader, VehicleParameters& vehicle, bool whole) {
  readBody(reader, vehicle, whole);
  reader.number("left_power", vehicle.left_power, {0.0, 1.5}, "");
  reader.number("right_power", vehicle.right_power, {0.0, 1.5}, "");
  reader.number("left_drag", vehicle.left_drag, {0.0, 2000.0}, "N");
  reader.number("right_drag", vehicle.right_drag, {0.0, 2000.0}, "N");
  readDrive(reader, vehicle.drive, whole);
  readBattery(reader, vehicle);
  const double lightest = kLightestTrack * vehicle.mass;
  if (vehicle.drive.track_mass < lightest)
    throw reader.error("track_mass", "at least a 50th of the mass, " + fixed(lightest, 2) + " kg");
}

void readSimulatedRobot(ConfigReader& reader, RobotSettings& settings) {
  const RobotDescription robot = readRobot(reader);
  settings.vehicle.outline = robot.outline;
  settings.vehicle.gauge = robot.gauge;
  settings.vehicle.wheelbase = robot.drive.wheelbase;
  settings.vehicle.max_steering = robot.drive.max_steering;
  for (const OmniWheel& wheel : robot.drive.wheels.wheels())
    settings.vehicle.wheels.push_back({wheel.x, wheel.y, wheel.heading, wheel.rollers});
  // Area of the bumps that support the base.
  if (robot.drive.isOmni()) settings.vehicle.contact_length = robot.gauge;
  if (robot.drive.isCar() && robot.drive.kind == CommandKind::kTrackSpeed)
    throw reader.error("robot", "a simulated car accepts power, not speeds: set drive.kind: power");
  settings.vehicle.drive.free_speed = robot.drive.full_speed;
  settings.wiring = {
      robot.drive.left_channel, robot.drive.invert_left, robot.drive.invert_right, {}, false,
      robot.drive.invert_wheels};
  settings.wiring.four_motors = robot.drive.layout == DriveLayout::kSkidSteer4;
  if (robot.drive.kind == CommandKind::kTrackSpeed)
    settings.wiring.top_speed = robot.drive.fullCommand();
  settings.laser.mounting = robot.range_finder;
  if (robot.ground_finder) settings.ground_laser.emplace().mounting = *robot.ground_finder;
  settings.ins.mounting = robot.ins;
  ConfigReader dynamics = reader.file("dynamics", "dynamics.yaml");
  readLaser(dynamics.section("laser"), settings.laser);
  readVehicle(std::move(dynamics), settings.vehicle, true);
}

RobotSettings readSimulatedRobot(const std::string& folder) {
  ConfigReader reader = ConfigReader::fromText("{}", folder + "/simulator");
  RobotSettings settings;
  readSimulatedRobot(reader, settings);
  reader.finish();
  return settings;
}

TruthRecord::TruthRecord(const std::string& path)
    : out_((moveAside(path), path), OutputFile::Kind::kGrowing) {
  out_.write(std::string(kHeader) + "\n");
}

void TruthRecord::note(const RobotTruth& truth, const MotorValues& power) {
  const bool due = last_row_ == INT64_MIN || truth.utime - last_row_ >= kRowEvery;
  if (!due && power == power_) return;
  power_ = power;
  last_row_ = truth.utime;
  out_.write(formatted("%lld,%.4f,%.4f,%.5f,%.4f,%.3f,%.3f,%s,%zu,%.3f\n",
                       static_cast<long long>(truth.utime), truth.T_map_body.x, truth.T_map_body.y,
                       truth.T_map_body.yaw, truth.v_body.v_x, power[0], power[1],
                       truth.surface.c_str(), truth.collisions.size(), truth.distance));
  if (last_flush_ != INT64_MIN && truth.utime - last_flush_ < kFlushEvery) return;
  last_flush_ = truth.utime;
  out_.flush();
}

std::vector<TruthRow> readTruthRecord(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line) || line != kHeader)
    throw std::runtime_error(path + ": is no record of a simulation's truth; " +
                             "tread-simulator --set record=FILE writes one");
  std::vector<TruthRow> rows;
  while (std::getline(file, line)) {
    if (file.eof()) break;  // the last one may be incomplete
    TruthRow row;
    long long utime = 0;
    char surface[64];
    Pose2& pose = row.T_map_body;
    const int count = std::sscanf(line.c_str(), "%lld,%lf,%lf,%lf,%lf,%lf,%lf,%63[^,],%d,%lf",
                                  &utime, &pose.x, &pose.y, &pose.yaw, &row.speed, &row.power[0],
                                  &row.power[1], surface, &row.contacts, &row.distance);
    if (count != 10)
      throw std::runtime_error(path + ":" + std::to_string(rows.size() + 2) + ": not a row");
    row.utime = utime;
    row.surface = surface;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace tread::sim
