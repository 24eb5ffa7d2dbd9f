// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "tools/robot/launch/supervisor_log.hpp"

namespace tread::launch {

/// Tells in one line each what a person wants to know of a launch: that all processes run, which
/// one ended and how, that it runs again.
class Narrator {
 public:
  Narrator(std::string name, size_t processes);
  /// The line for an event, if it is worth one; `seconds` since the start.
  std::optional<std::string> tell(const SupervisorEvent& event, double seconds);

 private:
  std::optional<std::string> ended(const SupervisorEvent& event);
  std::optional<std::string> running(const std::string& process, double seconds);

  std::string name_;
  size_t processes_;
  std::set<std::string> ran_;        ///< have run at least once
  std::map<std::string, int> ends_;  ///< how often in a row; absent = runs
};

}  // namespace tread::launch
