// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/replay_check.hpp"

#include "tools/lab/replay/robot_replay.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/types/message_difference.hpp"

namespace tread::replay {
namespace {

/// Inputs of each process; a test compares them with the nodes' subscriptions.
const std::map<std::string, std::set<std::string>>& inputs() {
  static const std::map<std::string, std::set<std::string>> kInputs{
      {"learner", {"INS", "MOTOR", "EXECUTION"}},
      {"mapping", {"INS", "SCAN"}},
      {"planner",
       {"INS", "MAP", "GOAL", "PATTERN_SET", "MOTOR", "EXECUTION", "OPERATOR", "ARM", "ESTOP",
        "FENCE", "STOPPING", "SHOCK", "GRIP"}}};
  return kInputs;
}

}  // namespace

void ReplayCheck::noteLog(const RobotLog& log, const std::string& process) {
  notes.push_back(intakeLine(log, process, playedChannels(process)));
  for (const auto& [channel, missing] : log.missing)
    notes.push_back("the log lacks " + std::to_string(missing) + " messages on " + channel);
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

namespace {

/// "head, field: log ..., replay ..."; empty if nothing differs.
template <class Message>
std::string firstDifference(const std::string& head, const Message& log, const Message& replay,
                            double tolerance, const std::set<std::string>& without) {
  const std::string found = differenceBetween(log, replay, tolerance, without);
  return found.empty() ? "" : head + ", " + found;
}

}  // namespace

std::string differenceOf(const pattern_set_part_t& log, const pattern_set_part_t& replay,
                         double tolerance) {
  const std::string head = "version " + std::to_string(log.set_version) + ", pattern " +
                           std::to_string(log.set_pattern_id) + " '" + log.pattern_name + "'";
  const std::string found = firstDifference(head, log, replay, tolerance, {"seq", "set_checksum"});
  // Checksums differ by another pattern alone, and by less than a tolerance.
  if (!found.empty() || tolerance > 0.0) return found;
  return firstDifference(head, log, replay, tolerance, {"seq"});
}

std::string differenceOf(const learning_t& log, const learning_t& replay, double tolerance) {
  std::set<std::string> without{"seq"};
  // Older logs have the gate's words alone.
  if (log.gate_code < 0) without.insert("gate_code");
  return firstDifference("LEARNING of execution " + std::to_string(log.learned_execution_id), log,
                         replay, tolerance, without);
}

std::string differenceOf(const program_t& log, const program_t& replay) {
  return firstDifference(
      "PROGRAM at " + std::to_string(log.utime) + " us", log, replay, 0.0,
      {"seq", "inputs_heard", "newest_input", "newest_input_utime", "newest_input_seq"});
}

std::string differenceOf(const plan_t& log, const plan_t& replay) {
  std::set<std::string> without{"seq", "search_time"};
  // Plans in older logs have no risk.
  if (!std::isfinite(log.risk)) without.insert({"risk", "risk_per_metre"});
  if (log.reason_code < 0) without.insert("reason_code");  // and the reason's words alone
  return firstDifference("PLAN on INS of " + std::to_string(log.utime) + " us", log, replay, 0.0,
                         without);
}

std::vector<std::string> playableProcesses() {
  std::vector<std::string> processes;
  for (const auto& [process, channels] : inputs()) processes.push_back(process);
  return processes;
}

std::vector<std::string> playedChannels(const std::string& process) {
  std::vector<std::string> played;
  for (const ChannelSpec& channel : kChannels) {
    const std::string publisher = channel.publisher;
    if (publisher != process && publisher != "every process" &&
        inputs().at(process).count(channel.name) > 0)
      played.push_back(channel.name);
  }
  return played;
}

std::string channelFilter(const std::string& process) {
  std::string filter;
  for (const std::string& channel : playedChannels(process))
    filter += (filter.empty() ? "^(" : "|") + channel;
  return filter + ")$";
}

std::string recipeFor(const std::string& process, const std::string& log) {
  std::string own;
  for (const ChannelSpec& channel : kChannels)
    if (channel.publisher == process) own += (own.empty() ? "" : ", ") + std::string(channel.name);
  const std::string url = "'udpm://239.255.76.67:7669?ttl=0'";
  return "# a separate bus (LCM distinguishes buses by port only), and a separate state in "
         "--config\n"
         "tread-" +
         process + " --config FILE --lcm-url " + url +
         " &\n"
         "# what " +
         process + " hears; not " + own +
         " (its own past), HEALTH, CONFIG\n"
         "lcm-logplayer --lcm-url=" +
         url + " -s 1 -e '" + channelFilter(process) + "' " + log + "\n";
}

}  // namespace tread::replay
