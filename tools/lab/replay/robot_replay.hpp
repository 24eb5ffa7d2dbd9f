// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/channels.hpp"
#include "common/drive/robot_log.hpp"
#include "modules/learner/core/learner.hpp"
#include "modules/learner/learner_node.hpp"
#include "modules/planner/planner_node.hpp"
#include "tools/lab/replay/replay_check.hpp"

namespace tread::replay {

/// Compares messages by key. `difference(log, replay)` is empty for equal messages; `name(key)` is
/// for the report. Messages only in the replay do not count as differences if their key is in
/// `late`, or up to the number that the log is known to lack (`lost`).
template <class Key, class Message, class Difference, class Name>
MessageCounts compareByKey(const std::map<Key, Message>& log, const std::map<Key, Message>& replay,
                           const std::set<Key>& late, int64_t lost, Difference difference,
                           Name name, ReplayCheck& check) {
  MessageCounts counts;
  for (const auto& [key, message] : log) {
    const auto found = replay.find(key);
    if (found == replay.end()) {
      ++counts.only_in_log;
      check.noteDifference(name(key) + ": in the log, not in the replay");
      continue;
    }
    const std::string differs = difference(message, found->second);
    ++(differs.empty() ? counts.equal : counts.different);
    if (!differs.empty()) check.noteDifference(differs);
  }
  std::vector<Key> unexplained;
  for (const auto& [key, message] : replay) {
    if (log.count(key) > 0) continue;
    ++counts.only_in_replay;
    if (late.count(key) == 0) unexplained.push_back(key);
  }
  if (static_cast<int64_t>(unexplained.size()) > lost)
    check.noteDifference(name(unexplained.front()) + ": in the replay, not in the log");
  return counts;
}

/// The planner's configuration from the log's CONFIG. Throws std::runtime_error with one clear
/// line.
planner::PlannerConfig plannerConfigOf(const RobotLog& log,
                                       const std::vector<std::string>& overrides = {});

}  // namespace tread::replay
