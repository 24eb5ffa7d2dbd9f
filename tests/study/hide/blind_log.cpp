// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/blind_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <Eigen/Geometry>

#include "modules/simulator/core/random.hpp"

namespace tread::blind {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr int64_t kSayUs = 200'000;
constexpr int64_t kConfigUs = 10'000'000;
constexpr int64_t kSetVersion = 1;
constexpr size_t kRecords = 8;
constexpr int16_t kKindPower = 1;  // program_slot_t.KIND_POWER

class LogMaker {
 public:
  LogMaker(const HiddenDrive& drive, uint64_t seed)
      : drive_(drive),
        begin_(startUtime(seed)),
        jitter_(sim::streamSeed(seed, kClockStream)),
        gaussian_(sim::streamSeed(seed, kBatteryStream)) {
    for (size_t i = 0; i < drive.motor.size(); ++i)
      ticks_.push_back(begin_ + static_cast<int64_t>(i) * kCommandUs +
                       static_cast<int64_t>(jitter_.uniform(0.0, 300.0)));
  }

  void addNotes(const std::string& name) {
    std::ostringstream text;
    text << "recording: \"" << name << "\"\nrobot: \"teodor\"\ncommand_kind: power\n"
         << "period_us: " << kCommandUs << "\npattern_commands: " << kCommandsPerPattern << "\n";
    int64_t seq = 0;
    for (int64_t time = 0; time <= drive_.programme.duration; time += kConfigUs) {
      config_t config{};
      config.utime = begin_ + time;
      config.seq = seq++;
      config.config_process = "tread-hide";
      config.config_boot_id = begin_;
      config.config_text = text.str();
      add(kConfig, config);
    }
    addMark(0, 0, "surface", "test field");
    addMark(0, 1, "note", "recording " + name + " of a teodor");
    addMark(0, 2, "standing", "begin");
    if (!drive_.programme.patterns.empty()) {
      addMark(drive_.programme.patterns.front().start, 3, "standing", "end");
      addMark(endOf(drive_.programme.patterns.back()), 4, "standing", "begin");
    }
  }

  void addIns(const std::vector<sim::InsSample>& samples) {
    int64_t seq = 0;
    for (const sim::InsSample& sample : samples) {
      ins_t ins = blankIns();
      ins.utime = begin_ + sample.utime;
      ins.seq = seq++;
      for (int i = 0; i < 3; ++i) ins.position[i] = sample.p_map[i];
      using Eigen::AngleAxisd;
      using Eigen::Vector3d;
      const Eigen::Quaterniond q = AngleAxisd(sample.yaw, Vector3d::UnitZ()) *
                                   AngleAxisd(sample.pitch, Vector3d::UnitY()) *
                                   AngleAxisd(sample.roll, Vector3d::UnitX());
      ins.orientation[0] = q.w();
      ins.orientation[1] = q.x();
      ins.orientation[2] = q.y();
      ins.orientation[3] = q.z();
      ins.rate[2] = sample.rate_body.z();
      add(kIns, ins);
    }
  }

  void addMotor() {
    for (size_t i = 0; i < ticks_.size(); ++i) {
      const int64_t time = static_cast<int64_t>(i) * kCommandUs;
      motor_t motor = blankMotor();
      motor.utime = ticks_[i];
      motor.seq = static_cast<int64_t>(i);
      const int at = drive_.programme.at(time);
      if (at >= 0) fill(motor, static_cast<size_t>(at), time);
      const MotorSample& sample = drive_.motor[i];
      // A Roboteq tells tenths of a volt and of an ampere.
      motor.battery_voltage = tenths(sample.voltage + 0.03 * gaussian_.draw());
      motor.current_left = tenths(sample.current_left);
      motor.current_right = tenths(sample.current_right);
      add(kMotor, motor);
    }
  }

  void addExecutions() {
    const auto& patterns = drive_.programme.patterns;
    int64_t next = 0;
    for (size_t i = 0; i < patterns.size(); ++i) {
      const int64_t started = tick(patterns[i].start);
      // Until the next one starts, what is known is said again and again.
      sayUntil(patterns[i].start, next);
      if (records_.size() == kRecords) records_.erase(records_.begin());
      records_.push_back(recordOf(patterns[i], i, started));
      say(started);
      next = patterns[i].start + kSayUs;
      sayUntil(endOf(patterns[i]), next);
      complete(records_.back(), endOf(patterns[i]));
      const bool goes_on = i + 1 < patterns.size() && patterns[i + 1].start == endOf(patterns[i]);
      if (!goes_on) say(tick(endOf(patterns[i])));
      if (!goes_on) next = endOf(patterns[i]) + kSayUs;
    }
    sayUntil(drive_.programme.duration, next);
  }

  std::vector<LogEvent> sorted() {
    std::stable_sort(events_.begin(), events_.end(),
                     [](const LogEvent& a, const LogEvent& b) { return a.utime < b.utime; });
    return std::move(events_);
  }

 private:
  template <class Message>
  void add(const Channel<Message>& channel, const Message& message) {
    events_.push_back(eventOf(channel, message));
  }

  void addMark(int64_t time, int64_t seq, const char* kind, const std::string& value) {
    mark_t mark{};
    mark.utime = begin_ + time;
    mark.seq = seq;
    mark.mark_kind = kind;
    mark.mark_value = value;
    add(kMark, mark);
  }

  static int64_t endOf(const Pattern& pattern) {
    return pattern.start + kCommandsPerPattern * kCommandUs;
  }
  /// utime of the command at a time of the programme.
  int64_t tick(int64_t time) const { return ticks_[static_cast<size_t>(time / kCommandUs)]; }

  static ins_t blankIns() {
    ins_t ins{};
    ins.device_utc = -1;
    ins.satellites = -1;
    ins.ins_status = ins_t::STATUS_NO_VELOCITY;
    for (int i = 0; i < 3; ++i)
      ins.velocity[i] = ins.rate[i] = ins.position_std[i] = ins.attitude_std[i] = kUnknown;
    return ins;
  }

  static motor_t blankMotor() {
    motor_t motor{};
    motor.command_index = -1;
    motor.bridge_state = motor_t::STATE_ARMED;
    motor.state_reason = "armed, no program";
    motor.motor_command_kind = kKindPower;
    motor.track_speed_left = motor.track_speed_right = static_cast<float>(kUnknown);
    return motor;
  }

  void fill(motor_t& motor, size_t at, int64_t time) const {
    const Pattern& pattern = drive_.programme.patterns[at];
    motor.bridge_state = motor_t::STATE_DRIVING;
    motor.state_reason = "";
    motor.motor_run_id = pattern.run;
    motor.execution_id = static_cast<int64_t>(at) + 1;
    motor.command_index = static_cast<int32_t>((time - pattern.start) / kCommandUs);
    motor.command_left = static_cast<float>(pattern.power.left);
    motor.command_right = static_cast<float>(pattern.power.right);
  }

  static float tenths(double value) { return static_cast<float>(std::round(10.0 * value) / 10.0); }

  static execution_record_t recordOf(const Pattern& pattern, size_t at, int64_t started) {
    execution_record_t record{};
    record.record_run_id = pattern.run;
    record.record_execution_id = static_cast<int64_t>(at) + 1;
    record.record_pattern_id = pattern.pattern_id;
    record.record_set_version = kSetVersion;
    record.started = started;
    record.ended = -1;
    record.commands_played = 1;
    record.commands_total = kCommandsPerPattern;
    record.outcome = execution_record_t::OUTCOME_RUNNING;
    return record;
  }

  void complete(execution_record_t& record, int64_t end) const {
    record.ended = tick(end);
    record.commands_played = kCommandsPerPattern;
    record.outcome = execution_record_t::OUTCOME_COMPLETED;
  }

  /// Says what is known every 200 ms before a time of the programme.
  void sayUntil(int64_t end, int64_t& next) {
    for (; next < end; next += kSayUs) say(tick(next));
  }

  void say(int64_t utime) {
    if (!records_.empty() && records_.back().outcome == execution_record_t::OUTCOME_RUNNING) {
      const int64_t played = (utime - records_.back().started) / kCommandUs + 1;
      records_.back().commands_played =
          static_cast<int32_t>(std::min<int64_t>(played, kCommandsPerPattern));
    }
    execution_t message{};
    message.utime = utime;
    message.seq = seq_execution_++;
    message.records = records_;
    message.num_records = static_cast<int32_t>(records_.size());
    add(kExecution, message);
  }

  const HiddenDrive& drive_;
  int64_t begin_;
  Dice jitter_;
  sim::Gaussian gaussian_;
  std::vector<int64_t> ticks_;  ///< utime of each command
  std::vector<LogEvent> events_;
  std::vector<execution_record_t> records_;
  int64_t seq_execution_ = 0;
};

}  // namespace

int64_t startUtime(uint64_t seed) {
  Dice dice(sim::streamSeed(seed, kClockStream));
  return 3'000'000'000 + static_cast<int64_t>(dice.uniform(0.0, 5e10));
}

std::vector<LogEvent> makeLog(const HiddenDrive& drive, const std::vector<sim::InsSample>& measured,
                              const std::string& name, uint64_t seed) {
  LogMaker maker(drive, seed);
  maker.addNotes(name);
  maker.addIns(measured);
  maker.addMotor();
  maker.addExecutions();
  return maker.sorted();
}

}  // namespace tread::blind
