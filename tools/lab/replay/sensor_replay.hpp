// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tread/ins_t.hpp>
#include <tread/scan_t.hpp>

#include "common/geometry/track.hpp"
#include "common/grid/grid.hpp"
#include "modules/ins_driver/core/ins_pipeline.hpp"
#include "modules/ins_driver/ins_driver_node.hpp"
#include "modules/mapping/mapping_node.hpp"

namespace tread {

/// A recording of range scans with poses, as Tread's messages.
struct MappingRecording {
  std::string name;
  std::vector<ins_t> poses;   ///< ordered by time
  std::vector<scan_t> scans;  ///< ordered by time
  /// [us] times of the scans' last beams by the range finder's clock, if it is steadier than their
  /// utime; else empty.
  std::vector<int64_t> device_times;
  int64_t skipped = 0;  ///< incomplete lines or messages of the recording
  std::string problem;  ///< one clear line if the file is damaged; the undamaged part was read
  mapping::MappingConfig config;  ///< for its robot and environment
};

/// Reads a recording: *.gz and *.clf as CARMEN text with corrected poses (FLASER lines), other
/// names as the LCM log of an MBot (2017).
/** Throws std::runtime_error with one clear line if it cannot be read or contains no scan. */
MappingRecording readMappingRecording(const std::string& path);

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

/// The output of ins_driver for a recorded device log.
struct InsReplay {
  ins::InsTally tally;
  ins::AssemblerCounts epochs;
  std::optional<ins::GeoOrigin> origin;
  std::vector<ins_t> track;         ///< every INS message, in order
  std::optional<ins_t> first_pose;  ///< first with position and heading
  std::optional<ins_t> last_pose;   ///< last likewise
  int64_t poses = 0;                ///< messages with position and heading
  std::string health;               ///< last reason of HEALTH; empty if healthy
  std::string remedy;               ///< likely cause if all messages were refused; else empty
  std::string notes;  ///< parts of the log that were not played, with reasons; lines of text
};

/// Plays a device's bytes, or a capture (pcap, pcapng) of its datagrams or TCP stream, to the real
/// ins_driver node on the virtual bus, in the log's own time.
/** Messages start at utime 1 s. The same log gives the same messages. From a capture the stream
 * with the instrument's data is played. */
InsReplay replayIns(const std::string& log, ins::InsDriverConfig config);

/// The same from a file; throws std::runtime_error with one clear line if it cannot be read.
InsReplay replayInsFile(const std::string& path, const ins::InsDriverConfig& config);

/// Counts, refusals with reasons, first and last pose: a few lines of text.
std::string reportOf(const InsReplay& replay);

/// Draws the track with headings; throws std::runtime_error if the file cannot be written.
void drawTrack(const InsReplay& replay, const std::string& title, const std::string& path);

}  // namespace tread
