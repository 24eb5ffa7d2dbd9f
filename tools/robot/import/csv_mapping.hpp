// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/config/config_reader.hpp"
#include "common/pattern/pattern.hpp"
#include "common/recordings/csv_table.hpp"

namespace tread::import {

/// A column of a table and its meaning.
struct CsvColumn {
  std::string column;   ///< name, or number from 1
  double factor = 1.0;  ///< converts the column to m, rad, s, m/s, V, A, or power -1..1
  double limit = 0.0;   ///< magnitudes above are refused, after the factor
  std::vector<std::string> other_units;  ///< plausible units other than that of the mapping
};

/// A CSV file of a recording.
struct CsvSource {
  std::string file;  ///< relative to the recording's folder; empty: the recording is one file
  recordings::CsvLayout layout;
  std::string time;        ///< time column; empty: rows are `rate` apart
  double time_unit = 1.0;  ///< [s]
  std::vector<std::string> other_time_units;
  double time_offset = 0.0;         ///< [s] added to the times, for a different clock
  double rate = 0.0;                ///< [Hz]
  std::vector<std::string> ground;  ///< columns with the surface, one in all or one per wheel
  std::string run;                  ///< column whose change starts a new drive, with its own time
  /// Columns with allowed values; other rows are skipped
  std::map<std::string, std::vector<double>> only;
  std::map<std::string, CsvColumn> columns;  ///< by quantity, see csv_mapping.cpp
};

/// Meaning of a CSV recording, from a mapping file.
struct CsvMapping {
  std::string robot = "robot of a CSV file";
  std::string surface;       ///< empty: not given
  double baseline = 0.0;     ///< [m] between the tracks; 0 = unknown
  CommandChannels channels;  ///< in the order of the columns, left and right first
  /// [s] a command holds where none follows; nullopt: derived from its period.
  std::optional<double> command_hold;
  std::vector<CsvSource> sources;
  /// Origin of the map: metres for positions in x and y; degrees, degrees and metres for latitude
  /// and longitude. nullopt: zero, or the first fix.
  std::optional<Eigen::Vector3d> origin;
  bool origin_at_first_fix = false;
  double yaw_sense = 1.0;  ///< -1: the column is positive clockwise
  double yaw_zero = 0.0;   ///< [rad] direction in the map of the column's zero
  /// [m/s] above it the course over ground is the heading; nullopt: a column holds the heading.
  std::optional<double> course_above;

  bool has(const std::string& quantity) const;
  bool isOfTracks() const { return kindOfTracks(channels).has_value(); }
};

/// Reads a mapping file; throws ConfigError with file:line.
/** Quantities: NAME_command, NAME_speed and NAME_current of each channel of the commands (left and
 *  right of a vehicle with tracks), voltage, x, y, z, latitude, longitude, height, yaw, roll,
 *  pitch, qw, qx, qy, qz (of R_map_body), yaw_rate, and pose_new: 0 where a row repeats a pose.
 *  Roll, pitch and quaternion are those of a body with x forward, y left and z up. A position and
 *  its heading must be in the same file. The unit of a command determines its kind. */
CsvMapping readCsvMapping(ConfigReader& reader);

}  // namespace tread::import
