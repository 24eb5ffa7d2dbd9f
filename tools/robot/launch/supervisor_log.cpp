// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/supervisor_log.hpp"

namespace tread::launch {
namespace {

using Kind = SupervisorEvent::Kind;

/// The text after `mark`, or nothing if it does not stand in the line.
std::optional<std::string> after(const std::string& line, const std::string& mark) {
  const size_t at = line.find(mark);
  if (at == std::string::npos) return std::nullopt;
  return line.substr(at + mark.size());
}

/// What stands between the first two of `mark`.
std::string between(const std::string& text, const std::string& first, const std::string& last) {
  const size_t begin = text.find(first);
  const size_t end = text.find(last, begin + first.size());
  if (begin == std::string::npos || end == std::string::npos) return "";
  return text.substr(begin + first.size(), end - begin - first.size());
}

std::string firstWord(const std::string& text) {
  return text.substr(0, text.find(' '));
}

}  // namespace

std::optional<SupervisorEvent> parseSupervisorLine(const std::string& line) {
  if (const auto rest = after(line, " spawned: "))
    return SupervisorEvent{Kind::kSpawned, between(*rest, "'", "'"), ""};
  if (const auto rest = after(line, " success: "))
    return SupervisorEvent{Kind::kRunning, firstWord(*rest), ""};
  if (const auto rest = after(line, " exited: "))
    return SupervisorEvent{Kind::kEnded, firstWord(*rest), between(*rest, "(", ")")};
  if (const auto rest = after(line, " stopped: "))
    return SupervisorEvent{Kind::kStopped, firstWord(*rest), between(*rest, "(", ")")};
  if (const auto rest = after(line, " gave up: "))
    return SupervisorEvent{Kind::kGaveUp, firstWord(*rest), "it never ran for a second"};
  if (const auto rest = after(line, " killing "))
    return SupervisorEvent{Kind::kKilled, between(*rest, "'", "'"), ""};
  if (const auto rest = after(line, " spawnerr: "))
    return SupervisorEvent{Kind::kGaveUp, "", *rest};
  return std::nullopt;
}

}  // namespace tread::launch
