// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include <tread/ins_t.hpp>
#include <tread/scan_t.hpp>

#include "common/geometry/track.hpp"
#include "common/grid/grid.hpp"
#include "modules/mapping/mapping_node.hpp"

namespace tread {

/// A recording of range scans with poses, as Tread's messages.
struct MappingRecording {
  std::string name;
  std::vector<ins_t> poses;       ///< in order of time
  std::vector<scan_t> scans;      ///< in order of time
  int64_t skipped = 0;            ///< lines or messages of the recording that were not whole
  std::string problem;            ///< one clear line if the file is damaged; what is whole was read
  mapping::MappingConfig config;  ///< that fits its robot and its surroundings
};

/// Reads a recording by its name: *.gz and *.clf as CARMEN text with corrected poses (FLASER
/// lines), others as the LCM log of an MBot (2017).
/** Throws std::runtime_error with one clear line if it cannot be read or holds no scan. */
MappingRecording readMappingRecording(const std::string& path);

/// The output of mapping for a recording.
struct MappingReplay {
  std::string name;
  TileMap map{0.1, 32};          ///< all that was ever known, also after the window had moved on
  std::vector<TimedPose> track;  ///< of the body
  int64_t scans = 0;             ///< in the recording
  int64_t skipped = 0;           ///< not whole in the recording
  std::string problem;           ///< one clear line if the recording is damaged
  std::map<std::string, int64_t> counters;  ///< mapping's own, from its last HEALTH
  int64_t tiles = 0;                        ///< messages on MAP
  double duration = 0.0;                    ///< [s] of the recording
  std::string health;  ///< line of HEALTH at the end of the scans; empty if all is well
  Grid window;         ///< the whole map
};

/// Plays a recording to the real mapping node on the virtual bus. Same recording, same result.
MappingReplay replayMapping(const MappingRecording& recording);

/// Scans in, taken, refused with reasons; the way, the area known: a few lines of text.
std::string reportOf(const MappingReplay& replay);

/// Draws the map with the track; throws std::runtime_error if the file cannot be written.
void drawMap(const MappingReplay& replay, const std::string& path);

}  // namespace tread
