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
  std::vector<ins_t> poses;   ///< in order of time
  std::vector<scan_t> scans;  ///< in order of time
  /// [us] of the scans' last beams by the range finder's own clock, where it is steadier than their
  /// utime; else empty.
  std::vector<int64_t> device_times;
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

/// The output of ins_driver for a recorded device log.
struct InsReplay {
  ins::InsTally tally;
  ins::AssemblerCounts epochs;
  std::optional<ins::GeoOrigin> origin;
  std::vector<ins_t> track;         ///< every INS message, in the order of publication
  std::optional<ins_t> first_pose;  ///< first with position and heading
  std::optional<ins_t> last_pose;   ///< last likewise
  int64_t poses = 0;                ///< messages with position and heading
  std::string health;               ///< last line of HEALTH; empty if all is well
  std::string remedy;               ///< why all messages were refused; empty = not all, or no idea
  std::string notes;                ///< what of the log was not played, and why; lines of text
};

/// Plays the bytes of a device, or a capture (pcap, pcapng) of its datagrams or its TCP stream, to
/// the real ins_driver node on the virtual bus, in the log's own time.
/** Messages start at utime 1 s. The same log gives the same messages. Of a capture that stream is
 * played in which the instrument speaks. */
InsReplay replayIns(const std::string& log, ins::InsDriverConfig config);

/// The same from a file; throws std::runtime_error with one clear line if it cannot be read.
InsReplay replayInsFile(const std::string& path, const ins::InsDriverConfig& config);

/// Counts, refusals with reasons, first and last pose: a few lines of text.
std::string reportOf(const InsReplay& replay);

/// Draws the track with headings; throws std::runtime_error if the file cannot be written.
void drawTrack(const InsReplay& replay, const std::string& title, const std::string& path);

}  // namespace tread
