// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/recordings/pattern_recipe.hpp"
#include "common/recordings/twist_profile.hpp"

namespace tread::drive_patterns {

/// A steady window of a command step, smoothed.
struct SteadyWindow {
  std::string session;
  int step = 0;         ///< number of the command in its session
  int window = 0;       ///< 1 or 2 within its step
  BodyCommand command;  ///< by the reference baseline of the robot
  TwistProfile profile;
};

}  // namespace tread::drive_patterns
