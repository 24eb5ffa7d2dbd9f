// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/drive/robot_log.hpp"
#include "modules/learner/learner_node.hpp"

namespace tread::report {

/// The learner's configuration from the log's CONFIG, with the shipped set named there; `overrides`
/// are KEY=VALUE that replace its values.
/** The checksum identifies the set: the log's first version, else one of the pattern files of
 * `patterns_folder`. Throws std::runtime_error with one clear line. */
learner::LearnerNodeConfig learnerConfigOf(const RobotLog& log, const std::string& patterns_folder,
                                           const std::vector<std::string>& overrides = {});

}  // namespace tread::report
