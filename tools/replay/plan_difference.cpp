// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/plan_difference.hpp"

#include <array>

#include "tools/replay/comparison.hpp"

namespace tread::replay {
namespace {

constexpr std::array<const char*, 3> kAxes{" x [m]", " y [m]", " yaw [rad]"};

void compareSlots(Comparison& compare, const std::string& name, const program_slot_t& log,
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

std::string differenceOf(const program_t& log, const program_t& replay) {
  Comparison compare;
  compareSlots(compare, "running", log.running, replay.running);
  compareSlots(compare, "next", log.next, replay.next);
  compare.field("run id", log.run_id, replay.run_id);
  compare.field("lease [us]", log.lease, replay.lease);
  compare.field("utime [us]", log.utime, replay.utime);
  return compare.equal() ? ""
                         : "PROGRAM at " + std::to_string(log.utime) + " us, " + compare.found();
}

std::string differenceOf(const plan_t& log, const plan_t& replay) {
  Comparison compare;
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
