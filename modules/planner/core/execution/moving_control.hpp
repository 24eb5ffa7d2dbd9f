// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <vector>

#include "common/geometry/se2.hpp"
#include "modules/planner/core/execution/driving_state.hpp"
#include "modules/planner/core/search/search_problem.hpp"

namespace tread::planner {

/// Control while a pattern runs: checks it against the newest map, and hands over the next one.
class MovingControl {
 public:
  explicit MovingControl(DrivingState& state) : state_(state) {}

  void drive(const PlannerInputs& s, const Preconditions& ready);
  Prediction predictRunning(const PlannerInputs& s) const;
  /// Hands over the fastest free pattern that stops; false if the vehicle will not come to rest.
  bool stopNext(const Prediction& running);

 private:
  bool frozen(const PlannerInputs& s) const;
  bool nextCollides(const Prediction& running) const;
  void planNext(const PlannerInputs& s, const Preconditions& ready, const Prediction& running);
  PlanStep endOf(const Prediction& running) const;
  void searchNext(const PlannerInputs& s, const Prediction& running);
  void keepClear(const PlannerInputs& s, const Prediction& running);
  bool answerSlide(const PlannerInputs& s, const Preconditions& ready, const Prediction& running);
  bool stoppingIsBetter(const PlannerInputs& s, const std::vector<ExpectedPose>& poses) const;
  std::vector<ExpectedPose> posesAfter(const Prediction& running) const;
  std::optional<double> conflict(const Pose2& here, const std::vector<ExpectedPose>& poses) const;

  DrivingState& state_;
};

}  // namespace tread::planner
