// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "modules/planner/core/execution/motion_monitors.hpp"
#include "modules/planner/core/execution/moving_control.hpp"
#include "modules/planner/core/execution/recovery.hpp"

namespace tread::planner {

/// While the vehicle stands: sets off, and where nothing is free waits, tries to get out, and gives
/// a way up.
class StandingControl {
 public:
  StandingControl(DrivingState& state, MovingControl& moving) : state_(state), moving_(moving) {}

  void stand(const PlannerInputs& s, const Preconditions& ready, ProgressMonitor& progress);
  bool arrived() const { return arrived_; }
  /// Another goal.
  void restart() {
    arrived_ = false;
    blocked_since_.reset();
    recovery_.restart();
  }
  void forgetBlocked() { blocked_since_.reset(); }
  /// The vehicle has joined another pattern: after some in a row a recovery has helped.
  void noteJoined();

 private:
  void planStart(const PlannerInputs& s);
  void begin(const PlannerInputs& s, const std::vector<PlanStep>& steps);
  void noPlan(const PlannerInputs& s, const std::string& why);
  void tryRecovery(const PlannerInputs& s);

  DrivingState& state_;
  MovingControl& moving_;
  Recovery recovery_;
  bool arrived_ = false;
  int joined_ = 0;                        ///< patterns since the last recovery
  std::optional<int64_t> blocked_since_;  ///< [us] standing, with nothing free
};

}  // namespace tread::planner
