// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/drive/robot_log.hpp"
#include "modules/learner/learner_node.hpp"

namespace tread::report {

/// The learner's configuration as the log's CONFIG has it, with the shipped set that it names;
/// `overrides` are KEY=VALUE in the place of what it says.
/** The set is found by its checksum: as the log's first version, else among the pattern files of
 * `patterns_folder`. Throws std::runtime_error with one clear line. */
learner::LearnerNodeConfig learnerConfigOf(const RobotLog& log, const std::string& patterns_folder,
                                           const std::vector<std::string>& overrides = {});

}  // namespace tread::report
