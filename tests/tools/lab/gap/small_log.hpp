// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "common/execution/stop_reason.hpp"
#include "common/log/event_log.hpp"
#include "common/pattern/pattern.hpp"

// Synthetic logs, message by message.
namespace tread::samples {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// utime of a time [s]; logs do not begin at 0.
inline int64_t at(double seconds) {
  return 5'000'000 + std::llround(seconds * 1e6);
}

class SmallLog {
 public:
  template <class Message>
  void add(const Channel<Message>& channel, const Message& message) {
    events.push_back(eventOf(channel, message));
  }

  motor_t& lastMotor() { return motor_; }

  /// MOTOR: driving this command.
  void motor(double time, TrackCommand command, int16_t state = motor_t::STATE_DRIVING,
             StopReason reason = StopReason::kNone, TrackCommand speed = {kNaN, kNaN}) {
    motor_ = motor_t{};
    motor_.utime = at(time);
    motor_.seq = seq_motor_++;
    motor_.bridge_state = state;
    motor_.state_code = static_cast<int16_t>(reason);
    motor_.state_reason = sentenceOf(reason);
    motor_.channel_kind[0] = motor_.channel_kind[1] =
        static_cast<int16_t>(CommandKind::kTrackSpeed);
    motor_.command[0] = static_cast<float>(command.left);
    motor_.command[1] = static_cast<float>(command.right);
    motor_.battery_voltage = voltage;
    motor_.current[0] = current_left;
    motor_.current[1] = current_right;
    motor_.measured[0] = static_cast<float>(speed.left);
    motor_.measured[1] = static_cast<float>(speed.right);
    add(kMotor, motor_);
  }

  /// INS: pose, gyro, and status in addition to "no attitude, no velocity".
  void ins(double time, const Pose2& T_map_body, double omega, int32_t status = 0) {
    ins_t message{};
    message.utime = at(time);
    message.seq = seq_ins_++;
    message.device_utc = -1;
    message.satellites = -1;
    message.ins_status = status | ins_t::STATUS_NO_VELOCITY | ins_t::STATUS_NO_ATTITUDE;
    message.position[0] = T_map_body.x;
    message.position[1] = T_map_body.y;
    message.orientation[0] = std::cos(T_map_body.yaw / 2.0);
    message.orientation[3] = std::sin(T_map_body.yaw / 2.0);
    for (double& value : message.velocity) value = kNaN;
    message.rate[2] = omega;
    add(kIns, message);
  }

  /// EXECUTION: one completed record.
  void execution(int64_t id, double begin, double end,
                 int16_t outcome = execution_record_t::OUTCOME_COMPLETED) {
    execution_t message{};
    message.utime = at(end);
    execution_record_t record{};
    record.record_run_id = 1;
    record.record_execution_id = id;
    record.started = at(begin);
    record.ended = at(end);
    record.outcome = outcome;
    message.records = {record};
    message.num_records = 1;
    add(kExecution, message);
  }

  std::vector<LogEvent> sorted() const {
    std::vector<LogEvent> result = events;
    std::stable_sort(result.begin(), result.end(),
                     [](const LogEvent& a, const LogEvent& b) { return a.utime < b.utime; });
    return result;
  }

  std::vector<LogEvent> events;
  float voltage = static_cast<float>(kNaN);
  float current_left = static_cast<float>(kNaN);
  float current_right = static_cast<float>(kNaN);

 private:
  motor_t motor_{};
  int64_t seq_motor_ = 0;
  int64_t seq_ins_ = 0;
};

/// Drives a constant twist from a time on: MOTOR at 20 Hz, INS at 10 Hz, tracks 1 m apart.
/** Returns the pose at the end. */
inline Pose2 drive(SmallLog& log, double begin, double end, const Twist2& twist, Pose2 T_map_body) {
  const TrackCommand command{twist.v_x - 0.5 * twist.omega, twist.v_x + 0.5 * twist.omega};
  const auto ticks = static_cast<int>(std::lround((end - begin) / 0.05));
  for (int i = 0; i < ticks; ++i) {
    const double time = begin + 0.05 * i;
    log.motor(time, command);
    if (i % 2 == 0) log.ins(time, T_map_body, twist.omega);
    T_map_body = T_map_body * integrate(twist, 0.05);
  }
  return T_map_body;
}

}  // namespace tread::samples
