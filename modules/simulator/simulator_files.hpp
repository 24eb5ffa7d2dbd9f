// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/store/output_file.hpp"
#include "modules/simulator/core/robot.hpp"
#include "modules/simulator/core/world.hpp"

namespace tread::sim {

/// Reads a kind of ground: its differences from a built-in one (key `like`).
SurfaceParameters readSurface(ConfigReader& reader);

/// Reads height, wavelengths and seed of bumps; missing keys keep their values.
void readBumps(ConfigReader& reader, RoughRegion& region);

/// Reads a world file (config/worlds); throws ConfigError with file:line.
WorldDescription readWorld(const std::string& path);
/// The same from a map in another file.
WorldDescription readWorld(ConfigReader reader);
/// The same from text; `name` stands for the file in messages.
WorldDescription parseWorld(const std::string& text, const std::string& name);

/// Reads a dynamic vehicle in physical quantities. The ranges keep the integration stable at 1 ms.
/** Missing keys keep their values; with `whole`, all values that are specific to this machine are
 * required. Used to hide a weak drive or battery behind the serial lines. */
void readVehicle(ConfigReader reader, VehicleParameters& vehicle, bool whole = false);

/// The simulated robot of a configuration: keys `robot` and `dynamics`, each a file or a map.
/** Outline, mountings and, unless dynamics.yaml overrides them, gauge and free speed are the
 * described robot's (robot.yaml), the rest of the vehicle is in dynamics.yaml; both are beside the
 * configuration by default. Its map `laser` (beams, rate, field_of_view, range_max, range_noise)
 * overrides the laser's defaults. */
void readSimulatedRobot(ConfigReader& reader, RobotSettings& settings);

/// The same from a robot's folder.
RobotSettings readSimulatedRobot(const std::string& folder);

/// The true motion as CSV for reports and tests; the robot's processes never read it.
/** One row when the power on the motors changes, else every 20 ms:
 * utime_us,x_m,y_m,yaw_rad,v_mps,left,right,surface,contacts,distance_m. Yaw is unwrapped, power
 * is the controller's output to the motors (-1..1); for a holonomic base, that of the first two
 * wheels. */
class TruthRecord {
 public:
  /// Creates the file with its header; an earlier record is renamed to PATH.1 or the next free
  /// name. Throws WriteError, as all functions do.
  explicit TruthRecord(const std::string& path);

  void note(const RobotTruth& truth, const MotorValues& power);
  /// Flushes all rows to the file.
  void flush() { out_.flush(); }

 private:
  OutputFile out_;
  MotorValues power_{};
  int64_t last_row_ = INT64_MIN;
  int64_t last_flush_ = INT64_MIN;
};

/// A row of such a record.
struct TruthRow {
  int64_t utime = 0;                      ///< [us]
  Pose2 T_map_body;                       ///< yaw unwrapped
  double speed = 0.0;                     ///< forward [m/s]
  std::array<double, 2> power{0.0, 0.0};  ///< of the motors: left, right, -1..1
  std::string surface;
  int contacts = 0;       ///< so far
  double distance = 0.0;  ///< driven so far [m]

  bool motorsAtZero() const { return power[0] == 0.0 && power[1] == 0.0; }
};

/// The complete rows of a record so far; an incomplete last one is left out. Throws
/// std::runtime_error with one clear line if the file does not exist or is no such record.
std::vector<TruthRow> readTruthRecord(const std::string& path);

}  // namespace tread::sim
