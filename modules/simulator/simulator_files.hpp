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

/// Reads a kind of ground: what it differs in from a built-in one (key `like`).
SurfaceParameters readSurface(ConfigReader& reader);

/// Reads height, wavelengths and seed of bumps; what is not named stays as it is.
void readBumps(ConfigReader& reader, RoughRegion& region);

/// Reads a world file (config/worlds); throws ConfigError with file:line.
WorldDescription readWorld(const std::string& path);
/// The same from a map in another file.
WorldDescription readWorld(ConfigReader reader);
/// The same from text; `name` stands for the file in messages.
WorldDescription parseWorld(const std::string& text, const std::string& name);

/// Reads a dynamic vehicle in physical quantities. The ranges keep the integration stable at 1 ms.
/** What is not named stays as it is; with `whole`, what is of this machine alone must be named. So
 * a drive that has lost power or a weak battery is hidden behind the serial lines. */
void readVehicle(ConfigReader reader, VehicleParameters& vehicle, bool whole = false);

/// The simulated robot of a configuration: keys `robot` and `dynamics`, each a file or a map.
/** Outline, mountings and, unless dynamics.yaml says otherwise, gauge and free speed are the
 * described robot's (robot.yaml), the rest of the vehicle stands in dynamics.yaml; both beside the
 * configuration if they are not named. Its map `laser` (beams, rate, field_of_view, range_max,
 * range_noise) replaces the laser's usual numbers. */
void readSimulatedRobot(ConfigReader& reader, RobotSettings& settings);

/// The same from a robot's folder.
RobotSettings readSimulatedRobot(const std::string& folder);

/// What really happened, as CSV for reports and tests; the robot's processes never see it.
/** One row when the power on the motors changes, else every 20 ms:
 * utime_us,x_m,y_m,yaw_rad,v_mps,left,right,surface,contacts,distance_m. Yaw is unwrapped, power
 * is what the controller puts on the motors (-1..1); of a holonomic base, that of the first two
 * wheels stands there. */
class TruthRecord {
 public:
  /// Makes the file with its header; an earlier record becomes PATH.1 or the next free name. Throws
  /// WriteError, as all do.
  explicit TruthRecord(const std::string& path);

  void note(const RobotTruth& truth, const MotorValues& power);
  /// Hands over the rows of the last moments, too.
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
  std::array<double, 2> power{0.0, 0.0};  ///< on the motors: left, right, -1..1
  std::string surface;
  int contacts = 0;       ///< so far
  double distance = 0.0;  ///< driven so far [m]

  bool motorsAtZero() const { return power[0] == 0.0 && power[1] == 0.0; }
};

/// The whole rows that are in a record by now; a half written last one is left out. Throws
/// std::runtime_error with one clear line if the file is not there or no such record.
std::vector<TruthRow> readTruthRecord(const std::string& path);

}  // namespace tread::sim
