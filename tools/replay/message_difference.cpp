// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/message_difference.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>

namespace tread::replay {
namespace {

/// Compares messages field by field and remembers the first field that differs.
class FieldComparison {
 public:
  /// Numbers may differ by `tolerance`; 0 = to the bit.
  explicit FieldComparison(double tolerance = 0.0) : tolerance_(tolerance) {}

  template <class Value>
  void field(const std::string& name, const Value& log, const Value& replay) {
    if (!found_.empty() || same(log, replay)) return;
    found_ = name + ": log " + text(log) + ", replay " + text(replay);
  }
  /// Lists of one length.
  template <class Numbers>
  void numbers(const std::string& name, const Numbers& log, const Numbers& replay) {
    for (size_t i = 0; i < std::size(log); ++i)
      field(name + "[" + std::to_string(i) + "]", log[i], replay[i]);
  }
  bool equal() const { return found_.empty(); }
  /// "field: log ..., replay ..."; empty if nothing differs.
  const std::string& found() const { return found_; }

 private:
  static std::string text(double value) {
    std::array<char, 40> digits;
    const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return {digits.data(), result.ptr};
  }
  static std::string text(int64_t value) { return std::to_string(value); }
  static std::string text(int32_t value) { return std::to_string(value); }
  static std::string text(bool value) { return value ? "yes" : "no"; }
  static std::string text(const std::string& value) { return "'" + value + "'"; }

  /// To the bit, so that an unknown value (NaN) equals itself.
  bool same(double a, double b) const {
    return std::memcmp(&a, &b, sizeof a) == 0 || std::abs(a - b) < tolerance_;
  }
  template <class Value>
  bool same(const Value& a, const Value& b) const {
    return a == b;
  }

  double tolerance_;
  std::string found_;
};

constexpr std::array<const char*, 3> kAxes{" x [m]", " y [m]", " yaw [rad]"};

void compareSamples(FieldComparison& compare, const pattern_set_part_t& log,
                    const pattern_set_part_t& replay) {
  static constexpr std::array<const char*, 2> kTracks{" left", " right"};
  compare.field("number of samples", int64_t{log.num_samples}, int64_t{replay.num_samples});
  if (log.num_samples != replay.num_samples) return;
  for (size_t i = 0; i < log.trajectory.size(); ++i) {
    const std::string at = " sample " + std::to_string(i + 1);
    for (size_t track = 0; track < kTracks.size(); ++track)
      compare.field("command" + at + kTracks[track], log.command[i][track],
                    replay.command[i][track]);
    for (size_t axis = 0; axis < kAxes.size(); ++axis)
      compare.field("trajectory" + at + kAxes[axis], log.trajectory[i][axis],
                    replay.trajectory[i][axis]);
  }
}

void compareSlots(FieldComparison& compare, const std::string& name, const program_slot_t& log,
                  const program_slot_t& replay) {
  compare.field(name + " pattern", log.slot_pattern_id, replay.slot_pattern_id);
  compare.field(name + " execution", log.execution_id, replay.execution_id);
  compare.field(name + " set version", log.slot_set_version, replay.slot_set_version);
  compare.field(name + " command kind", int32_t{log.command_kind}, int32_t{replay.command_kind});
  compare.field(name + " period [us]", log.period, replay.period);
  compare.field(name + " number of commands", log.num_commands, replay.num_commands);
  if (log.num_commands != replay.num_commands) return;
  for (size_t i = 0; i < log.left.size(); ++i) {
    const std::string at = name + " command " + std::to_string(i + 1);
    compare.field(at + " left", double{log.left[i]}, double{replay.left[i]});
    compare.field(at + " right", double{log.right[i]}, double{replay.right[i]});
  }
}

}  // namespace

std::string differenceOf(const pattern_set_part_t& log, const pattern_set_part_t& replay,
                         double tolerance) {
  FieldComparison compare(tolerance);
  compare.field("pattern id", int64_t{log.set_pattern_id}, int64_t{replay.set_pattern_id});
  compare.field("pattern name", log.pattern_name, replay.pattern_name);
  compareSamples(compare, log, replay);
  compare.numbers("end covariance", log.end_covariance, replay.end_covariance);
  compare.field("times learned", int64_t{log.times_learned}, int64_t{replay.times_learned});
  compare.field("entry class", log.entry_class, replay.entry_class);
  compare.field("exit class", log.exit_class, replay.exit_class);
  compare.numbers("entry twist", log.entry_twist, replay.entry_twist);
  compare.numbers("exit twist", log.exit_twist, replay.exit_twist);
  compare.numbers("entry steady", log.entry_steady, replay.entry_steady);
  compare.numbers("exit steady", log.exit_steady, replay.exit_steady);
  compare.field("number of patterns", int64_t{log.part_count}, int64_t{replay.part_count});
  compare.field("set name", log.set_name, replay.set_name);
  compare.field("period [us]", int64_t{log.set_period}, int64_t{replay.set_period});
  compare.field("command kind", int64_t{log.set_command_kind}, int64_t{replay.set_command_kind});
  compare.field("newest measurement [us]", log.utime, replay.utime);
  compare.field("parent version", log.parent_version, replay.parent_version);
  if (tolerance == 0.0)
    compare.field("checksum (another pattern differs)", log.set_checksum, replay.set_checksum);
  if (compare.found().empty()) return {};
  return "version " + std::to_string(log.set_version) + ", pattern " +
         std::to_string(log.set_pattern_id) + " '" + log.pattern_name + "', " + compare.found();
}

std::string differenceOf(const learning_t& log, const learning_t& replay, double tolerance) {
  FieldComparison compare(tolerance);
  compare.field("accepted", bool{log.accepted != 0}, bool{replay.accepted != 0});
  compare.field("reason", log.gate_reason, replay.gate_reason);
  compare.field("pattern", int64_t{log.learned_pattern_id}, int64_t{replay.learned_pattern_id});
  compare.field("pattern name", log.learned_pattern_name, replay.learned_pattern_name);
  compare.field("rule", log.learning_rule, replay.learning_rule);
  compare.numbers("measured end", log.measured_end, replay.measured_end);
  compare.field("path length [m]", log.path_length, replay.path_length);
  compare.numbers("measured entry", log.measured_entry, replay.measured_entry);
  compare.field("slope [rad]", log.slope, replay.slope);
  compare.field("scored version", log.scored_version, replay.scored_version);
  compare.numbers("predicted end", log.predicted_end, replay.predicted_end);
  compare.field("error of position [m]", log.error_position, replay.error_position);
  compare.field("error of yaw [rad]", log.error_yaw, replay.error_yaw);
  compare.field("reason of the change", log.change_reason, replay.change_reason);
  compare.field("probability of changed ground", log.ground_changed, replay.ground_changed);
  compare.field("surface", int64_t{log.surface}, int64_t{replay.surface});
  compare.field("probability of the surface", log.surface_probability, replay.surface_probability);
  compare.field("changed", bool{log.changed != 0}, bool{replay.changed != 0});
  compare.numbers("scaling", log.scaling, replay.scaling);
  compare.field("result version", log.result_version, replay.result_version);
  compare.field("error of position after [m]", log.error_position_after,
                replay.error_position_after);
  compare.field("error of yaw after [rad]", log.error_yaw_after, replay.error_yaw_after);
  compare.field("end of execution [us]", log.utime, replay.utime);
  if (compare.found().empty()) return {};
  return "LEARNING of execution " + std::to_string(log.learned_execution_id) + ", " +
         compare.found();
}

std::string differenceOf(const program_t& log, const program_t& replay) {
  FieldComparison compare;
  compareSlots(compare, "running", log.running, replay.running);
  compareSlots(compare, "next", log.next, replay.next);
  compare.field("run id", log.run_id, replay.run_id);
  compare.field("lease [us]", log.lease, replay.lease);
  compare.field("utime [us]", log.utime, replay.utime);
  return compare.equal() ? ""
                         : "PROGRAM at " + std::to_string(log.utime) + " us, " + compare.found();
}

std::string differenceOf(const plan_t& log, const plan_t& replay) {
  FieldComparison compare;
  compare.field("newest INS [us]", log.utime, replay.utime);
  compare.field("goal", log.goal_id, replay.goal_id);
  compare.field("set version", log.set_version, replay.set_version);
  compare.field("status", int32_t{log.plan_status}, int32_t{replay.plan_status});
  compare.field("reason", log.reason, replay.reason);
  compare.field("expansions", log.expansions, replay.expansions);
  compare.field("number of patterns", log.num_patterns, replay.num_patterns);
  for (size_t i = 0; compare.equal() && i < log.pattern_id.size(); ++i) {
    const std::string at = "pattern " + std::to_string(i + 1);
    compare.field(at, log.pattern_id[i], replay.pattern_id[i]);
    compare.field(at + " execution", log.execution_id[i], replay.execution_id[i]);
    for (size_t axis = 0; axis < kAxes.size(); ++axis)
      compare.field(at + kAxes[axis], log.pose[i][axis], replay.pose[i][axis]);
    compare.numbers(at + " covariance", log.covariance[i], replay.covariance[i]);
  }
  compare.field("time to go [s]", log.time_to_go, replay.time_to_go);
  return compare.equal()
             ? ""
             : "PLAN on INS of " + std::to_string(log.utime) + " us, " + compare.found();
}

}  // namespace tread::replay
