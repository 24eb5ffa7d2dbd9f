// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/recordings/sessions.hpp"

namespace tread::recordings {

/// One pattern to build: its command, held for its whole length.
struct PatternWish {
  std::string name;
  BodyCommand command;
};

/// Which patterns are built from drives, and how.
struct PatternRecipe {
  std::string name = "drive";
  double period = 0.05;  ///< [s] of the recordings' commands
  double length = 2.0;   ///< [s] of a pattern; equal to that of a steady window
  int neighbours = 30;   ///< number of windows nearest to a command whose mean is taken
  int deviations = 15;   ///< number of steps whose deviation is used, with both signs: gives twice
                         ///< as many recordings
  std::vector<PatternWish> patterns;

  size_t samples() const;
  /// Largest |v| and |w| among the commands; at least 0.01.
  BodyCommand reach() const;
};

/// The recipe used without --recipe; equal to config/patterns/recipes/drive.yaml.
PatternRecipe defaultRecipe();

/// Reads a recipe; throws ConfigError at file:line.
PatternRecipe readRecipe(ConfigReader reader);

/// The same with all v and all w multiplied.
PatternRecipe scaledRecipe(PatternRecipe recipe, double v_factor, double w_factor);

/// Motion of one pattern on one surface.
struct LocalMotion {
  TwistLine mean;
  std::vector<TwistLine> deviations;  ///< of one sign; use both + and -
  size_t implausible = 0;  ///< steps not used for deviations because their windows disagree
  double reach = 0.0;      ///< [1] distance of the farthest window used
  size_t windows = 0;      ///< used for the mean
};

/// The motion for a command; `reach` holds the largest |v| and |w| of the patterns.
/** Throws RecordingError if there are fewer windows than neighbours required, fewer than
 * `deviations` steps with two windows that agree, or no window with a command this large. */
LocalMotion localMotion(const std::vector<SteadyWindow>& windows, const BodyCommand& command,
                        const PatternRecipe& recipe);

/// Profiles of all recordings of a motion: the mean plus and minus each deviation.
std::vector<TwistLine> recordedProfiles(const LocalMotion& motion);

}  // namespace tread::recordings
