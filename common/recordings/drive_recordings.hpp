// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/recordings/local_motion.hpp"
#include "common/recordings/recordings.hpp"

// Recordings of the same patterns on several surfaces, built from drives in which no command was
// ever given twice: windows of each surface are moved to the patterns' commands (local_motion.hpp)
// and integrated. Nothing about any robot, surface or session is known here. Units: m, rad, s.
namespace tread::recordings {

/// What is made of a folder of drives.
struct DriveRequest {
  std::string folder;                 ///< sessions.csv, steps_quality.csv, steps/
  std::string robot;                  ///< part of its name; empty = the only one
  std::vector<std::string> sessions;  ///< empty = all that are comparable
  PatternRecipe recipe = defaultRecipe();
  /// The commands may be made smaller where too few surfaces were driven with as large ones.
  bool fit_recipe = true;
  size_t min_surfaces = 2;
};

/// Windows of a surface.
struct SurfaceWindows {
  std::string surface;                ///< as the sessions call it
  std::vector<std::string> sessions;  ///< that it was driven in
  std::vector<SteadyWindow> used;
  std::map<std::string, int> left_out;  ///< windows by reason
};

/// What came of a surface.
struct SurfaceSummary {
  std::string surface;  ///< the name of its recordings
  std::vector<std::string> sessions;
  size_t windows = 0;
  std::map<std::string, int> left_out;
  std::vector<LocalMotion> motions;  ///< by pattern
};

/// Recordings and how they came about.
struct DriveRecordings {
  PatternRecordings recordings;
  std::string robot;
  std::vector<std::string> notes;  ///< sessions and surfaces left out, commands made smaller
  std::vector<SurfaceSummary> surfaces;
};

/// A surface's name as a file may be called: letters, digits, '-' and '_'.
std::string fileName(const std::string& surface);

/// The recordings of windows that are already there; `notes` gets a line for each surface left out.
/** Track commands by `baseline` [m]. Entry and exit class of a pattern is its own steady motion,
 * the mean over the surfaces. Throws RecordingError if fewer than `min_surfaces` are left. */
DriveRecordings recordingsOf(const std::vector<SurfaceWindows>& windows,
                             const PatternRecipe& recipe, double baseline, size_t min_surfaces);

/// Reads the folder and makes recordings of it; throws RecordingError or RecordingError, one line
/// each.
DriveRecordings recordingsFromDrives(const DriveRequest& request);

/// The averaged set of a surface (index into the recordings): what a robot that knows this surface
/// ships with. Its classes are this surface's own steady motions.
PatternSet averagedSet(const DriveRecordings& drives, size_t surface);

/// Lines for people: what was used and left out, and each pattern's mean twist and spread.
std::string reportOf(const DriveRecordings& drives);

}  // namespace tread::recordings
