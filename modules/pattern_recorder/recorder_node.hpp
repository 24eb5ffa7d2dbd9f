// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/execution/measurement.hpp"
#include "common/messages/command_watch.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/messages/operator_beacon.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/messages/robot_inputs.hpp"
#include "common/recordings/recordings.hpp"
#include "modules/pattern_recorder/core/recording_drive.hpp"

namespace tread::pattern_recorder {

/// Extracts the executions of one run from INS, EXECUTION and MOTOR, as the learner does, and keeps
/// the valid ones of each pattern.
/** Refusals are reported with their reasons. Patterns are indexed by their place in the set. */
class ExecutionCollector {
 public:
  /// Keeps `wanted` executions of each pattern; `limits` as the learner's, max_speed 0 = the set's
  /// largest.
  ExecutionCollector(const PatternSet& set, int64_t run_id, int wanted, int give_up_after,
                     const MeasurementLimits& limits, Say say);

  void take(const ins_t& message, int64_t now) { ins_.add(message, now); }
  void take(const motor_t& message) { commands_.add(message); }
  void take(const execution_t& message, int64_t now) { executions_.add(message, now); }

  /// Evaluates executions that have ended and are covered by the INS. Returns the ids of this run's
  /// executions that were evaluated.
  std::vector<int64_t> judge(int64_t utime);

  const std::vector<std::vector<recordings::Execution>>& recorded() const { return recorded_; }
  /// Executions still missing, by pattern; 0 = complete.
  std::vector<int> missing() const;
  int64_t refused() const { return refused_; }
  /// Why the recording cannot succeed: a pattern was refused too often in a row; empty if it can.
  const std::string& hopeless() const { return hopeless_; }
  const TrackHistory& track() const { return ins_.history(); }

 private:
  int missing(size_t pattern) const {
    return wanted_ - static_cast<int>(recorded_[pattern].size());
  }
  void judge(const execution_record_t& record);
  Measurement measure(const execution_record_t& record, const MotionPattern& pattern) const;
  void keep(size_t pattern, std::vector<Pose2> measured);
  void refuse(size_t pattern, Gate gate, const std::string& reason);

  PatternSet set_;
  int64_t run_id_;
  int wanted_;
  int give_up_after_;
  MeasurementLimits limits_;
  Say say_;
  InsQueue ins_;
  ExecutionQueue executions_;
  CommandWatch commands_;
  std::vector<std::vector<recordings::Execution>> recorded_;
  std::vector<int> refused_in_a_row_;
  int64_t refused_ = 0;
  std::string hopeless_;
};

/// What to record on a robot, and when to give up.
struct RecordingConfig {
  int executions = 10;         ///< valid ones, of each pattern
  double room = 8.0;           ///< [m] around the starting point; beyond it the robot stops
  int give_up_after = 10;      ///< number of consecutive refusals of a pattern
  int64_t lease_us = 200'000;  ///< [us] of each PROGRAM
  std::string operator_name =
      "operator";  ///< in whose name it holds the robot; ARM must come from the same operator
  MeasurementLimits limits;  ///< of a valid measurement; max_speed 0 = the set's largest
};

/// Replaces the planner: drives each pattern many times and measures its motion.
/** PROGRAM at 20 Hz once the robot sends messages, empty when the robot should stand; EXECUTION,
 * MOTOR and INS in. Chains of joinable patterns lead to the entry classes; an invalid measurement
 * is refused with its reason and repeated. Begins after an ARM that was received after its start.
 * It does not detect obstacles: the room must be free. No planner may run at the same time; if one
 * publishes PROGRAM, the recorder gives up and publishes nothing more. */
class RecorderNode : public Node {
 public:
  using State = RecordingDrive::State;

  /// `say` receives a line for every notable event. Throws std::runtime_error if the set cannot be
  /// driven, see ExcitationPlanner.
  RecorderNode(const PatternSet& set, const RecordingConfig& config, Bus& bus, Say say);

  int64_t period() const override { return 50'000; }
  void step(int64_t utime) override;
  /// Empties the program: the motors stop.
  void shutdown(int64_t utime) override;

  State state() const { return drive_.state(); }
  /// Why it failed or what it waits for; empty while it drives.
  const std::string& reason() const { return drive_.reason(); }
  /// Valid executions so far, by pattern.
  const std::vector<std::vector<recordings::Execution>>& recorded() const {
    return collector_.recorded();
  }

 private:
  void take(const program_t& message);
  bool stands() const;
  /// A second publisher would stop another planner's robot: listen for one first.
  bool listens(int64_t utime) const { return utime < begun_ + kListenFirst; }
  void publishProgram(int64_t utime, const RobotReadings& readings);
  void publishHealth(int64_t utime);

  static constexpr int64_t kListenFirst = 500'000;  ///< [us]

  RecordingConfig config_;
  Bus& bus_;
  HealthReporter health_;
  RobotInputs robot_;
  OperatorBeacon beacon_;
  RecordingDrive drive_;
  ExecutionCollector collector_;
  int64_t begun_ = 0;    ///< [us] first step, or first one after a jump of time
  bool silent_ = false;  ///< another planner publishes PROGRAM
  bool stepped_ = false;
  int64_t seq_program_ = 0;
};

}  // namespace tread::pattern_recorder
