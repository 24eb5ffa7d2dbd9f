// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/soundness/core/log_validation_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/soundness/core/lag_table.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::gap {
namespace {

constexpr double kJump = 0.5;            // [m]
constexpr double kTooManyJumps = 0.05;   // of the pose steps
constexpr double kSettled = 3.0;         // [s] after which a vehicle stands; tracks recoil
constexpr double kNearlyStraight = 0.3;  // [rad]
constexpr double kLeastAlong = 0.6;      // of the course, squared: less means another heading

/// Steps between new poses.
struct PoseSteps {
  size_t readings = 0;
  std::vector<double> durations;  ///< [s]
  size_t jumps = 0;
  double first_jump = 0.0;    ///< [s]
  double fastest_jump = 0.0;  ///< [m/s]
};

PoseSteps poseSteps(const Drive& drive) {
  PoseSteps steps;
  const double fastest = fastestOf(drive.layout);
  for (const Segment& segment : drive.segments) {
    const InsSample* last = nullptr;
    steps.readings += segment.ins.size();
    for (const InsSample& sample : segment.ins) {
      if (!sample.hasPose()) continue;
      if (last != nullptr && sample.time > last->time) {
        const double duration = sample.time - last->time;
        const double way = (sample.T_map_body.position() - last->T_map_body.position()).norm();
        steps.durations.push_back(duration);
        if (way > kJump && way > fastest * duration) {
          if (steps.jumps++ == 0) steps.first_jump = sample.time;
          steps.fastest_jump = std::max(steps.fastest_jump, way / duration);
        }
      }
      last = &sample;
    }
  }
  return steps;
}

/// Checks that the position moves along the heading.
void checkCourse(const std::vector<PoseIncrement>& increments, Diagnostics& notes) {
  double along = 0.0;
  double all = 0.0;
  size_t rows = 0;
  for (const PoseIncrement& increment : increments) {
    const Pose2& step = increment.T_begin_end;
    const double way = step.x * step.x + step.y * step.y;
    if (std::abs(step.yaw) > kNearlyStraight || way < 0.01) continue;
    along += step.x * step.x;
    all += way;
    ++rows;
  }
  if (rows < 20 || along >= kLeastAlong * all) return;
  notes.add(findings::kCourseOff, {digits(100.0 * along / all, 0)});
}

/// Times in which a segment commands zero for long.
std::vector<std::pair<double, double>> standstills(VehicleLayout layout, const Segment& segment) {
  std::vector<std::pair<double, double>> times;
  const auto stands = [&](size_t i) { return driveOf(layout, segment.commands[i].command) == 0.0; };
  for (size_t i = 0; i < segment.commands.size(); ++i) {
    if (!stands(i)) continue;
    const double begin = segment.commands[i].time;
    while (i < segment.commands.size() && stands(i)) ++i;
    const double end = i < segment.commands.size() ? segment.commands[i].time : segment.end;
    if (end - begin > kSettled + 1.0) times.push_back({begin + kSettled, end});
  }
  return times;
}

/// Spread of values about their own mean at each standstill.
class Spread {
 public:
  void add(double value) {
    ++n_;
    sum_ += value;
    squares_ += value * value;
  }
  void endStandstill() {
    if (n_ > 1.0) {
      deviation_ += squares_ - sum_ * sum_ / n_;
      freedom_ += n_ - 1.0;
    }
    total_ += sum_;
    count_ += n_;
    n_ = sum_ = squares_ = 0.0;
  }
  double mean() const { return total_ / count_; }
  double deviation() const { return std::sqrt(std::max(0.0, deviation_ / freedom_)); }
  bool known() const { return freedom_ > 0.0; }

 private:
  double n_ = 0.0, sum_ = 0.0, squares_ = 0.0;
  double total_ = 0.0, count_ = 0.0, deviation_ = 0.0, freedom_ = 0.0;
};

std::string range(std::vector<double>& values, const std::string& unit) {
  return digits(quantileOf(values, 0.01), 2) + " to " + digits(quantileOf(values, 0.99), 2) + " " +
         unit;
}

/// How often a command changes its sign.
size_t reversals(const Drive& drive) {
  size_t count = 0;
  for (const Segment& segment : drive.segments) {
    double last = 0.0;
    for (const CommandSample& sample : segment.commands) {
      const TrackCommand sides = drive.sides(sample.command);
      const double drive_command = sides.left + sides.right;
      if (drive_command * last < 0.0) ++count;
      if (drive_command != 0.0) last = drive_command;
    }
  }
  return count;
}

std::string slopes(const Drive& drive) {
  std::vector<double> pitch;
  std::vector<double> roll;
  for (const Segment& segment : drive.segments)
    for (const InsSample& sample : segment.ins) {
      if (std::isfinite(sample.pitch)) pitch.push_back(sample.pitch);
      if (std::isfinite(sample.roll)) roll.push_back(sample.roll);
    }
  if (pitch.empty() || roll.empty()) return "slope not measured";
  return "pitch " + range(pitch, "rad") + ", roll " + range(roll, "rad");
}

}  // namespace

double largestCommand(const Drive& drive) {
  double largest = 0.0;
  for (const Segment& segment : drive.segments)
    for (const CommandSample& sample : segment.commands)
      largest = std::max(largest, driveOf(drive.layout, sample.command));
  return largest;
}

double drivenBetween(VehicleLayout layout, const std::vector<CommandSample>& commands, double end,
                     double from, double to, double least) {
  double sum = 0.0;
  for (size_t i = 0; i < commands.size(); ++i) {
    const double begin = std::max(from, commands[i].time);
    const double until = std::min(to, i + 1 < commands.size() ? commands[i + 1].time : end);
    if (until > begin && driveOf(layout, commands[i].command) >= least) sum += until - begin;
  }
  return sum;
}

size_t differentCommands(const Drive& drive) {
  const double largest = largestCommand(drive);
  std::vector<std::array<long, Command::kMaxChannels>> all;
  if (!(largest > 0.0)) return 1;
  for (const Segment& segment : drive.segments)
    for (const CommandSample& sample : segment.commands) {
      std::array<long, Command::kMaxChannels>& rounded = all.emplace_back();
      for (size_t channel = 0; channel < rounded.size(); ++channel)
        rounded[channel] = std::lround(100.0 * sample.command[channel] / largest);
    }
  std::sort(all.begin(), all.end());
  return static_cast<size_t>(std::unique(all.begin(), all.end()) - all.begin());
}

void checkPoses(const Drive& drive, const std::vector<PoseIncrement>& increments,
                Diagnostics& notes) {
  PoseSteps steps = poseSteps(drive);
  if (steps.durations.empty()) return;
  const auto count = static_cast<double>(steps.durations.size());
  const double longest = *std::max_element(steps.durations.begin(), steps.durations.end());
  notes.add(findings::kPoseRate,
            {digits(quantileOf(steps.durations, 0.5), 2), digits(longest, 2),
             digits(100.0 * (1.0 - (count + 1.0) / static_cast<double>(steps.readings)), 0)});
  if (steps.jumps > 0) {
    const bool too_many =
        steps.jumps >= 10 && static_cast<double>(steps.jumps) > kTooManyJumps * count;
    notes.add(too_many ? findings::kTooManyJumps : findings::kJumps,
              {std::to_string(steps.jumps), digits(fastestOf(drive.layout), 0),
               digits(steps.first_jump), digits(steps.fastest_jump)});
  }
  if (drive.layout != VehicleLayout::kOmni) checkCourse(increments, notes);
}

void describeStandstill(const Drive& drive, Diagnostics& notes) {
  Spread gyro, x, y, yaw;
  double seconds = 0.0;
  for (const Segment& segment : drive.segments)
    for (const auto& [from, to] : standstills(drive.layout, segment)) {
      seconds += to - from;
      for (const InsSample& sample : segment.ins) {
        if (sample.time < from || sample.time >= to) continue;
        if (std::isfinite(sample.omega)) gyro.add(sample.omega);
        if (!sample.hasPose()) continue;
        x.add(sample.T_map_body.x);
        y.add(sample.T_map_body.y);
        yaw.add(sample.T_map_body.yaw);
      }
      for (Spread* spread : {&gyro, &x, &y, &yaw}) spread->endStandstill();
    }
  if (seconds < 2.0) return notes.add(findings::kNeverStands);
  std::string rates, poses;
  if (gyro.known())
    rates = " gyro " + digits(gyro.mean(), 4) + " +- " + digits(gyro.deviation(), 4) + " rad/s";
  if (x.known())
    poses = (gyro.known() ? ", position +- " : " position +- ") +
            digits(std::hypot(x.deviation(), y.deviation()), 3) + " m, heading +- " +
            digits(yaw.deviation(), 4) + " rad";
  notes.add(findings::kStandstill, {digits(seconds, 0), rates, poses});
}

void describeDriving(const Drive& drive, const std::vector<PoseIncrement>& increments,
                     Diagnostics& notes) {
  std::vector<double> v = ratesOf(increments, &PoseIncrement::v);
  std::vector<double> omega = ratesOf(increments, &PoseIncrement::omega);
  std::vector<double> v_omega;
  for (size_t i = 0; i < v.size(); ++i) v_omega.push_back(v[i] * omega[i]);
  notes.add(findings::kDriven, {digits(drive.driven(), 0), std::to_string(drive.segments.size()),
                                range(v, "m/s"), range(omega, "rad/s"), range(v_omega, "m/s2"),
                                std::to_string(differentCommands(drive)),
                                std::to_string(reversals(drive)), slopes(drive)});
}

}  // namespace tread::gap
