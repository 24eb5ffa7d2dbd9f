// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/log_messages.hpp"

#include <algorithm>
#include <utility>

#include "common/messages/ins_messages.hpp"
#include "tools/gap/import_note.hpp"

namespace tread::gap {
namespace {

/// A time that a clock can show; others are broken bytes.
bool sensible(int64_t utime) {
  constexpr int64_t kThreeCenturies = 10'000'000'000'000'000;  // [us]
  return utime >= 0 && utime < kThreeCenturies;
}

/// Whether messages of one time say different things.
bool clash(const ins_t& a, const ins_t& b) {
  const auto first = planarPose(a);
  const auto second = planarPose(b);
  return a.utime == b.utime && first && second &&
         (first->position() - second->position()).norm() > 1e-6;
}
bool clash(const motor_t& a, const motor_t& b) {
  return a.utime == b.utime &&
         (a.command_left != b.command_left || a.command_right != b.command_right);
}

class Sorter {
 public:
  void take(const LogEvent& event) {
    ++messages_.events;
    if (event.channel == kMotor.name) {
      takeTimed(event, kMotor, messages_.motor, messages_.motor_stamps, messages_.motor_clashes);
    } else if (event.channel == kIns.name) {
      takeTimed(event, kIns, messages_.ins, messages_.ins_stamps, messages_.ins_clashes);
    } else if (event.channel == kExecution.name) {
      takeExecutions(event);
    } else if (event.channel == kConfig.name) {
      takeBoot(event);
    }
  }

  LogMessages sorted() {
    sortByTime(messages_.motor);
    sortByTime(messages_.ins);
    for (auto& [key, record] : executions_) messages_.executions.push_back(std::move(record));
    std::stable_sort(messages_.executions.begin(), messages_.executions.end(),
                     [](const auto& a, const auto& b) { return a.started < b.started; });
    const bool any = !messages_.motor.empty() || !messages_.ins.empty();
    messages_.origin = any ? INT64_MAX : 0;
    if (!messages_.motor.empty()) messages_.origin = messages_.motor.front().utime;
    if (!messages_.ins.empty())
      messages_.origin = std::min(messages_.origin, messages_.ins.front().utime);
    return std::move(messages_);
  }

 private:
  template <class Message>
  void takeTimed(const LogEvent& event, const Channel<Message>& channel,
                 std::vector<Message>& messages, std::vector<Stamp>& stamps, size_t& clashes) {
    Message message;
    if (!counted(decode(event, channel, message) && sensible(message.utime))) return;
    if (!messages.empty() && clash(messages.back(), message)) ++clashes;
    stamps.push_back(
        {sensible(event.utime) ? event.utime : message.utime, message.utime, message.seq});
    messages.push_back(std::move(message));
  }

  void takeExecutions(const LogEvent& event) {
    execution_t message;
    if (!counted(decode(event, kExecution, message))) return;
    for (const execution_record_t& record : message.records)
      if (record.outcome == execution_record_t::OUTCOME_COMPLETED && sensible(record.started) &&
          sensible(record.ended) && record.ended > record.started)
        executions_.emplace(std::pair{record.record_run_id, record.record_execution_id}, record);
  }

  void takeBoot(const LogEvent& event) {
    config_t config;
    if (!counted(decode(event, kConfig, config))) return;
    if (auto note = importNoteOf(config)) messages_.imported = std::move(note);
    std::vector<int64_t>& boots = messages_.boots[config.config_process];
    if (boots.empty() || boots.back() != config.config_boot_id)
      boots.push_back(config.config_boot_id);
  }

  bool counted(bool good) {
    if (!good) ++messages_.foreign;
    return good;
  }

  template <class Message>
  static void sortByTime(std::vector<Message>& messages) {
    std::stable_sort(messages.begin(), messages.end(),
                     [](const Message& a, const Message& b) { return a.utime < b.utime; });
  }

  LogMessages messages_;
  std::map<std::pair<int64_t, int64_t>, execution_record_t> executions_;
};

}  // namespace

LogMessages sortMessages(const std::vector<LogEvent>& events) {
  Sorter sorter;
  for (const LogEvent& event : events) sorter.take(event);
  return sorter.sorted();
}

}  // namespace tread::gap
