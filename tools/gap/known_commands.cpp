// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/known_commands.hpp"

#include <algorithm>
#include <cmath>

namespace tread::gap {
namespace {

constexpr double kLongestSilence = 0.3;  // [s]
constexpr double kShortestSpan = 1.0;    // [s]
/// How tread-import marks what the recording's own commands do not explain.
constexpr const char* kOperatorDrives = "idle or driven by the operator";

/// Time from one MOTOR message to the next [s], as a rule.
double usualPeriod(const LogMessages& messages) {
  std::vector<int64_t> steps;
  for (size_t i = 1; i < messages.motor.size(); ++i)
    steps.push_back(messages.motor[i].utime - messages.motor[i - 1].utime);
  if (steps.empty()) return 0.05;
  std::nth_element(steps.begin(), steps.begin() + static_cast<long>(steps.size() / 2), steps.end());
  return std::min(kLongestSilence, 1e-6 * static_cast<double>(steps[steps.size() / 2]));
}

class SpanFinder {
 public:
  explicit SpanFinder(double period) : period_(period) {}

  void add(double time, const std::optional<TrackCommand>& command) {
    if (open_ && time - last_ > kLongestSilence) close(last_ + period_, Before::kMotorSilent);
    if (open_ && !command) close(time, Before::kUnknownCommands);
    if (!command) before_ = Before::kUnknownCommands;
    if (!command) return;
    if (!open_) spans_.push_back({{{time, *command}}, time, before_});
    open_ = true;
    last_ = time;
    std::vector<CommandSample>& commands = spans_.back().commands;
    if (commands.back().command != *command) commands.push_back({time, *command});
  }

  std::vector<CommandSpan> finished() {
    if (open_) close(last_ + period_, before_);
    return std::move(spans_);
  }

 private:
  void close(double end, Before why) {
    spans_.back().end = end;
    if (end - spans_.back().begin() < kShortestSpan) spans_.pop_back();
    open_ = false;
    before_ = why;
  }

  double period_;
  std::vector<CommandSpan> spans_;
  Before before_ = Before::kLogBegins;
  double last_ = 0.0;
  bool open_ = false;
};

bool isStill(const TrackCommand& command) {
  return command.left == 0.0 && command.right == 0.0;
}

}  // namespace

std::optional<TrackCommand> obeyed(const motor_t& motor) {
  switch (motor.bridge_state) {
    case motor_t::STATE_DRIVING: {
      const TrackCommand command{static_cast<double>(motor.command_left),
                                 static_cast<double>(motor.command_right)};
      if (!std::isfinite(command.left) || !std::isfinite(command.right)) return std::nullopt;
      return command;
    }
    case motor_t::STATE_ARMED:
    case motor_t::STATE_STOPPING:
      return TrackCommand{};
    case motor_t::STATE_DISARMED:
      if (motor.state_reason == kOperatorDrives) return std::nullopt;
      return TrackCommand{};
    default:
      return std::nullopt;
  }
}

std::vector<CommandSpan> knownCommands(const LogMessages& messages) {
  SpanFinder finder(usualPeriod(messages));
  for (const motor_t& motor : messages.motor)
    finder.add(messages.seconds(motor.utime), obeyed(motor));
  return finder.finished();
}

TrackCommand commandAt(const CommandSpan& span, double time) {
  auto next =
      std::upper_bound(span.commands.begin(), span.commands.end(), time,
                       [](double t, const CommandSample& sample) { return t < sample.time; });
  return next == span.commands.begin() ? next->command : std::prev(next)->command;
}

bool standsBetween(const CommandSpan& span, double from, double to) {
  if (!isStill(commandAt(span, from))) return false;
  auto sample = std::upper_bound(span.commands.begin(), span.commands.end(), from,
                                 [](double t, const CommandSample& c) { return t < c.time; });
  for (; sample != span.commands.end() && sample->time < to; ++sample)
    if (!isStill(sample->command)) return false;
  return true;
}

std::vector<EncoderSample> encoderSamples(const LogMessages& messages) {
  std::vector<EncoderSample> samples;
  for (const motor_t& motor : messages.motor)
    if (std::isfinite(motor.track_speed_left) && std::isfinite(motor.track_speed_right))
      samples.push_back({messages.seconds(motor.utime),
                         {static_cast<double>(motor.track_speed_left),
                          static_cast<double>(motor.track_speed_right)}});
  return samples;
}

std::vector<VoltageSample> voltageSamples(const LogMessages& messages) {
  std::vector<VoltageSample> samples;
  for (const motor_t& motor : messages.motor) {
    const auto voltage = static_cast<double>(motor.battery_voltage);
    if (std::isfinite(voltage)) samples.push_back({messages.seconds(motor.utime), voltage});
  }
  return samples;
}

}  // namespace tread::gap
