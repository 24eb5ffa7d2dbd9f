// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace tread::ins {

/// Lines of a recorded log that the device sent together.
struct NmeaBurst {
  int64_t utime = 0;       ///< when to play it, since the start of the log [us]
  std::string_view bytes;  ///< part of the log
};

/// Gives a recorded log its timing back, from the UTC in its sentences.
/** A burst starts where the time changes or where a sentence without a time comes again. Bursts
   without any time share the span to the next one that has it. Without such a span, or where time
   runs backwards, a burst follows 100 ms after the one before; pauses are cut to 60 s. The bytes of
   the bursts together are the log. */
std::vector<NmeaBurst> scheduleNmeaLog(std::string_view log);

}  // namespace tread::ins
