// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/experiment/adaptation/driving.hpp"

namespace tread::adaptation {

/// The recordings, and a line for each unusable one.
struct Recordings {
  std::vector<SampledSession> sessions;  ///< with at least one piece
  std::vector<std::string> notes;
};

/// Reads a folder of drives (sessions.csv) or of LCM logs (*.lcmlog).
/** Separately recorded steps are joined if the motion continued. For a log the vehicle comes from
 * its import, the surface from its first mark. Throws with one line if there is nothing to read. */
Recordings readRecordings(const std::string& folder);

}  // namespace tread::adaptation
