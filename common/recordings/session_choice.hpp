// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/recordings/drive_folder.hpp"

namespace tread::drive_patterns {

/// The robot that a part of its name means: the whole name, else its beginning, else any part.
/** Case does not matter; empty means the only robot. Throws DriveError that lists the robots if
 * none or several are meant. */
std::string chooseRobot(const std::vector<DriveSession>& sessions, const std::string& wanted);

/// Sessions that are compared with each other.
struct SessionChoice {
  std::vector<DriveSession> taken;    ///< in the order of sessions.csv
  std::vector<std::string> left_out;  ///< a line for each other session of the robot, with why
  double baseline = 0.0;              ///< [m] by which (v, w) are turned into wheel speeds
};

/// What makes sessions comparable.
struct ComparableLimits {
  size_t min_steps = 20;         ///< ok steps of a session
  double reach_quantile = 0.95;  ///< of |v| and |w| of a session, which must reach the patterns'
  double geometry_tolerance = 0.02;  ///< [1] of radius and baseline against most steps of the robot
};

/// |v| and |w| that a share of a session's ok commands does not exceed.
BodyCommand reachOf(const DriveSession& session, double quantile);

/// All sessions of the robot whose commands reach those of the patterns, on wheels of the same
/// geometry.
SessionChoice comparableSessions(const std::vector<DriveSession>& sessions,
                                 const std::string& robot, const BodyCommand& needed,
                                 const ComparableLimits& limits);

/// Exactly these. Throws DriveError for a name that is not one of the robot's sessions.
SessionChoice namedSessions(const std::vector<DriveSession>& sessions, const std::string& robot,
                            const std::vector<std::string>& names);

/// Surfaces of sessions, each once, in their order.
std::vector<std::string> surfacesOf(const std::vector<DriveSession>& sessions);

}  // namespace tread::drive_patterns
