// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/drive/drive_log.hpp"

namespace tread {

/// How much an event matters.
enum class Severity { kInfo, kWarning, kError };

/// Something that happened, in words.
struct Event {
  int64_t utime = 0;  ///< [us] when it was recorded
  Severity severity = Severity::kInfo;
  std::string channel;  ///< of the message that reports it
  std::string source;   ///< the process or person
  std::string words;    ///< "disarmed: the operator's lease has run out"
};

/// Detects events in the messages: changes of state with their reasons, actions of people,
/// learning.
/** Messages repeat complete state; an event is reported once, when it is first seen. */
class EventTeller {
 public:
  std::vector<Event> take(const LogEvent& event);

 private:
  void hear(const motor_t& motor);
  void hear(const plan_t& plan);
  void hear(const health_t& health);
  void hear(const learning_t& learning);
  void hear(const execution_t& executions);
  void hear(const arm_t& arm);
  void hear(const estop_t& estop);
  void hear(const goal_t& goal);
  void hear(const fence_t& fence);
  void hear(const mark_t& mark);
  void hear(const ins_t& ins);
  void tell(Severity severity, const std::string& source, const std::string& words);
  /// Whether this state is new for a source; remembers it.
  bool changes(const std::string& source, const std::string& state);

  int64_t now_ = 0;
  std::string channel_;
  std::vector<Event> told_;
  std::map<std::string, std::string> states_;  ///< by source
  std::map<std::string, int64_t> boots_;       ///< by process
  std::set<ExecutionKey> aborted_;
  int32_t ins_status_ = 0;
  bool ins_heard_ = false;
};

}  // namespace tread
