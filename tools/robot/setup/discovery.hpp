// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/robot/setup/interview.hpp"
#include "tools/robot/setup/robot_folder.hpp"
#include "tools/robot/setup/site.hpp"

namespace tread::setup {

/// Finds out which port speaks what, with the drivers' own decoders, and notes it in `findings`.
/** First it only listens: INS and range finders that speak by themselves. Then it asks on what is
 * left: motor controllers are started up, which gives them zero, and range finders are told to
 * scan. A controller that never answers is asked for. Throws std::runtime_error with one line if
 * INS or controller are not found. */
void discover(Site& site, Interview& person, RobotFindings& findings);

}  // namespace tread::setup
