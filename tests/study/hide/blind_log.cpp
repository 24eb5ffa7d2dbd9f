// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/blind_log.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/drive/drive_log.hpp"
#include "common/messages/blank.hpp"
#include "modules/simulator/core/noise.hpp"

namespace tread::blind {
namespace {

constexpr int64_t kSayUs = 200'000;
constexpr int64_t kConfigUs = 10'000'000;
constexpr int64_t kSetVersion = 1;
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
    for (int64_t time = 0; time <= drive_.programme.duration; time += kConfigUs)
      log_.addConfig(begin_ + time, "tread-hide", begin_, text.str());
    log_.addMark(begin_, "surface", "test field");
    log_.addMark(begin_, "note", "recording " + name + " of a teodor");
    log_.addMark(begin_, "standing", "begin");
    if (!drive_.programme.patterns.empty()) {
      log_.addMark(begin_ + drive_.programme.patterns.front().start, "standing", "end");
      log_.addMark(begin_ + endOf(drive_.programme.patterns.back()), "standing", "begin");
    }
  }

  void addIns(const std::vector<sim::InsMeasurement>& samples) {
    for (const sim::InsMeasurement& sample : samples) {
      auto ins = blank<ins_t>();
      ins.ins_status = ins_t::STATUS_NO_VELOCITY;
      ins.utime = begin_ + sample.utime;
      for (int i = 0; i < 3; ++i) ins.position[i] = sample.p_map[i];
      DriveLogBuilder::setAttitude(ins, sample.yaw, sample.pitch, sample.roll);
      ins.rate[2] = sample.rate_body.z();
      log_.add(kIns, ins);
    }
  }

  void addMotor() {
    for (size_t i = 0; i < ticks_.size(); ++i) {
      const int64_t time = static_cast<int64_t>(i) * kCommandUs;
      motor_t motor = armedMotor();
      motor.utime = ticks_[i];
      const int at = drive_.programme.at(time);
      if (at >= 0) fill(motor, static_cast<size_t>(at), time);
      const MotorSample& sample = drive_.motor[i];
      // A Roboteq reports tenths of a volt and of an ampere.
      motor.battery_voltage = tenths(sample.voltage + 0.03 * gaussian_.draw());
      motor.current[0] = tenths(sample.current_left);
      motor.current[1] = tenths(sample.current_right);
      log_.add(kMotor, motor);
    }
  }

  void addExecutions() {
    const auto& patterns = drive_.programme.patterns;
    int64_t next = 0;
    for (size_t i = 0; i < patterns.size(); ++i) {
      const int64_t started = tick(patterns[i].start);
      // Repeats the present state until the next pattern starts.
      sayUntil(patterns[i].start, next);
      record_ = &log_.start(recordOf(patterns[i], i, started));
      say(started);
      next = patterns[i].start + kSayUs;
      sayUntil(endOf(patterns[i]), next);
      complete(*record_, endOf(patterns[i]));
      const bool goes_on = i + 1 < patterns.size() && patterns[i + 1].start == endOf(patterns[i]);
      if (!goes_on) say(tick(endOf(patterns[i])));
      if (!goes_on) next = endOf(patterns[i]) + kSayUs;
    }
    sayUntil(drive_.programme.duration, next);
  }

  std::vector<LogEvent> sorted() { return log_.sorted(); }

 private:
  static int64_t endOf(const Pattern& pattern) {
    return pattern.start + kCommandsPerPattern * kCommandUs;
  }
  /// utime of the command at a time of the programme.
  int64_t tick(int64_t time) const { return ticks_[static_cast<size_t>(time / kCommandUs)]; }

  static motor_t armedMotor() {
    auto motor = blank<motor_t>();
    motor.command[0] = motor.command[1] = 0.0F;
    motor.bridge_state = motor_t::STATE_ARMED;
    motor.state_reason = "armed, no program";
    motor.channel_kind[0] = motor.channel_kind[1] = kKindPower;
    return motor;
  }

  void fill(motor_t& motor, size_t at, int64_t time) const {
    const Pattern& pattern = drive_.programme.patterns[at];
    motor.bridge_state = motor_t::STATE_DRIVING;
    motor.state_reason = "";
    motor.motor_run_id = pattern.run;
    motor.execution_id = static_cast<int64_t>(at) + 1;
    motor.command_index = static_cast<int32_t>((time - pattern.start) / kCommandUs);
    motor.command[0] = static_cast<float>(pattern.power.left);
    motor.command[1] = static_cast<float>(pattern.power.right);
  }

  static float tenths(double value) { return static_cast<float>(std::round(10.0 * value) / 10.0); }

  static execution_record_t recordOf(const Pattern& pattern, size_t at, int64_t started) {
    auto record = blank<execution_record_t>();
    record.record_run_id = pattern.run;
    record.record_execution_id = static_cast<int64_t>(at) + 1;
    record.record_pattern_id = pattern.pattern_id;
    record.record_set_version = kSetVersion;
    record.started = started;
    record.commands_played = 1;
    record.commands_total = kCommandsPerPattern;
    return record;
  }

  void complete(execution_record_t& record, int64_t end) const {
    record.ended = tick(end);
    record.commands_played = kCommandsPerPattern;
    record.outcome = execution_record_t::OUTCOME_COMPLETED;
  }

  /// Publishes the present state every 200 ms until a time of the programme.
  void sayUntil(int64_t end, int64_t& next) {
    for (; next < end; next += kSayUs) say(tick(next));
  }

  void say(int64_t utime) {
    if (record_ != nullptr && record_->outcome == execution_record_t::OUTCOME_RUNNING) {
      const int64_t played = (utime - record_->started) / kCommandUs + 1;
      record_->commands_played =
          static_cast<int32_t>(std::min<int64_t>(played, kCommandsPerPattern));
    }
    log_.publishExecutions(utime);
  }

  const HiddenDrive& drive_;
  int64_t begin_;
  Rng jitter_;
  sim::Gaussian gaussian_;
  std::vector<int64_t> ticks_;  ///< utime of each command
  DriveLogBuilder log_;
  execution_record_t* record_ = nullptr;  ///< of the last execution that started
};

}  // namespace

int64_t startUtime(uint64_t seed) {
  Rng rng(sim::streamSeed(seed, kClockStream));
  return 3'000'000'000 + static_cast<int64_t>(rng.uniform(0.0, 5e10));
}

std::vector<LogEvent> makeLog(const HiddenDrive& drive,
                              const std::vector<sim::InsMeasurement>& measured,
                              const std::string& name, uint64_t seed) {
  LogMaker maker(drive, seed);
  maker.addNotes(name);
  maker.addIns(measured);
  maker.addMotor();
  maker.addExecutions();
  return maker.sorted();
}

}  // namespace tread::blind
