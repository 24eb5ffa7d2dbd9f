// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/replay_check.hpp"

#include "tools/lab/replay/robot_replay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <type_traits>

#include "common/config/scalars.hpp"

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

/// Compares two messages of one type field by field and stores the first difference.
template <class Message>
class FieldComparison {
 public:
  /// Numbers may differ by `tolerance`; 0 = to the bit.
  FieldComparison(const Message& log, const Message& replay, double tolerance)
      : log_(log), replay_(replay), tolerance_(tolerance) {}

  /// A number, a text, or an array of numbers.
  template <class Field>
  void field(const std::string& name, Field Message::*member) {
    if constexpr (std::is_array_v<Field>)
      numbers(name, log_.*member, replay_.*member);
    else
      values(name, log_.*member, replay_.*member);
  }
  void flag(const std::string& name, int8_t Message::*member) {
    if (found_.empty() && (log_.*member != 0) != (replay_.*member != 0))
      found_ = log_.*member != 0 ? name + ": log yes, replay no" : name + ": log no, replay yes";
  }
  template <class Value>
  void values(const std::string& name, const Value& log, const Value& replay) {
    if (!found_.empty() || same(log, replay)) return;
    found_ = name + ": log " + text(log) + ", replay " + text(replay);
  }
  /// Arrays of equal length.
  template <class Numbers>
  void numbers(const std::string& name, const Numbers& log, const Numbers& replay) {
    for (size_t i = 0; i < std::size(log); ++i)
      values(name + "[" + std::to_string(i) + "]", log[i], replay[i]);
  }
  /// "head, field: log ..., replay ..."; empty if nothing differs.
  std::string found(const std::string& head) const {
    return found_.empty() ? "" : head + ", " + found_;
  }
  bool equal() const { return found_.empty(); }

 private:
  template <class Value>
  static std::string text(const Value& value) {
    if constexpr (std::is_floating_point_v<Value>) {
      return formatNumber(double{value});
    } else if constexpr (std::is_integral_v<Value>) {
      return std::to_string(value);
    } else {
      return "'" + value + "'";
    }
  }

  /// Bitwise, so that an unknown value (NaN) equals itself.
  template <class Value>
  bool same(const Value& a, const Value& b) const {
    if constexpr (std::is_floating_point_v<Value>)
      return std::memcmp(&a, &b, sizeof a) == 0 || double{std::abs(a - b)} < tolerance_;
    else
      return a == b;
  }

  const Message& log_;
  const Message& replay_;
  double tolerance_;
  std::string found_;
};

constexpr std::array<const char*, 3> kAxes{" x [m]", " y [m]", " yaw [rad]"};

void compareSamples(FieldComparison<pattern_set_part_t>& compare, const pattern_set_part_t& log,
                    const pattern_set_part_t& replay) {
  compare.values("number of samples", log.num_samples, replay.num_samples);
  if (log.num_samples != replay.num_samples) return;
  for (size_t i = 0; i < log.trajectory.size(); ++i) {
    const std::string at = " sample " + std::to_string(i + 1);
    for (size_t channel = 0; channel < log.channel_name.size(); ++channel)
      compare.values("command" + at + " " + log.channel_name[channel], log.command[i][channel],
                     replay.command[i][channel]);
    for (size_t axis = 0; axis < kAxes.size(); ++axis)
      compare.values("trajectory" + at + kAxes[axis], log.trajectory[i][axis],
                     replay.trajectory[i][axis]);
  }
}

void compareSlots(FieldComparison<program_t>& compare, const std::string& name,
                  const program_slot_t& log, const program_slot_t& replay) {
  compare.values(name + " pattern", log.slot_pattern_id, replay.slot_pattern_id);
  compare.values(name + " execution", log.execution_id, replay.execution_id);
  compare.values(name + " set version", log.slot_set_version, replay.slot_set_version);
  compare.values(name + " number of channels", log.num_channels, replay.num_channels);
  compare.values(name + " period [us]", log.period, replay.period);
  compare.values(name + " number of commands", log.num_commands, replay.num_commands);
  if (log.num_commands != replay.num_commands || log.num_channels != replay.num_channels) return;
  for (size_t channel = 0; channel < log.channel_kind.size(); ++channel) {
    const std::string of = " channel " + std::to_string(channel + 1);
    compare.values(name + of + " kind", log.channel_kind[channel], replay.channel_kind[channel]);
    for (size_t i = 0; i < log.command.size(); ++i)
      compare.values(name + " command " + std::to_string(i + 1) + of, log.command[i][channel],
                     replay.command[i][channel]);
  }
}

}  // namespace

std::string differenceOf(const pattern_set_part_t& log, const pattern_set_part_t& replay,
                         double tolerance) {
  using M = pattern_set_part_t;
  FieldComparison<M> compare(log, replay, tolerance);
  compare.field("pattern id", &M::set_pattern_id);
  compare.field("pattern name", &M::pattern_name);
  compare.values("number of channels", log.num_channels, replay.num_channels);
  if (log.num_channels == replay.num_channels) {
    compare.numbers("channel name", log.channel_name, replay.channel_name);
    compare.numbers("command kind", log.channel_kind, replay.channel_kind);
    compare.numbers("lowest command", log.channel_lowest, replay.channel_lowest);
    compare.numbers("highest command", log.channel_highest, replay.channel_highest);
    compare.numbers("entry steady", log.entry_steady, replay.entry_steady);
    compare.numbers("exit steady", log.exit_steady, replay.exit_steady);
    compareSamples(compare, log, replay);
  }
  compare.field("end covariance", &M::end_covariance);
  compare.field("times learned", &M::times_learned);
  compare.field("entry class", &M::entry_class);
  compare.field("exit class", &M::exit_class);
  compare.field("entry twist", &M::entry_twist);
  compare.field("exit twist", &M::exit_twist);
  compare.field("number of patterns", &M::part_count);
  compare.field("set name", &M::set_name);
  compare.field("period [us]", &M::set_period);
  compare.field("newest measurement [us]", &M::utime);
  compare.field("parent version", &M::parent_version);
  if (tolerance == 0.0) compare.field("checksum (another pattern differs)", &M::set_checksum);
  return compare.found("version " + std::to_string(log.set_version) + ", pattern " +
                       std::to_string(log.set_pattern_id) + " '" + log.pattern_name + "'");
}

std::string differenceOf(const learning_t& log, const learning_t& replay, double tolerance) {
  using M = learning_t;
  FieldComparison<M> compare(log, replay, tolerance);
  compare.flag("accepted", &M::accepted);
  compare.field("reason", &M::gate_reason);
  compare.field("pattern", &M::learned_pattern_id);
  compare.field("pattern name", &M::learned_pattern_name);
  compare.field("rule", &M::learning_rule);
  compare.field("measured end", &M::measured_end);
  compare.field("path length [m]", &M::path_length);
  compare.field("measured entry", &M::measured_entry);
  compare.field("slope [rad]", &M::slope);
  compare.field("scored version", &M::scored_version);
  compare.field("predicted end", &M::predicted_end);
  compare.field("error of position [m]", &M::error_position);
  compare.field("error of yaw [rad]", &M::error_yaw);
  compare.field("reason of the change", &M::change_reason);
  compare.field("probability of changed ground", &M::ground_changed);
  compare.field("surface", &M::surface);
  compare.field("probability of the surface", &M::surface_probability);
  compare.flag("changed", &M::changed);
  compare.field("scaling", &M::scaling);
  compare.field("result version", &M::result_version);
  compare.field("error of position after [m]", &M::error_position_after);
  compare.field("error of yaw after [rad]", &M::error_yaw_after);
  compare.field("end of execution [us]", &M::utime);
  return compare.found("LEARNING of execution " + std::to_string(log.learned_execution_id));
}

std::string differenceOf(const program_t& log, const program_t& replay) {
  using M = program_t;
  FieldComparison<M> compare(log, replay, 0.0);
  compareSlots(compare, "running", log.running, replay.running);
  compareSlots(compare, "next", log.next, replay.next);
  compare.field("run id", &M::run_id);
  compare.field("lease [us]", &M::lease);
  compare.field("utime [us]", &M::utime);
  return compare.found("PROGRAM at " + std::to_string(log.utime) + " us");
}

std::string differenceOf(const plan_t& log, const plan_t& replay) {
  using M = plan_t;
  FieldComparison<M> compare(log, replay, 0.0);
  compare.field("newest INS [us]", &M::utime);
  compare.field("goal", &M::goal_id);
  compare.field("set version", &M::set_version);
  compare.field("status", &M::plan_status);
  compare.field("reason", &M::reason);
  compare.field("expansions", &M::expansions);
  compare.field("number of patterns", &M::num_patterns);
  for (size_t i = 0; compare.equal() && i < log.pattern_id.size(); ++i) {
    const std::string at = "pattern " + std::to_string(i + 1);
    compare.values(at, log.pattern_id[i], replay.pattern_id[i]);
    compare.values(at + " execution", log.execution_id[i], replay.execution_id[i]);
    for (size_t axis = 0; axis < kAxes.size(); ++axis)
      compare.values(at + kAxes[axis], log.pose[i][axis], replay.pose[i][axis]);
    compare.numbers(at + " covariance", log.covariance[i], replay.covariance[i]);
  }
  compare.field("time to go [s]", &M::time_to_go);
  // Plans in older logs have no risk.
  if (std::isfinite(log.risk)) {
    compare.field("risk", &M::risk);
    compare.field("risk per metre", &M::risk_per_metre);
  }
  return compare.found("PLAN on INS of " + std::to_string(log.utime) + " us");
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
