// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/recordings/steady_window.hpp"

// A folder of recorded drives: sessions.csv (robot, surface, geometry, lag of the poses),
// steps_quality.csv (each held command, and whether its step is fit for use), steps/SESSION.csv
// (what was driven, at 20 Hz, by step and window). Further columns and files are not looked at.
namespace tread::drive_patterns {

/// One held command of a session.
struct CommandStep {
  int number = 0;
  TrackCommand tracks;  ///< [m/s] of the wheels' rims, as commanded
  bool ok = false;
};

/// One session as the two tables tell of it.
struct DriveSession {
  std::string name;
  std::string robot;
  std::string surface;
  double wheel_radius = 0.0;  ///< [m]
  double baseline = 0.0;      ///< [m] by which (v, w) became wheel speeds
  double pose_lag = 0.0;      ///< [s] poses are logged this long after they were measured
  std::string problem;        ///< why its row cannot be used, in words; empty if it can
  std::vector<CommandStep> steps;

  size_t okSteps() const;
};

/// (v, w) of an ideal differential drive of this baseline.
BodyCommand bodyCommand(const TrackCommand& tracks, double baseline);
/// And back.
TrackCommand trackCommand(const BodyCommand& command, double baseline);

/// All sessions of a folder, in the order of sessions.csv.
/** Throws importer::ImportError with one clear line for a file that is missing or damaged. */
std::vector<DriveSession> readSessions(const std::string& folder);

/// The steady windows (1 and 2) of a session, those that were left out by reason.
struct SessionWindows {
  std::vector<SteadyWindow> used;
  std::map<std::string, int> left_out;
};

/// Reads steps/SESSION.csv and smooths its steady windows; commands by the reference baseline.
/** A window's poses are its own rows with a new pose; the first row is not used, because windows
 * were joined there. They were measured one pose lag before they were logged, so that a window of
 * [t, t + T] tells of [t - lag, t + T - lag]; what of it lies before the motion has settled is not
 * used. The profile is centred on the rest. Throws importer::ImportError. */
SessionWindows readWindows(const std::string& folder, const DriveSession& session, double baseline,
                           double duration, const SmoothingLimits& limits);

}  // namespace tread::drive_patterns
