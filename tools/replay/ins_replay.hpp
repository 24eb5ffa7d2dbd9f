// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tread/ins_t.hpp>

#include "modules/ins_driver/ins_driver_node.hpp"
#include "modules/ins_driver/nmea/nmea_ins.hpp"

namespace tread {

/// The output of ins_driver for a recorded device log.
struct InsReplay {
  ins::NmeaCounts counts;
  ins::AssemblerCounts epochs;
  std::optional<ins::GeoOrigin> origin;
  std::vector<ins_t> track;         ///< every INS message, in the order of publication
  std::optional<ins_t> first_pose;  ///< first with position and heading
  std::optional<ins_t> last_pose;   ///< last likewise
  int64_t poses = 0;                ///< messages with position and heading
  std::string health;               ///< last line of HEALTH; empty if all is well
};

/// Plays the bytes of an NMEA 0183 log to the real ins_driver node on the virtual bus, in the log's
/// own time.
/** Messages start at utime 1 s. The same log gives the same messages. */
InsReplay replayIns(const std::string& log, ins::InsDriverConfig config);

/// The same from a file; throws std::runtime_error with one clear line if it cannot be read.
InsReplay replayInsFile(const std::string& path, const ins::InsDriverConfig& config);

/// Counts, refusals with reasons, first and last pose: a few lines of text.
std::string reportOf(const InsReplay& replay);

/// Draws the track with headings; throws std::runtime_error if the file cannot be written.
void drawTrack(const InsReplay& replay, const std::string& title, const std::string& path);

}  // namespace tread
