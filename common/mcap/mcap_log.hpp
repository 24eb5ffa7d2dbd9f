// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/log/event_log.hpp"

namespace tread::mcap {

/// What became of the messages in an MCAP file.
struct McapCounts {
  int64_t taken = 0;
  std::map<std::string, int64_t> left_out;  ///< by topic and why
  std::map<std::string, int64_t> lost;      ///< lost messages of Tread, by topic and reason
  uint64_t lost_bytes = 0;                  ///< of the file
  uint64_t bytes = 0;                       ///< all of it
  bool cut_off = false;                     ///< more messages may have followed
  std::string problem;                      ///< one clear line if the file is damaged
};

/// Writes Tread's messages in an MCAP file (JSON, as written by tread-export) to a log, each at its
/// time of recording and in the order of these times.
/** Throws std::runtime_error with one clear line if the file cannot be read or holds none of
 * Tread's messages. */
McapCounts writeLog(const std::string& path, LogWriter& log);

}  // namespace tread::mcap
