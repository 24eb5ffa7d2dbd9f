// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/set_difference.hpp"

#include <array>

#include "tools/replay/comparison.hpp"

namespace tread::replay {
namespace {

void compareSamples(Comparison& compare, const pattern_set_part_t& log,
                    const pattern_set_part_t& replay) {
  static constexpr std::array<const char*, 3> kAxes{" x [m]", " y [m]", " yaw [rad]"};
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

}  // namespace

std::string differenceOf(const pattern_set_part_t& log, const pattern_set_part_t& replay,
                         double tolerance) {
  Comparison compare(tolerance);
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
  Comparison compare(tolerance);
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
  compare.field("probability of the surface", log.surface_probability,
                replay.surface_probability);
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

}  // namespace tread::replay
