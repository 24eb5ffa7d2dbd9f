// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "common/recordings/execution_log.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "common/messages/blank.hpp"

namespace tread::recordings {
namespace {

constexpr int64_t kOriginUs = 10'000'000;
constexpr int64_t kInsPeriodUs = 10'000;
constexpr int64_t kMotorPeriodUs = 50'000;
constexpr int64_t kRunId = 1;

int64_t microseconds(double seconds) {
  return std::llround(seconds * 1e6);
}

/// Own shuffle: the standard library's differs between implementations.
void shuffle(std::vector<size_t>& values, std::mt19937_64& random) {
  for (size_t i = values.size(); i > 1; --i)
    std::swap(values[i - 1], values[static_cast<size_t>(random() % i)]);
}

std::vector<size_t> shuffled(size_t count, std::mt19937_64& random) {
  std::vector<size_t> values(count);
  for (size_t i = 0; i < count; ++i) values[i] = i;
  shuffle(values, random);
  return values;
}

/// A recording as a motion in continuous time, with its steady motion before and after it.
class Motion {
 public:
  Motion(const Execution& poses, double period)
      : poses_(poses), period_(period), length_(period * static_cast<double>(poses.size())) {
    const double n = static_cast<double>(poses.size());
    for (size_t i = 0; i < poses.size(); ++i) {
      const Twist2 twist = twistOf(i);
      steady_.v_x += twist.v_x / n;
      steady_.v_y += twist.v_y / n;
      steady_.omega += twist.omega / n;
    }
  }

  Twist2 twistAt(double time) const { return outside(time) ? steady_ : twistOf(indexAt(time)); }

  Pose2 poseAt(double time) const {
    if (time < 0.0) return integrate(steady_, time);
    if (time > length_) return poses_.back() * integrate(steady_, time - length_);
    const size_t index = indexAt(time);
    const double begin = static_cast<double>(index) * period_;
    return before(index) * integrate(twistOf(index), time - begin);
  }

 private:
  bool outside(double time) const { return time < 0.0 || time > length_; }
  size_t indexAt(double time) const {
    const double index = std::floor(time / period_ + 1e-9);
    return static_cast<size_t>(std::clamp(index, 0.0, static_cast<double>(poses_.size() - 1)));
  }
  Pose2 before(size_t index) const { return index == 0 ? Pose2{} : poses_[index - 1]; }
  Twist2 twistOf(size_t index) const {
    return twistTo(between(before(index), poses_[index]), period_);
  }

  const Execution& poses_;
  double period_;
  double length_;
  Twist2 steady_;
};

class LogMaker {
 public:
  LogMaker(const PatternSet& shipped, const ExecutionLogRequest& request)
      : shipped_(shipped), request_(request) {}

  void addSurface(const SurfaceRecordings& surface, std::mt19937_64& random) {
    log_.addMark(now_, "surface", surface.surface);
    const size_t count = shipped_.patterns().size();
    std::vector<std::vector<size_t>> order(count);
    std::vector<size_t> turns;
    for (int n = 0; n < request_.executions; ++n) {
      if (turns.empty()) turns = shuffled(count, random);
      const size_t pattern = turns.back();
      turns.pop_back();
      std::vector<size_t>& left = order[pattern];
      if (left.empty()) left = shuffled(surface.executions[pattern].size(), random);
      addExecution(shipped_.patterns()[pattern], surface.executions[pattern][left.back()]);
      left.pop_back();
    }
  }

  std::vector<LogEvent> sorted() { return log_.sorted(); }

 private:
  void addExecution(const MotionPattern& pattern, const Execution& poses) {
    const Motion motion(poses, shipped_.periodSeconds());
    const int64_t start = now_ + microseconds(request_.lead);
    const int64_t end =
        start + static_cast<int64_t>(pattern.commands.size()) * shipped_.content().period_us;
    const int64_t last = end + microseconds(request_.tail);
    ++execution_;
    addIns(motion, start, last);
    addMotor(pattern, start, end, last);
    addRecords(pattern, start, end);
    // The robot moves on unmeasured; its path does not matter, because a new track begins.
    T_map_start_ = T_map_start_ * motion.poseAt(static_cast<double>(last - start) * 1e-6);
    now_ = last + microseconds(request_.silence);
  }

  void addIns(const Motion& motion, int64_t start, int64_t last) {
    bool first = true;
    for (int64_t utime = now_; utime <= last; utime += kInsPeriodUs) {
      const double time = static_cast<double>(utime - start) * 1e-6;
      auto ins = blank<ins_t>();
      ins.utime = utime;
      fill(ins, T_map_start_ * motion.poseAt(time), motion.twistAt(time));
      if (first && seen_) ins.ins_status |= ins_t::STATUS_GAP | ins_t::STATUS_JUMP;
      first = false;
      seen_ = true;
      log_.add(kIns, ins);
    }
  }

  static void fill(ins_t& ins, const Pose2& T_map_body, const Twist2& twist) {
    ins.ins_status = ins_t::STATUS_NO_ATTITUDE;
    ins.position[0] = T_map_body.x;
    ins.position[1] = T_map_body.y;
    ins.position[2] = 0.0;
    ins.orientation[0] = std::cos(T_map_body.yaw / 2.0);
    ins.orientation[1] = ins.orientation[2] = 0.0;
    ins.orientation[3] = std::sin(T_map_body.yaw / 2.0);
    ins.velocity[0] = twist.v_x;
    ins.velocity[1] = twist.v_y;
    ins.velocity[2] = 0.0;
    ins.rate[2] = twist.omega;
  }

  void addMotor(const MotionPattern& pattern, int64_t start, int64_t end, int64_t last) {
    const int64_t period = shipped_.content().period_us;
    const std::vector<CommandKind> kinds = kindsOf(shipped_.content().channels);
    for (int64_t utime = now_; utime <= last; utime += kMotorPeriodUs) {
      auto motor = blank<motor_t>();
      motor.utime = utime;
      motor.bridge_state = motor_t::STATE_DRIVING;
      Command command = utime < start ? pattern.commands.front() : pattern.commands.back();
      if (utime >= start && utime < end) {
        motor.motor_run_id = kRunId;
        motor.execution_id = execution_;
        motor.command_index = static_cast<int32_t>((utime - start) / period);
        command = pattern.commands[static_cast<size_t>(motor.command_index)];
      }
      for (size_t i = 0; i < kinds.size(); ++i) {
        motor.channel_kind[i] = static_cast<int16_t>(kinds[i]);
        motor.command[i] = static_cast<float>(command[i]);
      }
      log_.add(kMotor, motor);
    }
  }

  void addRecords(const MotionPattern& pattern, int64_t start, int64_t end) {
    execution_record_t& record = log_.start(blank<execution_record_t>());
    record.record_run_id = kRunId;
    record.record_execution_id = execution_;
    record.started = start;
    record.record_pattern_id = pattern.id;
    record.record_set_version = shipped_.version();
    record.commands_total = static_cast<int32_t>(pattern.commands.size());
    log_.publishExecutions(start);
    record.ended = end;
    record.outcome = execution_record_t::OUTCOME_COMPLETED;
    record.commands_played = record.commands_total;
    log_.publishExecutions(end);
  }

  const PatternSet& shipped_;
  const ExecutionLogRequest& request_;
  DriveLogBuilder log_;
  int64_t now_ = kOriginUs;  ///< [us] when the next execution's lead begins
  int64_t execution_ = 0;
  bool seen_ = false;  ///< by the INS: later tracks start with a jump
  Pose2 T_map_start_;
};

}  // namespace

std::vector<LogEvent> executionLog(const PatternSet& shipped, const SurfaceRecordings& from,
                                   const SurfaceRecordings& to,
                                   const ExecutionLogRequest& request) {
  requireReadable(from, shipped);
  requireReadable(to, shipped);
  std::mt19937_64 random(request.seed);
  LogMaker maker(shipped, request);
  maker.addSurface(from, random);
  maker.addSurface(to, random);
  return maker.sorted();
}

}  // namespace tread::recordings
