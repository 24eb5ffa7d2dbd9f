// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

namespace tread::launch {

/// Something that supervisord has written to its log.
struct SupervisorEvent {
  enum class Kind { kSpawned, kRunning, kEnded, kGaveUp, kKilled, kStopped };
  Kind kind = Kind::kSpawned;
  std::string process;
  std::string detail;  ///< how it ended; the reason
};

/// The event of a line of supervisord's log (version 4.2); nothing for lines of no interest.
std::optional<SupervisorEvent> parseSupervisorLine(const std::string& line);

}  // namespace tread::launch
