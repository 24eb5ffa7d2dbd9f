// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/narrator.hpp"

#include <cstdio>
#include <utility>

namespace tread::launch {

Narrator::Narrator(std::string name, size_t processes)
    : name_(std::move(name)), processes_(processes) {}

std::optional<std::string> Narrator::tell(const SupervisorEvent& event, double seconds) {
  using Kind = SupervisorEvent::Kind;
  const std::string start = name_ + ": " + event.process;
  switch (event.kind) {
    case Kind::kRunning:
      return running(event.process, seconds);
    case Kind::kEnded:
      return ended(event);
    case Kind::kKilled:
      return start + " did not stop in time and is killed";
    case Kind::kGaveUp:
      return (event.process.empty() ? name_ : start) + ": " + event.detail;
    case Kind::kSpawned:
    case Kind::kStopped:
      return std::nullopt;
  }
  return std::nullopt;
}

std::optional<std::string> Narrator::ended(const SupervisorEvent& event) {
  const int times = ++ends_[event.process];
  const std::string start = name_ + ": " + event.process;
  if (times == 1) return start + " ended (" + event.detail + ")";
  if (times == 2)
    return start + " ended again (" + event.detail + "); it is tried ever more rarely, see log/" +
           event.process + ".log";
  return std::nullopt;
}

std::optional<std::string> Narrator::running(const std::string& process, double seconds) {
  const bool back = ends_.erase(process) > 0;
  const bool first = ran_.insert(process).second;
  if (first && ran_.size() == processes_) {
    char text[160];
    std::snprintf(text, sizeof text, "%s: all %zu processes run after %.1f s", name_.c_str(),
                  processes_, seconds);
    return text;
  }
  if (back) return name_ + ": " + process + " runs again";
  return std::nullopt;
}

}  // namespace tread::launch
