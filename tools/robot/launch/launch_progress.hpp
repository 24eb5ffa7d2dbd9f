// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

namespace tread::launch {

/// Turns supervisord's log (version 4.2) into a few lines for people: that all processes run, which
/// one ended and how, that it runs again.
class LaunchProgress {
 public:
  LaunchProgress(std::string name, size_t processes);
  /// What to print for a line of the log, if anything; `seconds` since the start.
  std::optional<std::string> lineFor(const std::string& log_line, double seconds);
  /// Whether a line of the log says that a process ended by itself.
  static bool isEnd(const std::string& log_line);

 private:
  std::optional<std::string> running(const std::string& process, double seconds);
  std::optional<std::string> ended(const std::string& process, const std::string& how);

  std::string name_;
  size_t processes_;
  std::set<std::string> ran_;        ///< have run at least once
  std::map<std::string, int> ends_;  ///< how often in a row; absent = runs
};

}  // namespace tread::launch
