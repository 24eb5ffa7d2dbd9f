// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/soundness/reading.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/execution/stop_reason.hpp"
#include "common/geometry/se3.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::gap {
namespace {

constexpr double kLongestSilence = 0.3;  // [s]
constexpr double kShortestSpan = 1.0;    // [s]

/// Time from one MOTOR message to the next [s], as a rule.
double usualPeriod(const SortedLog& log) {
  std::vector<int64_t> steps;
  for (size_t i = 1; i < log.motor.size(); ++i)
    steps.push_back(log.motor[i].utime - log.motor[i - 1].utime);
  if (steps.empty()) return 0.05;
  return std::min(kLongestSilence, 1e-6 * static_cast<double>(upperMedian(std::move(steps))));
}

class SpanFinder {
 public:
  SpanFinder(VehicleLayout layout, double period) : layout_(layout), period_(period) {}

  void add(double time, const std::optional<Command>& command) {
    if (open_ && time - last_ > kLongestSilence) close(last_ + period_, true);
    if (open_ && !command) close(time, false);
    if (!command) after_silence_ = false;
    if (!command) return;
    if (!open_) spans_.push_back({{{time, *command}}, time, layout_, after_silence_});
    open_ = true;
    last_ = time;
    std::vector<CommandSample>& commands = spans_.back().commands;
    if (commands.back().command != *command) commands.push_back({time, *command});
  }

  std::vector<CommandSpan> finished() {
    if (open_) close(last_ + period_, after_silence_);
    return std::move(spans_);
  }

 private:
  void close(double end, bool by_silence) {
    spans_.back().end = end;
    if (end - spans_.back().begin() < kShortestSpan) spans_.pop_back();
    open_ = false;
    after_silence_ = by_silence;
  }

  VehicleLayout layout_;
  double period_;
  std::vector<CommandSpan> spans_;
  bool after_silence_ = false;
  double last_ = 0.0;
  bool open_ = false;
};

/// A vehicle commanded to stop for this long is at rest [s].
constexpr double kSettled = 1.0;

bool samePose(const Pose2& a, const Pose2& b) {
  return a.x == b.x && a.y == b.y && a.yaw == b.yaw;
}

InsSample sampleOf(const SortedLog& log, const ins_t& ins, const std::optional<Pose2>& pose) {
  InsSample sample;
  sample.time = log.seconds(ins.utime);
  sample.T_map_body = pose.value_or(Pose2{kNotMeasured, kNotMeasured, kNotMeasured});
  if (std::isfinite(ins.rate[2])) sample.omega = ins.rate[2];
  if ((ins.ins_status & ins_t::STATUS_NO_ATTITUDE) != 0) return sample;
  const YawPitchRoll angles = yawPitchRoll(Eigen::Quaterniond(
      ins.orientation[0], ins.orientation[1], ins.orientation[2], ins.orientation[3]));
  sample.roll = angles.roll;
  sample.pitch = angles.pitch;
  return sample;
}

class Reader {
 public:
  Reader(const SortedLog& log, const CommandSpan& span) : log_(log), span_(span) {}

  void add(const ins_t& ins) {
    // A jump counts even if its own message has no pose: a new track follows.
    jumped_ = jumped_ || (ins.ins_status & ins_t::STATUS_JUMP) != 0;
    std::optional<Pose2> pose = planarPose(ins);
    const double time = log_.seconds(ins.utime);
    if (pose && isHeld(*pose, time)) {
      hold(time);
      pose.reset();
    } else if (pose) {
      last_ = *pose;
      last_time_ = time;
      holding_ = false;
    }
    InsReading reading{sampleOf(log_, ins, pose), pose.has_value(), pose && jumped_};
    if (reading.fresh) jumped_ = false;
    if (reading.fresh || std::isfinite(reading.sample.omega)) result_.readings.push_back(reading);
  }

  SpanReadings result() { return std::move(result_); }

 private:
  bool isHeld(const Pose2& pose, double time) {
    const bool stands = standsBetween(span_, time - kSettled, time);
    if (!stands) ++result_.poses;
    // A pose that froze while driving does not become valid at standstill.
    return (!stands || holding_) && last_ && samePose(*last_, pose);
  }

  void hold(double time) {
    ++result_.repeated;
    if (!holding_) result_.held.push_back({last_time_, time});
    result_.held.back().end = time;
    holding_ = true;
  }

  const SortedLog& log_;
  const CommandSpan& span_;
  SpanReadings result_;
  std::optional<Pose2> last_;
  double last_time_ = 0.0;
  bool holding_ = false;
  bool jumped_ = false;
};

template <class Message>
void sortByTime(std::vector<Message>& messages) {
  std::stable_sort(messages.begin(), messages.end(),
                   [](const Message& a, const Message& b) { return a.utime < b.utime; });
}

}  // namespace

SortedLog::SortedLog(const DriveLog& drive_log)
    : drive(drive_log), motor(drive_log.motor), ins(drive_log.ins) {
  sortByTime(motor);
  sortByTime(ins);
  for (const motor_t& message : motor)
    if (const auto kinds = kindsFrom(message); !kinds.empty()) {
      layout = layoutOf(kinds);
      channels = std::max<size_t>(2, kinds.size());
    }
  if (!motor.empty()) origin = motor.front().utime;
  if (!ins.empty())
    origin = motor.empty() ? ins.front().utime : std::min(origin, ins.front().utime);
}

std::optional<Command> obeyed(const motor_t& motor) {
  switch (motor.bridge_state) {
    case motor_t::STATE_DRIVING:
    case motor_t::STATE_MANUAL: {
      Command command;
      for (size_t channel = 0; channel < std::max<size_t>(2, kindsFrom(motor).size()); ++channel) {
        command[channel] = static_cast<double>(motor.command[channel]);
        if (!std::isfinite(command[channel])) return std::nullopt;
      }
      return command;
    }
    case motor_t::STATE_ARMED:
    case motor_t::STATE_STOPPING:
      return Command{};
    case motor_t::STATE_DISARMED:
      if (stopReasonFrom(motor.state_code) == StopReason::kOperatorDrives) return std::nullopt;
      return Command{};
    default:
      return std::nullopt;
  }
}

std::vector<CommandSpan> knownCommands(const SortedLog& log) {
  SpanFinder finder(log.layout, usualPeriod(log));
  for (const motor_t& motor : log.motor) finder.add(log.seconds(motor.utime), obeyed(motor));
  return finder.finished();
}

Command commandAt(const CommandSpan& span, double time) {
  auto next =
      std::upper_bound(span.commands.begin(), span.commands.end(), time,
                       [](double t, const CommandSample& sample) { return t < sample.time; });
  return next == span.commands.begin() ? next->command : std::prev(next)->command;
}

bool standsBetween(const CommandSpan& span, double from, double to) {
  if (driveOf(span.layout, commandAt(span, from)) != 0.0) return false;
  auto sample = std::upper_bound(span.commands.begin(), span.commands.end(), from,
                                 [](double t, const CommandSample& c) { return t < c.time; });
  for (; sample != span.commands.end() && sample->time < to; ++sample)
    if (driveOf(span.layout, sample->command) != 0.0) return false;
  return true;
}

std::vector<EncoderSample> encoderSamples(const SortedLog& log) {
  std::vector<EncoderSample> samples;
  for (const motor_t& motor : log.motor) {
    EncoderSample sample{log.seconds(motor.utime), {}};
    bool whole = true;
    for (size_t wheel = 0; wheel < log.channels; ++wheel) {
      const size_t of = log.layout == VehicleLayout::kCar ? 0 : wheel;
      sample.speed[wheel] = static_cast<double>(motor.measured[of]);
      whole = whole && std::isfinite(motor.measured[of]);
    }
    if (whole) samples.push_back(sample);
  }
  return samples;
}

std::vector<CurrentSample> currentSamples(const SortedLog& log) {
  std::vector<CurrentSample> samples;
  if (log.layout != VehicleLayout::kTracks) return samples;
  for (const motor_t& motor : log.motor)
    if (std::isfinite(motor.current[0]) && std::isfinite(motor.current[1]))
      samples.push_back({log.seconds(motor.utime), static_cast<double>(motor.current[0]),
                         static_cast<double>(motor.current[1])});
  return samples;
}

std::vector<VoltageSample> voltageSamples(const SortedLog& log) {
  std::vector<VoltageSample> samples;
  for (const motor_t& motor : log.motor) {
    const auto voltage = static_cast<double>(motor.battery_voltage);
    if (std::isfinite(voltage)) samples.push_back({log.seconds(motor.utime), voltage});
  }
  return samples;
}

SpanReadings insReadings(const SortedLog& log, const CommandSpan& span) {
  Reader reader(log, span);
  const auto first = std::lower_bound(
      log.ins.begin(), log.ins.end(), span.begin(),
      [&](const ins_t& ins, double time) { return log.seconds(ins.utime) < time; });
  for (auto ins = first; ins != log.ins.end(); ++ins) {
    if (log.seconds(ins->utime) > span.end) break;
    reader.add(*ins);
  }
  return reader.result();
}

}  // namespace tread::gap
