// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/log/event_log.hpp"

namespace tread::mcap {

/// What became of an MCAP file's messages.
struct McapCounts {
  int64_t taken = 0;
  std::map<std::string, int64_t> left_out;  ///< by topic and why
  std::map<std::string, int64_t> lost;      ///< messages of Tread's, by topic and why
  uint64_t lost_bytes = 0;                  ///< of the file
  uint64_t bytes = 0;                       ///< all of it
  bool cut_off = false;                     ///< more may have stood behind them
  std::string problem;                      ///< one clear line if the file is damaged
};

/// Writes the messages of an MCAP file that are Tread's (JSON, as tread-export writes it) to a log,
/// each at the time at which it was recorded and in the order of these times.
/** Throws std::runtime_error with one clear line if the file cannot be read or holds none. */
McapCounts writeLog(const std::string& path, LogWriter& log);

}  // namespace tread::mcap
