// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/execution/measurement.hpp"

#include <algorithm>
#include <cmath>

#include "common/words/words.hpp"

namespace tread {
namespace {

/// Speeds are evaluated over this time: shorter steps are mostly INS noise.
constexpr int64_t kSpeedSpanUs = 100'000;
/// Least predicted motion for "did not move" to be meaningful [m, rad].
constexpr double kExpectedMotion = 0.10;
/// A PoseTrack checks gaps itself; here they are checked for the whole execution.
constexpr int64_t kAnyGap = std::numeric_limits<int64_t>::max();

double seconds(int64_t us) {
  return static_cast<double>(us) * 1e-6;
}

std::vector<Pose2> firstOf(const std::vector<Pose2>& poses, size_t count) {
  return {poses.begin(),
          poses.begin() + static_cast<std::ptrdiff_t>(std::min(count, poses.size()))};
}

/// Fills a measurement step by step; the first closed gate is kept.
class Cutter {
 public:
  Cutter(const TrackHistory& history, const ExecutionCut& cut, const MotionPattern& pattern,
         int64_t period_us, const MeasurementLimits& limits)
      : history_(history), cut_(cut), pattern_(pattern), period_us_(period_us), limits_(limits) {}

  Measurement run(const MotionClass& entry_class) {
    checkRecord();
    if (!result_.fair()) return result_;
    track_ = history_.covering(cut_.started);
    if (track_ == nullptr) {
      close(Gate::kNoTrack, "the INS has no pose at the start of the execution");
      return result_;
    }
    cutTrajectory();
    measureEntryAndSlope();
    checkCover();
    checkMotion();
    checkEntry(entry_class);
    if (result_.context.tilt.inclination > limits_.max_slope)
      close(Gate::kSlope, "slope " + fixed(result_.context.tilt.inclination, 3) + " rad, allowed " +
                              fixed(limits_.max_slope, 3));
    return result_;
  }

 private:
  void close(Gate gate, const std::string& reason) {
    if (!result_.fair()) return;
    result_.gate = gate;
    result_.reason = reason;
  }

  int64_t duration() const { return static_cast<int64_t>(pattern_.trajectory.size()) * period_us_; }

  void checkRecord() {
    if (!cut_.completed() && !cut_.beginning)
      close(Gate::kAborted, "aborted: " + cut_.reason.words);
    if (cut_.beginning && cut_.ended - cut_.started < limits_.shortest_us)
      close(Gate::kAborted, "only " + fixed(seconds(cut_.ended - cut_.started), 2) +
                                " s of it were driven, needed " +
                                fixed(seconds(limits_.shortest_us), 2));
    if (!cut_.unexpected_command.empty()) close(Gate::kCommands, cut_.unexpected_command);
    const int64_t took = cut_.ended - cut_.started;
    const double longest = seconds(duration()) / limits_.min_covered;
    if (took <= 0 || seconds(took) > longest)
      close(Gate::kRecord, "its record has a duration of " + fixed(seconds(took), 3) +
                               " s; the pattern takes " + fixed(seconds(duration()), 3) + " s");
  }

  /// M at started + (t + 1) periods, as far as record and track reach.
  void cutTrajectory() {
    const Pose2 T_map_start = *track_->at(cut_.started, kAnyGap);
    const std::vector<Pose2>& predicted = pattern_.trajectory;
    for (size_t t = 0; t < predicted.size(); ++t) {
      const int64_t when = sampleTime(t);
      // Half a period of tolerance: the record's end is the end of the last command's period.
      const auto pose =
          when <= cut_.ended + period_us_ / 2 ? track_->at(when, kAnyGap) : std::optional<Pose2>();
      if (!pose) break;
      result_.trajectory.push_back(between(T_map_start, *pose));
    }
    result_.covered = result_.trajectory.size();
    if (result_.covered > 0) result_.path_length = lengthOfPath(result_.trajectory);
    continueAsPredicted();
  }

  size_t samplesOf(int64_t us) const { return static_cast<size_t>(us / period_us_); }

  int64_t sampleTime(size_t t) const {
    return cut_.started + static_cast<int64_t>(t + 1) * period_us_;
  }

  /// Where the INS has no data, the predicted motion is kept, so that nothing is learned there.
  void continueAsPredicted() {
    const std::vector<Pose2>& predicted = pattern_.trajectory;
    if (result_.covered == 0) return;
    const Pose2 measured = result_.trajectory.back();
    const Pose2& left_at = predicted[result_.covered - 1];
    for (size_t t = result_.covered; t < predicted.size(); ++t)
      result_.trajectory.push_back(measured * between(left_at, predicted[t]));
  }

  void measureEntryAndSlope() {
    const auto twist =
        track_->twistBefore(cut_.started, limits_.entry_window_us, limits_.max_gap_us);
    if (twist) result_.context.entry = *twist;
    result_.context.tilt = history_.meanTilt(cut_.started, cut_.ended);
  }

  void checkCover() {
    const double share =
        static_cast<double>(result_.covered) / static_cast<double>(pattern_.trajectory.size());
    if (result_.covered > 0) {
      const auto gap = track_->longestGap(cut_.started, sampleTime(result_.covered - 1));
      if (gap && *gap > limits_.max_gap_us)
        close(Gate::kInsGap, "INS silent for " + fixed(seconds(*gap), 3) + " s, allowed " +
                                 fixed(seconds(limits_.max_gap_us), 3) + " s");
    }
    const bool enough = cut_.beginning ? result_.covered >= samplesOf(limits_.shortest_us)
                                       : share >= limits_.min_covered;
    if (!enough)
      close(Gate::kCoveredTime,
            "the INS covers " + fixed(100.0 * share, 0) + " % of the execution, needed " +
                (cut_.beginning ? fixed(seconds(limits_.shortest_us), 2) + " s"
                                : fixed(100.0 * limits_.min_covered, 0) + " %"));
  }

  void checkMotion() {
    for (const Pose2& pose : result_.trajectory)
      if (!std::isfinite(pose.x) || !std::isfinite(pose.y) || !std::isfinite(pose.yaw))
        close(Gate::kNotFinite, "lost poses in the measured trajectory");
    const double fastest = fastestSpeed();
    const double allowed = limits_.speed_margin * limits_.max_speed;
    if (fastest > allowed)
      close(Gate::kSpeed,
            "measured " + fixed(fastest, 2) + " m/s, possible " + fixed(allowed, 2) + " m/s");
    // After a beginning's end the motion is only predicted.
    const size_t known = cut_.beginning ? result_.covered : pattern_.trajectory.size();
    const Eigen::Array3d moved = boundingBox(firstOf(result_.trajectory, known));
    const Eigen::Array3d expected = boundingBox(firstOf(pattern_.trajectory, known));
    const bool should_move = (expected >= kExpectedMotion).any();
    const bool stood = moved[0] < limits_.min_motion && moved[1] < limits_.min_motion &&
                       moved[2] < limits_.min_turn;
    if (should_move && stood)
      close(Gate::kNoMotion, "the robot did not move; " +
                                 fixed(std::max(expected[0], expected[1]), 2) + " m and " +
                                 fixed(expected[2], 2) + " rad were predicted");
  }

  double fastestSpeed() const {
    const auto stride = static_cast<size_t>((kSpeedSpanUs + period_us_ - 1) / period_us_);
    double fastest = 0.0;
    for (size_t t = stride - 1; t < result_.covered; ++t) {
      const Pose2 before = t >= stride ? result_.trajectory[t - stride] : Pose2{};
      const double span = static_cast<double>(stride) * seconds(period_us_);
      fastest = std::max(fastest, distanceBetween(before, result_.trajectory[t]) / span);
    }
    return fastest;
  }

  void checkEntry(const MotionClass& entry_class) {
    const bool any = std::isinf(limits_.entry_speed) && std::isinf(limits_.entry_yaw_rate);
    // The ground's response to the right command is what should be learned.
    if (any || cut_.steady_before) return;
    if (!std::isfinite(result_.context.entry.v_x)) {
      close(Gate::kEntryTwist, "the twist before the start was not measured");
      return;
    }
    const Twist2& entry = result_.context.entry;
    const double speed = std::max(std::abs(entry.v_x - entry_class.twist.v_x),
                                  std::abs(entry.v_y - entry_class.twist.v_y));
    const double turn = std::abs(entry.omega - entry_class.twist.omega);
    if (speed > limits_.entry_speed || turn > limits_.entry_yaw_rate)
      close(Gate::kEntryTwist, "entered " + fixed(speed, 2) + " m/s and " + fixed(turn, 2) +
                                   " rad/s off its entry class " + entry_class.name);
  }

  const TrackHistory& history_;
  const ExecutionCut& cut_;
  const MotionPattern& pattern_;
  const int64_t period_us_;
  const MeasurementLimits& limits_;
  const PoseTrack* track_ = nullptr;
  Measurement result_;
};

}  // namespace

const char* gateName(Gate gate) {
  constexpr const char* kNames[] = {"none",
                                    "aborted",
                                    "unknown pattern",
                                    "invalid record",
                                    "other commands",
                                    "no INS at its start",
                                    "INS gap",
                                    "covered time",
                                    "lost poses",
                                    "impossible speed",
                                    "no motion",
                                    "entry twist",
                                    "slope"};
  return kNames[static_cast<size_t>(gate)];
}

Measurement measure(const TrackHistory& history, const ExecutionCut& cut,
                    const MotionPattern& pattern, const MotionClass& entry_class, int64_t period_us,
                    const MeasurementLimits& limits) {
  return Cutter(history, cut, pattern, period_us, limits).run(entry_class);
}

namespace {

/// Mean speed that a command asks of tracks or wheels [m/s]; 0 if it asks for none. For a holonomic
/// base the fastest wheel, because its wheels turn against each other in any motion.
double commandedSpeed(const Command& command, const CommandChannels& channels) {
  double sum = 0.0, count = 0.0, fastest = 0.0;
  for (size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].kind != CommandKind::kTrackSpeed) continue;
    sum += command[i];
    count += 1.0;
    fastest = std::max(fastest, std::abs(command[i]));
  }
  if (count > 2.0) return fastest;
  return count > 0.0 ? std::abs(sum) / count : 0.0;
}

}  // namespace

double largestSpeed(const PatternSet& set) {
  double largest = 0.0;
  for (const MotionClass& motion : set.content().classes)
    largest = std::max(largest, std::hypot(motion.twist.v_x, motion.twist.v_y));
  for (const MotionPattern& pattern : set.patterns()) {
    Pose2 last;
    for (const Pose2& pose : pattern.trajectory) {
      largest = std::max(largest, distanceBetween(last, pose) / set.periodSeconds());
      last = pose;
    }
    for (const Command& command : pattern.commands)
      largest = std::max(largest, commandedSpeed(command, set.content().channels));
  }
  return largest;
}

Eigen::Array3d boundingBox(const std::vector<Pose2>& trajectory) {
  // The start pose (0, 0, 0) is part of the box: a reversing pattern is as long as a forward one.
  Eigen::Array3d low = Eigen::Array3d::Zero();
  Eigen::Array3d high = Eigen::Array3d::Zero();
  for (const Pose2& pose : trajectory) {
    const Eigen::Array3d at(pose.x, pose.y, pose.yaw);
    low = low.min(at);
    high = high.max(at);
  }
  return high - low;
}

}  // namespace tread
