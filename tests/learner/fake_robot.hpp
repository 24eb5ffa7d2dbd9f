// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "tests/learner/samples.hpp"

namespace tread::learner::samples {

/// A robot on some ground, without vehicle, planner or bridge: INS at 50 Hz, EXECUTION at 5 Hz and
/// on change.
struct Driving {
  std::vector<int> patterns = {kLeft, kStraight, kRight, kLeft};  ///< ids, repeated
  std::map<int, Twist2> truth = {
      {kStraight, {0.9, 0.0, 0.0}}, {kLeft, {0.8, 0.0, 0.6}}, {kRight, {0.8, 0.0, -0.6}}};
  int64_t set_version = 0;     ///< named in the records; 0 = the newest received
  int executions = 1'000'000;  ///< then it stands
  int abort_every = 0;         ///< one of so many executions is aborted at its end; 0 = none
  Reason abort_reason = StopReason::kProgramLate;
  bool wrong_commands = false;  ///< the motors get commands other than the pattern's
};

/// Drives patterns without gaps, one second each, and ignores all messages.
class FakeRobot : public Node {
 public:
  FakeRobot(Bus& bus, Driving driving) : bus_(bus), driving_(std::move(driving)) {
    bus.subscribe<pattern_set_part_t>(kPatternSet, [this](const pattern_set_part_t& part) {
      newest_version_ = part.set_version;
    });
  }

  int64_t period() const override { return 20'000; }
  void step(int64_t utime) override {
    // Half a second of cruise before the first execution.
    if (begin_ == 0) begin_ = utime + 500'000;
    const int64_t number = utime < begin_ ? -1 : (utime - begin_) / kSecond;
    if (number != current_) change(number, utime);
    publishIns(utime);
    if (number >= 0 && number < driving_.executions) publishMotor(utime, number);
    if (utime % 200'000 == 0) publishExecutions(utime);
  }

 private:
  static constexpr int64_t kSecond = 1'000'000;

  int idOf(int64_t number) const {
    return driving_.patterns[static_cast<size_t>(number) % driving_.patterns.size()];
  }
  Twist2 twistOf(int64_t number) const {
    if (number >= driving_.executions) return {};
    return number < 0 ? Twist2{1.0, 0.0, 0.0} : driving_.truth.at(idOf(number));
  }
  int64_t startOf(int64_t number) const {
    return number < 0 ? begin_ - 500'000 : begin_ + number * kSecond;
  }

  void change(int64_t number, int64_t utime) {
    if (current_ >= -1)
      T_map_start_ =
          T_map_start_ * integrate(twistOf(current_), seconds(startOf(number) - startOf(current_)));
    if (!records_.empty() && records_.back().outcome == 0) close(startOf(number));
    current_ = number;
    if (number >= 0 && number < driving_.executions) open(number);
    publishExecutions(utime);
  }

  void open(int64_t number) {
    execution_record_t record{};
    record.record_run_id = 5;
    record.record_execution_id = number + 1;
    record.record_pattern_id = idOf(number);
    record.record_set_version = driving_.set_version > 0 ? driving_.set_version : newest_version_;
    record.started = startOf(number);
    record.ended = -1;
    record.commands_played = record.commands_total = 20;
    records_.push_back(record);
    if (records_.size() > 8) records_.erase(records_.begin());
  }
  void close(int64_t ended) {
    execution_record_t& record = records_.back();
    const bool abort =
        driving_.abort_every > 0 && record.record_execution_id % driving_.abort_every == 0;
    record.outcome =
        abort ? execution_record_t::OUTCOME_ABORTED : execution_record_t::OUTCOME_COMPLETED;
    if (abort) {
      record.outcome_code = static_cast<int16_t>(driving_.abort_reason.code);
      record.outcome_reason = driving_.abort_reason.words;
    }
    record.ended = ended;
  }

  void publishExecutions(int64_t utime) {
    execution_t message{};
    message.utime = utime;
    message.seq = seq_execution_++;
    message.records = records_;
    message.num_records = static_cast<int32_t>(records_.size());
    bus_.publish(kExecution, message);
  }
  void publishIns(int64_t utime) {
    const Pose2 pose =
        T_map_start_ * integrate(twistOf(current_), seconds(utime - startOf(current_)));
    ins_t ins{};
    ins.utime = utime;
    ins.seq = seq_ins_++;
    ins.position[0] = pose.x;
    ins.position[1] = pose.y;
    ins.orientation[0] = std::cos(pose.yaw / 2.0);
    ins.orientation[3] = std::sin(pose.yaw / 2.0);
    bus_.publish(kIns, ins);
  }
  void publishMotor(int64_t utime, int64_t number) {
    static const std::map<int, TrackCommand> kCommands = {
        {kStraight, {1.0, 1.0}}, {kLeft, {0.7, 1.0}}, {kRight, {1.0, 0.7}}};
    const auto command = kCommands.find(idOf(number));
    if (command == kCommands.end()) return;
    motor_t motor{};
    motor.utime = utime;
    motor.seq = seq_motor_++;
    motor.motor_run_id = 5;
    motor.execution_id = number + 1;
    motor.command_index = static_cast<int32_t>((utime - startOf(number)) / 50'000);
    motor.channel_kind[0] = motor.channel_kind[1] = 1;
    motor.command[0] = static_cast<float>(command->second.left);
    motor.command[1] =
        static_cast<float>(command->second.right) * (driving_.wrong_commands ? 0.5F : 1.0F);
    bus_.publish(kMotor, motor);
  }
  static double seconds(int64_t us) { return static_cast<double>(us) * 1e-6; }

  Bus& bus_;
  Driving driving_;
  int64_t begin_ = 0;
  int64_t current_ = -2;
  int64_t newest_version_ = 0;
  Pose2 T_map_start_;
  std::vector<execution_record_t> records_;
  int64_t seq_ins_ = 0;
  int64_t seq_execution_ = 0;
  int64_t seq_motor_ = 0;
};

}  // namespace tread::learner::samples
