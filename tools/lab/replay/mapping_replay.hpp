// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/replay/sensor_replay.hpp"

namespace tread {

/// The output of mapping for a recording.
struct MappingReplay {
  std::string name;
  TileMap map{0.1, 32};          ///< everything ever known, also outside of the present window
  std::vector<TimedPose> track;  ///< of the body
  int64_t scans = 0;             ///< in the recording
  int64_t skipped = 0;           ///< incomplete ones in the recording
  std::string problem;           ///< damage of the recording in one line
  std::map<std::string, int64_t> counters;  ///< counters of the last HEALTH
  int64_t tiles = 0;                        ///< messages on MAP
  double duration = 0.0;                    ///< [s] of the recording
  std::string health;                       ///< HEALTH at the end of the scans; empty if healthy
  Grid window;                              ///< the whole map
};

/// Plays a recording to the real mapping node on the virtual bus. The same recording gives the same
/// result.
MappingReplay replayMapping(const MappingRecording& recording);

/// Scans received, used, refused with reasons; path length, known area: a few lines of text.
std::string reportOf(const MappingReplay& replay);

/// Draws the map with the track; throws std::runtime_error if the file cannot be written.
void drawMap(const MappingReplay& replay, const std::string& path);

}  // namespace tread
