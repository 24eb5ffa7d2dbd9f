// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/recordings/local_motion.hpp"
#include "common/recordings/recordings.hpp"

// What a command does on a surface, from windows of commands around it:
//   1. distance of windows: d^2 = ((v_i - v) / v_max)^2 + ((w_i - w) / w_max)^2, with the largest
//      |v| and |w| of the patterns; the nearest k are taken;
//   2. local-linear regression, for each component c of the twist profile (mean and slope):
//      c_i = c + g_v (v_i - v) + g_w (w_i - w) + e_i, Huber's loss, weights (1 - (d_i / h)^3)^3
//      with h beyond the farthest, so that what bends far away does not pull: c is the profile at
//      the command itself;
//   3. deviations of executions: (c_1 - c_2) / sqrt(2) of the two windows of one step, whose
//      commands are the same: its variance is that of one window about its step. Both signs are
//      used, so that deviations have no mean. A step is left out if a component of its difference
//      is beyond 3.5 robust standard deviations (1.4826 median), both of all steps and of the
//      nearest (twice as many as are used): speed that changes by metres per second under a
//      constant command is a failure of the lidar's poses.

// Recordings of the same patterns on several surfaces, built from drives in which no command was
// given twice: the windows of each surface are shifted to the patterns' commands (above) and
// integrated. This code knows no particular robot, surface or session. Units: m, rad, s.
namespace tread::recordings {

/// A request to build recordings from a folder of drives.
struct DriveRequest {
  std::string folder;                 ///< sessions.csv, steps_quality.csv, steps/
  std::string robot;                  ///< part of the robot's name; empty = the only one
  std::vector<std::string> sessions;  ///< empty = all that are comparable
  PatternRecipe recipe = defaultRecipe();
  /// Commands may be reduced if too few surfaces were driven with commands that large.
  bool fit_recipe = true;
  size_t min_surfaces = 2;
};

/// Windows of a surface.
struct SurfaceWindows {
  std::string surface;                ///< as the sessions call it
  std::vector<std::string> sessions;  ///< on this surface
  std::vector<SteadyWindow> used;
  std::map<std::string, int> left_out;  ///< windows by reason
};

/// Result for one surface.
struct SurfaceSummary {
  std::string surface;  ///< the name of its recordings
  std::vector<std::string> sessions;
  size_t windows = 0;
  std::map<std::string, int> left_out;
  std::vector<LocalMotion> motions;  ///< by pattern
};

/// Recordings and their origin.
struct DriveRecordings {
  PatternRecordings recordings;
  std::string robot;
  std::vector<std::string> notes;  ///< sessions and surfaces left out, reduced commands
  std::vector<SurfaceSummary> surfaces;
};

/// A surface's name as a file name: letters, digits, '-' and '_'.
std::string fileName(const std::string& surface);

/// Makes recordings from given windows; `notes` gets a line for each surface left out.
/** Track commands by `baseline` [m]. Entry and exit class of a pattern is its own steady motion,
 * averaged over the surfaces. Throws RecordingError if fewer than `min_surfaces` remain. */
DriveRecordings recordingsOf(const std::vector<SurfaceWindows>& windows,
                             const PatternRecipe& recipe, double baseline, size_t min_surfaces);

/// Reads the folder and makes recordings of it; throws RecordingError with one line.
DriveRecordings recordingsFromDrives(const DriveRequest& request);

/// The averaged set of a surface (index into the recordings): the set to ship with a robot on this
/// surface. Its classes are this surface's own steady motions.
PatternSet averagedSet(const DriveRecordings& drives, size_t surface);

/// Lines for people: what was used and left out, and each pattern's mean twist and spread.
std::string reportOf(const DriveRecordings& drives);

}  // namespace tread::recordings
