// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/replay_check.hpp"

#include <algorithm>

#include "tools/replay/recipe.hpp"

namespace tread::replay {

void ReplayCheck::noteLog(const RobotLog& log, const std::string& process) {
  notes.push_back(intakeLine(log, process, playedChannels(process)));
  for (const auto& [channel, missing] : log.missing)
    notes.push_back("the log misses " + std::to_string(missing) + " messages on " + channel);
  if (!log.problem.empty()) notes.push_back(log.problem);
}

bool sameBytes(const std::vector<LogEvent>& a, const std::vector<LogEvent>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const LogEvent& x, const LogEvent& y) {
                      return x.utime == y.utime && x.channel == y.channel && x.bytes == y.bytes;
                    });
}

std::string countsText(const MessageCounts& counts, const std::string& unit) {
  return std::to_string(counts.equal) + unit + " equal, " + std::to_string(counts.different) +
         " different, " + std::to_string(counts.only_in_log) + " only in the log, " +
         std::to_string(counts.only_in_replay) + " only in the replay";
}

std::string notesText(const ReplayCheck& check) {
  std::string text;
  for (const std::string& line : check.notes) text += "  " + line + "\n";
  return text +
         "  replayed twice: " + (check.same_twice ? "the same bytes" : "NOT the same bytes") + "\n";
}

std::string differenceText(const ReplayCheck& check) {
  return check.first_difference.empty() ? ""
                                        : "  first difference: " + check.first_difference + "\n";
}

}  // namespace tread::replay
