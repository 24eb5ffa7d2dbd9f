// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/average.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Core>

#include "common/pattern/pattern.hpp"
#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::recordings {
namespace {

constexpr double kSpeedSpan = 0.1;     // [s]: shorter steps are mostly noise
constexpr double kMedianMargin = 1.5;  // [1] on the median's largest speed
constexpr double kLeastMaxSpeed =
    0.3;  // [m/s]: speeds of a set that only turns on the spot are noise

bool finite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
}

/// The largest speed of an execution over kSpeedSpan [m/s].
double fastest(const Execution& poses, double period) {
  const auto wanted = static_cast<size_t>(std::max(1.0, std::ceil(kSpeedSpan / period - 1e-9)));
  const size_t stride = std::min(wanted, poses.size());
  double speed = 0.0;
  for (size_t t = stride - 1; t < poses.size(); ++t) {
    const Pose2 before = t >= stride ? poses[t - stride] : Pose2{};
    const double way = std::hypot(poses[t].x - before.x, poses[t].y - before.y);
    speed = std::max(speed, way / (static_cast<double>(stride) * period));
  }
  return speed;
}

/// The largest yaw rate between two samples [rad/s]; a wrapped yaw shows here.
double fastestTurn(const Execution& poses, double period) {
  double rate = 0.0;
  double last = 0.0;
  for (const Pose2& pose : poses) {
    rate = std::max(rate, std::abs(pose.yaw - last) / period);
    last = pose.yaw;
  }
  return rate;
}

/// kMedianMargin times the largest speed of a pattern's median execution, over all patterns: spins
/// and starts alone have only noise.
double usualMaxSpeed(const PatternSet& set, const SurfaceRecordings& recordings) {
  double largest = 0.0;
  for (size_t p = 0; p < recordings.executions.size(); ++p) {
    std::vector<double> speeds;
    for (const Execution& poses : recordings.executions[p])
      if (isWhole(poses, set.patterns()[p].commands.size()))
        speeds.push_back(fastest(poses, set.periodSeconds()));
    largest = std::max(largest, upperMedian(std::move(speeds)));
  }
  return std::max(kLeastMaxSpeed, kMedianMargin * largest);
}

/// Why an execution is left out; empty if it is valid.
std::string fault(const Execution& poses, const MotionPattern& pattern, double period,
                  double max_speed) {
  if (poses.size() != pattern.commands.size())
    return std::to_string(poses.size()) + " poses, the pattern has " +
           std::to_string(pattern.commands.size()) + " commands";
  for (size_t t = 0; t < poses.size(); ++t)
    if (!finite(poses[t])) return "sample " + std::to_string(t + 1) + " is not finite";
  const double speed = fastest(poses, period);
  if (speed > max_speed)
    return "it moves at " + formatted("%.2f", speed) + " m/s, possible are " +
           formatted("%.2f", max_speed) + " m/s";
  const double rate = fastestTurn(poses, period);
  if (rate > PatternLimits::kMaxYawRate)
    return "its yaw jumps (" + formatted("%.1f", rate) + " rad/s); is it wrapped?";
  return "";
}

/// One pattern's fair executions.
using Fair = std::vector<const Execution*>;

Fair fairOnes(const std::vector<Execution>& executions, const MotionPattern& pattern, double period,
              double max_speed, AverageNote& note) {
  Fair fair;
  for (size_t e = 0; e < executions.size(); ++e) {
    const std::string why = fault(executions[e], pattern, period, max_speed);
    if (why.empty()) {
      fair.push_back(&executions[e]);
      continue;
    }
    note.rejected.push_back("execution " + std::to_string(e + 1) + ": " + why);
    note.left_out.push_back(e);
  }
  return fair;
}

std::vector<Pose2> meanOfPoses(const Fair& fair) {
  std::vector<Pose2> mean(fair.front()->size());
  const auto n = static_cast<double>(fair.size());
  for (const Execution* poses : fair)
    for (size_t t = 0; t < mean.size(); ++t) {
      mean[t].x += (*poses)[t].x / n;
      mean[t].y += (*poses)[t].y / n;
      mean[t].yaw += (*poses)[t].yaw / n;
    }
  return mean;
}

/// Mean body twist of each sample, integrated from the start.
std::vector<Pose2> meanOfTwists(const Fair& fair, double period) {
  std::vector<Twist2> twists(fair.front()->size());
  const auto n = static_cast<double>(fair.size());
  for (const Execution* poses : fair) {
    Pose2 last;
    for (size_t t = 0; t < twists.size(); ++t) {
      const Twist2 twist = twistTo(between(last, (*poses)[t]), period);
      twists[t].v_x += twist.v_x / n;
      twists[t].v_y += twist.v_y / n;
      twists[t].omega += twist.omega / n;
      last = (*poses)[t];
    }
  }
  std::vector<Pose2> driven;
  Pose2 pose;
  for (const Twist2& twist : twists) driven.push_back(pose = pose * integrate(twist, period));
  return driven;
}

double largestYaw(const std::vector<Pose2>& poses) {
  double largest = 0.0;
  for (const Pose2& pose : poses) largest = std::max(largest, std::abs(pose.yaw));
  return largest;
}

/// Spread of the end poses about their mean; unknown for a single one.
PoseCovariance endSpread(const Fair& fair, const Pose2& mean) {
  if (fair.size() < 2) return kUnknownCovariance;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Execution* poses : fair) {
    const Pose2& end = poses->back();
    const Eigen::Vector3d off(end.x - mean.x, end.y - mean.y, end.yaw - mean.yaw);
    sum += off * off.transpose();
  }
  const Eigen::Matrix3d c = sum / static_cast<double>(fair.size() - 1);
  return {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)};
}

RecordingError tooFew(const std::string& surface, const AverageNote& note,
                      const AverageLimits& limits) {
  const std::string first = note.rejected.empty() ? "" : " (" + note.rejected.front() + ")";
  return RecordingError("surface '" + surface + "': pattern '" + note.pattern + "' has " +
                        std::to_string(note.used) + " fair executions of " +
                        std::to_string(static_cast<size_t>(note.used) + note.rejected.size()) +
                        first + "; at least " + std::to_string(std::max(1, limits.min_executions)) +
                        " are needed, record more");
}

}  // namespace

PatternSet averageSet(const PatternSet& patterns, const SurfaceRecordings& recordings,
                      const AverageLimits& limits, std::vector<AverageNote>& notes) {
  notes.clear();
  PatternSetContent content = patterns.content();
  requireSamePatternCount(recordings, patterns);
  const double period = patterns.periodSeconds();
  const double max_speed =
      limits.max_speed > 0.0 ? limits.max_speed : usualMaxSpeed(patterns, recordings);
  for (size_t p = 0; p < content.patterns.size(); ++p) {
    MotionPattern& pattern = content.patterns[p];
    AverageNote note;
    note.pattern = pattern.name;
    const Fair fair = fairOnes(recordings.executions[p], pattern, period, max_speed, note);
    note.used = static_cast<int>(fair.size());
    if (note.used < std::max(1, limits.min_executions))
      throw tooFew(recordings.surface, note, limits);
    const std::vector<Pose2> mean = meanOfPoses(fair);
    note.by_twist = largestYaw(mean) >= limits.strong_turn;
    pattern.trajectory = note.by_twist ? meanOfTwists(fair, period) : mean;
    pattern.end_covariance = endSpread(fair, mean.back());
    pattern.times_learned = 0;
    notes.push_back(std::move(note));
  }
  std::string why;
  auto set = PatternSet::make(std::move(content), why);
  if (!set)
    throw RecordingError("surface '" + recordings.surface + "': the average is no set: " + why);
  return *set;
}

}  // namespace tread::recordings
