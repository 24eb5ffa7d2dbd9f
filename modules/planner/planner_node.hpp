// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/bus/bus.hpp"
#include "common/config/config_reader.hpp"
#include "common/fence/kept_fences.hpp"
#include "common/messages/fence_messages.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/messages/robot_inputs.hpp"
#include "common/store/store.hpp"
#include "modules/planner/core/execution/goal_watch.hpp"
#include "modules/planner/core/execution/supervisor.hpp"
#include "modules/planner/core/execution/way_back.hpp"

namespace tread::planner {

/// Reads the configuration; throws ConfigError with file:line.
PlannerConfig readPlannerConfig(ConfigReader& reader);

/// The same from a logged CONFIG message. Obsolete keys that are constants today are ignored.
PlannerConfig readLoggedPlannerConfig(ConfigReader& reader);

/// Plans towards GOAL on MAP with the newest PATTERN_SET, and orders patterns from the motor bridge
/// by PROGRAM.
/** PROGRAM at 20 Hz in any case, empty when the robot should stand; PLAN at 5 Hz and with each
 * plan; PLAN_TREE at most once a second. Starts disarmed: it drives after an ARM that was received
 * after its start, while MOTOR reports armed. */
class PlannerNode : public Node {
 public:
  /// `store` keeps the operators' fences across restarts and outlives this; null: they are lost.
  PlannerNode(const PlannerConfig& config, Bus& bus, Store* store = nullptr);

  int64_t period() const override { return 50'000; }
  void step(int64_t utime) override;
  /// Empties the program.
  void shutdown(int64_t utime) override;
  /// Ends searches by this instead of the deadline: for replay, which uses a count of expansions.
  void setStop(StopPredicate stop) { stop_ = std::move(stop); }

  const Supervisor& supervisor() const { return supervisor_; }

 private:
  void subscribe();
  void recallFences();
  void keepFences(int64_t utime);
  void take(const map_tile_t& message);
  void take(const FenceRequest& request);
  void take(const goal_t& message);
  void take(const health_t& message);
  void take(const pattern_set_part_t& message);
  void disarm(const std::string& why);
  void watchGoal(int64_t utime);
  void watchLink(int64_t utime);
  bool outOfReach(int64_t version) const;
  void noteOtherSet(int64_t version, const char* counter);
  std::string secondLearner(int64_t utime) const;
  void publishProgram(int64_t utime, const ExecutionTracker& program);
  void publishPlan(int64_t utime, const Decision& decision, int64_t search_time);
  void publishTree(const PlanReport& report);
  void publishHealth(int64_t utime, const PlanReport& report);

  PlannerConfig config_;
  Bus& bus_;
  Store* store_;
  HealthReporter health_;
  RobotInputs robot_;
  FenceBook fences_;
  FenceExchange fence_exchange_;
  int64_t fences_kept_ = 0;  ///< revision that was stored
  int64_t next_keep_ = 0;    ///< [us]
  std::string unkept_;       ///< why it was not stored
  GoalWatch goal_;
  WayBack way_back_;
  double position_std_ = 0.0;  ///< [m] of the newest INS; NaN unknown
  Supervisor supervisor_;
  PatternSetAssembler sets_;
  PlannerInputs inputs_;
  double cell_size_ = 0.0;   ///< [m] of the map in use; 0 = none yet
  int64_t map_taken_ = 0;    ///< [us] of its last tile
  int64_t set_version_ = 0;  ///< newest complete one; 0 = none yet
  int64_t set_heard_ = 0;    ///< [us] when a part of it or of a newer one was last received
  int64_t other_since_ = 0;  ///< [us] since when sets of refused versions arrive
  int64_t other_heard_ = 0;  ///< [us]
  int64_t other_version_ = 0;
  StopPredicate stop_;        ///< empty = the deadline
  int64_t longest_swap_ = 0;  ///< [us]
  int64_t next_plan_ = 0;
  int64_t next_tree_ = 0;
  int64_t seq_arm_ = 0;
  int64_t seq_program_ = 0;
  int64_t seq_plan_ = 0;
  int64_t seq_tree_ = 0;
};

}  // namespace tread::planner
