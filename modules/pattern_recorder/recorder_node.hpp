// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/messages/robot_inputs.hpp"
#include "modules/pattern_recorder/core/recording_drive.hpp"
#include "modules/pattern_recorder/execution_collector.hpp"

namespace tread::pattern_recorder {

/// What to record on a robot, and how patiently.
struct RecordingConfig {
  int executions = 10;         ///< of each pattern, fair ones
  double room = 8.0;           ///< [m] around where it began; beyond it stops
  int give_up_after = 10;      ///< refusals of a pattern one after the other
  int64_t lease_us = 200'000;  ///< [us] of each PROGRAM
  MeasurementLimits limits;    ///< of a fair measurement; max_speed 0 = the set's largest
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
  /// driven, see Tour.
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
  RecordingDrive drive_;
  ExecutionCollector collector_;
  int64_t begun_ = 0;    ///< [us] first step, or first after a jump of time
  bool silent_ = false;  ///< another planner publishes PROGRAM
  bool stepped_ = false;
  int64_t seq_program_ = 0;
};

}  // namespace tread::pattern_recorder
