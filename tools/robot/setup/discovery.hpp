// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/robot/setup/interview.hpp"
#include "tools/robot/setup/robot_folder.hpp"
#include "tools/robot/setup/site.hpp"

namespace tread::setup {

/// Identifies the device at each port with the drivers' own decoders, and stores it in `findings`.
/** First it only listens, for INS and range finders that send by themselves. Then it queries the
 * remaining ports: it starts motor controllers, which sets them to zero, and asks range finders to
 * scan. It asks the person for a controller that never answers. Throws std::runtime_error with one
 * line if INS or controller are not found. */
void discover(Site& site, Interview& person, RobotFindings& findings);

}  // namespace tread::setup
