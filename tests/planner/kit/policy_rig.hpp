// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>

#include "tests/planner/kit/closed_loop.hpp"
#include "tests/planner/kit/vehicle.hpp"

namespace tread::planner::testkit {

/// A supervisor with an ideal robot: motions are exact, MOTOR and EXECUTION are prompt.
class Rig {
 public:
  explicit Rig(const Playground& ground = {}, const PlannerConfig& config = usualPlanner())
      : supervisor_(config, 77) {
    supervisor_.takeSet(samplePatterns());
    paint(ground);
    inputs_.armed_by_operator = true;
    inputs_.goal = Goal{1, {12.0, 0.0, 0.0}, 0.5, 4.0};
  }

  void paint(const Playground& ground) {
    ++painted_;
    for (Tile& tile : tilesOf(ground.paint(0.1, {-9.6, -9.6}, {16.0, 9.6}), 32, 1 + painted_))
      supervisor_.map().put(std::move(tile), 0.1, 32);
  }

  /// Runs for a time [s]; `tamper` may change the inputs of each step.
  Decision run(double seconds, const std::function<void(PlannerInputs&)>& tamper = nullptr) {
    Decision decision;
    const int64_t end = now_ + static_cast<int64_t>(seconds * 1e6);
    for (; now_ < end; now_ += 10'000) {
      state_ = moveOn(state_, bridge_.step(now_), 0.01, TrackModel{});
      if (now_ % 50'000 != 0) continue;
      decision = step(tamper);
    }
    return decision;
  }

  Decision step(const std::function<void(PlannerInputs&)>& tamper) {
    if (maps_) freshMap();
    inputs_.now = now_;
    const double speed = (state_.left + state_.right) / 2.0;
    inputs_.pose = PoseReading{
        now_, state_.pose, Twist2{speed, 0.0, (state_.right - state_.left) / TrackModel{}.gauge}};
    inputs_.bridge = bridge_.reading();
    inputs_.executions = bridge_.executions();
    inputs_.set_received = now_;
    PlannerInputs seen = inputs_;
    if (tamper) tamper(seen);
    const Decision decision = supervisor_.step(seen, stop);
    bridge_.receive(77, supervisor_.program().running(), supervisor_.program().next(), now_);
    return decision;
  }

  StopPredicate stop;  ///< may end the searches of a step early

  /// From now on no new scans enter the map.
  void stopMapping() { maps_ = false; }
  double speed() const { return (state_.left + state_.right) / 2.0; }
  const Pose2& pose() const { return state_.pose; }
  const MotionPattern& running() const { return supervisor_.program().running().pattern(); }
  const MotionPattern& next() const { return supervisor_.program().next().pattern(); }
  Supervisor& supervisor() { return supervisor_; }
  PlannerInputs& inputs() { return inputs_; }
  ToyBridge& bridge() { return bridge_; }
  int64_t now() const { return now_; }

 private:
  void freshMap() {
    Tile tile{500, 500, now_, std::vector<Cell>(32 * 32, kFree)};
    supervisor_.map().put(std::move(tile), 0.1, 32);
  }

  Supervisor supervisor_;
  ToyBridge bridge_;
  TrackState state_;
  PlannerInputs inputs_;
  int64_t now_ = 10'000'000;
  int64_t painted_ = 0;
  bool maps_ = true;
};

}  // namespace tread::planner::testkit
