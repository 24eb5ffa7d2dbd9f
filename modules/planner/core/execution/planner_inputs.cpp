// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/planner_inputs.hpp"

namespace tread::planner {
namespace {

using Level = Preconditions::Level;

std::string oldAs(const char* what, int64_t age) {
  return std::string(what) + " is " + std::to_string(age / 1000) + " ms old";
}

Preconditions waiting(Level level, const std::string& reason) {
  return {level, PlanStatus::kWaiting, reason};
}

/// What empties the program at once, except what the bridge and the operator say.
Preconditions checkSensors(const PlannerInputs& s, const MapAndSet& supplies,
                           const AgeLimits& limits) {
  if (!s.pose) return waiting(Level::kStop, "no usable INS yet");
  if (s.now - s.pose->utime > limits.pose)
    return waiting(Level::kStop, oldAs("INS", s.now - s.pose->utime));
  if (supplies.map_utime == 0) return waiting(Level::kStop, "no MAP yet");
  if (s.now - supplies.map_utime > limits.map_stop)
    return waiting(Level::kStop, oldAs("MAP", s.now - supplies.map_utime));
  if (!supplies.set_defect.empty()) return waiting(Level::kStop, supplies.set_defect);
  return {};
}

/// What lets the vehicle finish its pattern and stop.
Preconditions checkSupplies(const PlannerInputs& s, const MapAndSet& supplies,
                            const AgeLimits& limits) {
  if (!s.goal) return {Level::kFinish, PlanStatus::kIdle, ""};
  if (s.now - supplies.map_utime > limits.map_slow)
    return waiting(Level::kFinish, oldAs("MAP", s.now - supplies.map_utime));
  if (s.now - s.set_received > limits.pattern_set)
    return waiting(Level::kFinish,
                   "the learner is lost: " + oldAs("PATTERN_SET", s.now - s.set_received));
  return {};
}

Preconditions checkPermission(const PlannerInputs& s, const MapAndSet& supplies,
                              const AgeLimits& limits) {
  if (s.estopped) return {Level::kStop, PlanStatus::kStopped, "E-stop is engaged"};
  if (!s.bridge) return waiting(Level::kStop, "no MOTOR yet");
  if (s.now - s.bridge->utime > limits.bridge)
    return waiting(Level::kStop, oldAs("MOTOR", s.now - s.bridge->utime));
  if (!s.bridge->armed())
    return {Level::kStop, supplies.was_armed ? PlanStatus::kStopped : PlanStatus::kWaiting,
            "motor_bridge: " + s.bridge->reason};
  if (!s.armed_by_operator) return waiting(Level::kStop, "not armed since the planner's start");
  return {};
}

}  // namespace

Preconditions checkPreconditions(const PlannerInputs& inputs, const MapAndSet& supplies,
                                 const AgeLimits& limits) {
  Preconditions found = checkSensors(inputs, supplies, limits);
  if (found.level == Level::kGo) found = checkPermission(inputs, supplies, limits);
  if (found.level == Level::kGo) found = checkSupplies(inputs, supplies, limits);
  return found;
}

}  // namespace tread::planner
