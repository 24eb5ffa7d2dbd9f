// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/health.hpp"
#include "modules/planner/core/execution/program_book.hpp"
#include "modules/planner/permission.hpp"
#include "tools/patterns/execution_collector.hpp"
#include "tools/patterns/tour.hpp"

namespace tread::patterns {

/// What to record on a robot, and how patiently.
struct LiveRecording {
  int executions = 10;                ///< of each pattern, fair ones
  double room = 8.0;                  ///< [m] around where it began; beyond it stops
  int give_up_after = 10;             ///< refusals of a pattern one after the other
  int64_t lease_us = 200'000;         ///< [us] of each PROGRAM
  learner::MeasurementLimits limits;  ///< of a fair measurement; max_speed 0 = the set's largest
};

/// Stands in the planner's place, drives each pattern many times and measures what it did.
/** PROGRAM at 20 Hz once the robot speaks, empty when the robot shall stand; EXECUTION, MOTOR and
 * INS in. Chains of joinable patterns bring it into the entry classes; what is not a fair
 * measurement is refused with its reason and driven again. Begins when ARM was seen after its
 * start. It sees no obstacles: the room must be free. No planner may run beside it; where one
 * speaks, it gives up and says nothing more. */
class LiveRecorder : public Node {
 public:
  using Say = std::function<void(const std::string& line)>;
  enum class State { kGoesOn, kDone, kFailed };

  /// `say` gets a line for everything that is worth telling. Throws std::runtime_error if the set
  /// cannot be driven, see Tour.
  LiveRecorder(const PatternSet& set, const LiveRecording& how, Bus& bus, Say say);

  int64_t period() const override { return 50'000; }
  void step(int64_t utime) override;
  /// Empties the program: the motors stop.
  void shutdown(int64_t utime) override;

  State state() const { return state_; }
  /// Why it failed or what it waits for; empty while it drives.
  const std::string& reason() const { return reason_; }
  /// Fair executions by pattern so far.
  const std::vector<std::vector<recordings::Execution>>& recorded() const {
    return collector_.recorded();
  }

 private:
  void subscribe();
  void take(const ins_t& message);
  void take(const motor_t& message);
  void take(const execution_t& message);
  void take(const program_t& message);

  void followTime(int64_t utime);
  void followExecutions(int64_t utime);
  void forgetUnplayed();
  void drive(int64_t utime);
  /// Why it must stand now, in words; empty = it may drive.
  std::string obstacle(int64_t utime);
  std::string roomExceeded();
  void goOnFromStanding(int64_t utime);
  void begin(int64_t utime);
  void appendNext(int64_t utime);
  /// Notes a pattern that is to be handed over; false if that makes no sense any more.
  bool counts(size_t pattern);

  bool stands() const;
  Pose2 fromHome(const Pose2& T_map_body) const { return between(*T_map_home_, T_map_body); }
  /// Where the running pattern is predicted to end.
  Pose2 predictedEnd() const;
  /// Executions that are neither recorded nor on their way, by pattern.
  std::vector<int> needed() const;
  void setReason(const std::string& reason);
  void fail(const std::string& reason);
  void publishProgram(int64_t utime);
  void publishHealth(int64_t utime);

  PatternSet set_;
  LiveRecording how_;
  Bus& bus_;
  Say say_;
  Tour tour_;
  HealthReporter health_;
  planner::ProgramBook book_;
  planner::Permission permission_;
  planner::Situation situation_;
  ExecutionCollector collector_;

  std::map<int64_t, size_t> under_way_;  ///< handed over, not yet judged: pattern by execution id
  std::optional<Pose2> T_map_home_;
  std::optional<int64_t> stepped_;
  int64_t begun_ = 0;  ///< [us] first step
  int64_t executions_utime_ = 0;
  int64_t standing_since_ = 0;  ///< [us] with an empty book; 0 = not standing
  int without_gain_ = 0;        ///< patterns handed over since one was needed
  bool silent_ = false;         ///< another planner speaks
  State state_ = State::kGoesOn;
  std::string reason_;
  int64_t seq_program_ = 0;
};

}  // namespace tread::patterns
