// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/config/config_reader.hpp"

namespace tread::drive_patterns {

/// What the wheels are told, as body motion of an ideal differential drive.
struct BodyCommand {
  double v = 0.0;  ///< [m/s] + forward
  double w = 0.0;  ///< [rad/s] + counter-clockwise
};

/// One pattern to build: its command held for its whole length.
struct PatternWish {
  std::string name;
  BodyCommand command;
};

/// Which patterns are built from drives, and how.
struct PatternRecipe {
  std::string name = "drive";
  double period = 0.05;  ///< [s] of the recordings' commands
  double length = 2.0;   ///< [s] of a pattern; that of a steady window
  int neighbours = 30;   ///< windows nearest to a command that its mean comes from
  int deviations =
      15;  ///< steps whose deviation is used, with both signs: twice as many recordings
  std::vector<PatternWish> patterns;

  size_t samples() const;
  /// Largest |v| and |w| among the commands; at least 0.01.
  BodyCommand reach() const;
};

/// What is built without --recipe; config/patterns/recipes/drive.yaml says the same.
PatternRecipe defaultRecipe();

/// Reads a recipe; throws ConfigError at file:line.
PatternRecipe readRecipe(ConfigReader reader);

/// The same with all v and all w multiplied.
PatternRecipe scaledRecipe(PatternRecipe recipe, double v_factor, double w_factor);

}  // namespace tread::drive_patterns
