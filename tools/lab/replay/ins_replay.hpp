// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tread/ins_t.hpp>

#include "modules/ins_driver/core/ins_assembler.hpp"
#include "modules/ins_driver/core/ins_source.hpp"
#include "modules/ins_driver/ins_driver_node.hpp"

namespace tread {

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
