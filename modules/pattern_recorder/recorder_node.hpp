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

/// Cuts the executions of one run out of INS, EXECUTION and MOTOR, as the learner does, and keeps
/// the fair ones of each pattern.
/** What is refused is told with its reason. Patterns are given by their place in the set. */
class ExecutionCollector {
 public:
  /// `wanted` executions of each pattern are kept; `limits` as the learner's, max_speed 0 = the
  /// set's largest.
  ExecutionCollector(const PatternSet& set, int64_t run_id, int wanted, int give_up_after,
                     const MeasurementLimits& limits, Say say);

  void take(const ins_t& message, int64_t now) { ins_.add(message, now); }
  void take(const motor_t& message) { commands_.add(message); }
  void take(const execution_t& message, int64_t now) { executions_.add(message, now); }

  /// Judges what has ended and is covered by the INS. Returns the execution ids of this run that
  /// were judged.
  std::vector<int64_t> judge(int64_t utime);

  const std::vector<std::vector<recordings::Execution>>& recorded() const { return recorded_; }
  /// Executions still missing, by pattern; 0 = it has all.
  std::vector<int> missing() const;
  int64_t refused() const { return refused_; }
  /// Why it is hopeless: a pattern was refused too often in a row; empty if it is not.
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

/// What to record on a robot, and how patiently.
struct RecordingConfig {
  int executions = 10;                     ///< of each pattern, fair ones
  double room = 8.0;                       ///< [m] around where it began; beyond it stops
  int give_up_after = 10;                  ///< refusals of a pattern one after the other
  int64_t lease_us = 200'000;              ///< [us] of each PROGRAM
  std::string operator_name = "operator";  ///< for whom it holds the robot; ARM must be theirs
  MeasurementLimits limits;  ///< of a fair measurement; max_speed 0 = the set's largest
};

/// Takes the planner's place, drives each pattern many times and measures what it did.
/** PROGRAM at 20 Hz once the robot speaks, empty when the robot shall stand; EXECUTION, MOTOR and
 * INS in. Chains of joinable patterns bring it into the entry classes; an unfair measurement is
 * refused with its reason and driven again. Begins when ARM was seen after its start. It sees no
 * obstacles: the room must be free. No planner may run beside it; where one publishes PROGRAM, it
 * gives up and publishes nothing more. */
class RecorderNode : public Node {
 public:
  using State = RecordingDrive::State;

  /// `say` gets a line for everything worth telling. Throws std::runtime_error if the set cannot be
  /// driven, see ExcitationPlanner.
  RecorderNode(const PatternSet& set, const RecordingConfig& config, Bus& bus, Say say);

  int64_t period() const override { return 50'000; }
  void step(int64_t utime) override;
  /// Empties the program: the motors stop.
  void shutdown(int64_t utime) override;

  State state() const { return drive_.state(); }
  /// Why it failed or what it waits for; empty while it drives.
  const std::string& reason() const { return drive_.reason(); }
  /// Fair executions by pattern so far.
  const std::vector<std::vector<recordings::Execution>>& recorded() const {
    return collector_.recorded();
  }

 private:
  void take(const program_t& message);
  bool stands() const;
  /// Another planner would be stopped by a second publisher: listen for one first.
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
  int64_t begun_ = 0;    ///< [us] first step, or first after a jump of time
  bool silent_ = false;  ///< another planner publishes PROGRAM
  bool stepped_ = false;
  int64_t seq_program_ = 0;
};

}  // namespace tread::pattern_recorder
