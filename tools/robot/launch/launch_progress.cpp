// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/launch_progress.hpp"

#include <utility>

#include "common/report/text.hpp"

namespace tread::launch {
namespace {

constexpr const char* kExited = " exited: ";

/// The text after `mark`, or nothing if it does not stand in the line.
std::optional<std::string> after(const std::string& line, const std::string& mark) {
  const size_t at = line.find(mark);
  if (at == std::string::npos) return std::nullopt;
  return line.substr(at + mark.size());
}

/// What stands between the first two of `mark`.
std::string between(const std::string& text, char first, char last) {
  const size_t begin = text.find(first);
  const size_t end = text.find(last, begin + 1);
  if (begin == std::string::npos || end == std::string::npos) return "";
  return text.substr(begin + 1, end - begin - 1);
}

std::string firstWord(const std::string& text) {
  return text.substr(0, text.find(' '));
}

}  // namespace

LaunchProgress::LaunchProgress(std::string name, size_t processes)
    : name_(std::move(name)), processes_(processes) {}

bool LaunchProgress::isEnd(const std::string& log_line) {
  return after(log_line, kExited).has_value();
}

std::optional<std::string> LaunchProgress::lineFor(const std::string& log_line, double seconds) {
  if (const auto rest = after(log_line, " success: ")) return running(firstWord(*rest), seconds);
  if (const auto rest = after(log_line, kExited))
    return ended(firstWord(*rest), between(*rest, '(', ')'));
  if (const auto rest = after(log_line, " killing "))
    return name_ + ": " + between(*rest, '\'', '\'') + " did not stop in time and is killed";
  if (const auto rest = after(log_line, " gave up: "))
    return name_ + ": " + firstWord(*rest) + ": it never ran for a second";
  if (const auto rest = after(log_line, " spawnerr: ")) return name_ + ": " + *rest;
  return std::nullopt;
}

std::optional<std::string> LaunchProgress::ended(const std::string& process,
                                                 const std::string& how) {
  const int times = ++ends_[process];
  const std::string start = name_ + ": " + process;
  if (times == 1) return start + " ended (" + how + ")";
  if (times == 2)
    return start + " ended again (" + how + "); the pauses before it is started grow, see log/" +
           process + ".log";
  return std::nullopt;
}

std::optional<std::string> LaunchProgress::running(const std::string& process, double seconds) {
  const bool back = ends_.erase(process) > 0;
  const bool first = ran_.insert(process).second;
  if (first && ran_.size() == processes_)
    return formatted("%s: all %zu processes run after %.1f s", name_.c_str(), processes_, seconds);
  if (back) return name_ + ": " + process + " runs again";
  return std::nullopt;
}

}  // namespace tread::launch
