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

/// A column of a table, and what its numbers mean.
struct CsvColumn {
  std::string column;   ///< name, or number from 1
  double factor = 1.0;  ///< from the column's number to m, rad, s, m/s, V, A, or power -1..1
  double limit = 0.0;   ///< larger magnitudes are refused, after the factor
  std::vector<std::string> other_units;  ///< it might be in, but is not by the mapping
};

/// A CSV file of a recording.
struct CsvSource {
  std::string file;  ///< relative to the recording's folder; empty: the recording is this file
  recordings::CsvLayout layout;
  std::string time;        ///< column of the time; empty: rows come at `rate`
  double time_unit = 1.0;  ///< [s]
  std::vector<std::string> other_time_units;
  double time_offset = 0.0;         ///< [s] added, where its clock is another one
  double rate = 0.0;                ///< [Hz]
  std::vector<std::string> ground;  ///< columns that name the ground, one or one for each wheel
  std::string run;  ///< column: another value begins another drive, with a time of its own
  std::map<std::string, std::vector<double>> only;  ///< columns: rows with other numbers are no
                                                    ///< part of the drive
  std::map<std::string, CsvColumn> columns;         ///< by quantity, see csv_mapping.cpp
};

/// What a recording in CSV means: a mapping file.
struct CsvMapping {
  std::string robot = "robot of a CSV file";
  std::string surface;       ///< empty: not said
  double baseline = 0.0;     ///< [m] between the tracks; 0 = unknown
  CommandChannels channels;  ///< in the order of the columns; left and right first
  /// [s] a command is known to hold where none follows; nothing: as its period allows.
  std::optional<double> command_hold;
  std::vector<CsvSource> sources;
  /// Where the map's origin is: metres where positions are x and y; degrees, degrees and metres
  /// where they are latitude and longitude. Nothing: where they are zero, or at the first fix.
  std::optional<Eigen::Vector3d> origin;
  bool origin_at_first_fix = false;
  double yaw_sense = 1.0;  ///< -1: the column counts clockwise
  double yaw_zero = 0.0;   ///< [rad] where the column's zero looks in the map
  /// [m/s] from here on the course over ground is the heading; nothing: a column holds it.
  std::optional<double> course_above;

  bool has(const std::string& quantity) const;
  bool isOfTracks() const { return kindOfTracks(channels).has_value(); }
};

/// Reads a mapping file; throws ConfigError with file:line.
/** Quantities: NAME_command, NAME_speed and NAME_current of each channel of the commands (left and
 *  right of a vehicle with tracks), voltage, x, y, z, latitude, longitude, height, yaw, roll,
 *  pitch, qw, qx, qy, qz (of R_map_body), yaw_rate, and pose_new: 0 where a row repeats a pose.
 *  Roll, pitch and quaternion are those of a body with x forward, y left and z up. A position and
 *  its heading stand in one file. The unit of a command says what kind it is of. */
CsvMapping readCsvMapping(ConfigReader& reader);

}  // namespace tread::import
