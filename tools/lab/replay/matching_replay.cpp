// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/matching_replay.hpp"

#include <ctime>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include <Eigen/LU>

#include "common/messages/ins_messages.hpp"
#include "common/report/plot.hpp"
#include "common/statistics/statistics.hpp"

namespace tread {
namespace {

using scan_matching::MatchedPose;

constexpr double kMetre = 1.0;              // [m]
constexpr int64_t kTwoSeconds = 2'000'000;  // [us]
constexpr int64_t kMaxGap = 300'000;        // [us] between true poses
constexpr int64_t kDelayed = 150'000;       // [us] of delay above the usual one
constexpr int64_t kAround = 500'000;        // [us] around a delay in which true poses are not used
constexpr double kMostSlip = 0.3;           // [m] sideways between two scans

/// A measured pose and the true one.
struct Compared {
  const MatchedPose* measured;
  Pose2 T_map_true;
  double way = 0.0;  ///< [m] of the true path so far
};

/// Whether the true body moved sideways as no wheeled or tracked vehicle does: an error of the
/// reference. On an arc the chord's direction is half of the turn.
bool slips(const Compared& last, const MatchedPose& next, const Pose2& T_map_true) {
  if (next.utime - last.measured->utime > kTwoSeconds) return false;
  const Pose2 step = between(last.T_map_true, T_map_true);
  const double half = wrapAngle(step.yaw) / 2.0;
  return std::abs(step.y * std::cos(half) - step.x * std::sin(half)) > kMostSlip;
}

/// A stretch without a new track.
using Stretch = std::vector<Compared>;

/// Covariance of the pose of `b` relative to `a`, in a's axes: the drift between them, and both
/// poses' own.
Eigen::Matrix3d relativeCovariance(const MatchedPose& a, const MatchedPose& b) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J(0, 2) = -(b.T_map_body.y - a.T_map_body.y);
  J(1, 2) = b.T_map_body.x - a.T_map_body.x;
  const Eigen::Matrix3d drift =
      (b.covariance - b.local) - J * (a.covariance - a.local) * J.transpose();
  const Eigen::Matrix3d in_map = drift + J * a.local * J.transpose() + b.local;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() << std::cos(a.T_map_body.yaw), std::sin(a.T_map_body.yaw),
      -std::sin(a.T_map_body.yaw), std::cos(a.T_map_body.yaw);
  return R * in_map * R.transpose();
}

/// Running sums over pairs.
class Sums {
 public:
  void add(const Compared& a, const Compared& b) {
    const Pose2 measured = between(a.measured->T_map_body, b.measured->T_map_body);
    const Pose2 truth = between(a.T_map_true, b.T_map_true);
    const Eigen::Vector3d error(measured.x - truth.x, measured.y - truth.y,
                                wrapAngle(measured.yaw - truth.yaw));
    const Eigen::Matrix3d covariance = relativeCovariance(*a.measured, *b.measured);
    errors_.position.push_back(error.head<2>().norm());
    errors_.yaw.push_back(std::abs(error.z()));
    for (int axis = 0; axis < 3; ++axis) {
      const double square = error[axis] * error[axis] / std::max(1e-12, covariance(axis, axis));
      (axis < 2 ? position_ : yaw_) += square;
      within_ += square <= 4.0 ? 1.0 : 0.0;
    }
  }
  MotionErrors result() const {
    MotionErrors out = errors_;
    const double count = std::max(1.0, static_cast<double>(errors_.yaw.size()));
    out.normalized_position = std::sqrt(position_ / (2.0 * count));
    out.normalized_yaw = std::sqrt(yaw_ / count);
    out.within_two = within_ / (3.0 * count);
    return out;
  }

 private:
  MotionErrors errors_;
  double position_ = 0.0;
  double yaw_ = 0.0;
  double within_ = 0.0;
};

template <class FarEnough>
void addPairs(const Stretch& stretch, const FarEnough& far_enough, Sums& sums) {
  size_t b = 0;
  for (size_t a = 0; a < stretch.size(); ++a) {
    while (b < stretch.size() && !far_enough(stretch[a], stretch[b])) ++b;
    if (b == stretch.size()) return;
    sums.add(stretch[a], stretch[b]);
  }
}

void say(std::ostream& out, const char* name, const MotionErrors& errors) {
  out << "  " << name << ", " << errors.yaw.size() << " pairs: median "
      << lowerQuantile(errors.position, 0.5, 0.0) << " m " << lowerQuantile(errors.yaw, 0.5, 0.0)
      << " rad, rms " << rmsOf(errors.position, 0.0) << " m " << rmsOf(errors.yaw, 0.0)
      << " rad, 95 % " << lowerQuantile(errors.position, 0.95, 0.0) << " m "
      << lowerQuantile(errors.yaw, 0.95, 0.0) << " rad; over told deviation "
      << std::setprecision(2) << errors.normalized_position << " " << errors.normalized_yaw
      << ", within two " << 100.0 * errors.within_two << " %\n"
      << std::setprecision(4);
}

void endOf(const Stretch& stretch, TrackComparison& comparison) {
  const Compared& first = stretch.front();
  const Compared& last = stretch.back();
  const Pose2 measured = between(first.measured->T_map_body, last.measured->T_map_body);
  const Pose2 truth = between(first.T_map_true, last.T_map_true);
  comparison.end_position = distanceBetween(measured, truth);
  comparison.end_yaw = std::abs(wrapAngle(measured.yaw - truth.yaw));
  comparison.end_way = last.way;
  const Eigen::Matrix3d covariance = relativeCovariance(*first.measured, *last.measured);
  comparison.end_position_std = std::sqrt(covariance(0, 0) + covariance(1, 1));
  comparison.end_yaw_std = std::sqrt(covariance(2, 2));
}

/// Times at which messages arrived late over the recorder's network [us], by the range finder's
/// clock. True poses came over the same network, so their times are not reliable then.
std::vector<int64_t> delaysOf(const MappingRecording& recording) {
  std::vector<int64_t> delayed;
  int64_t least = INT64_MAX;
  const auto delay = [&](size_t i) {
    return recording.scans[i].utime + recording.scans[i].duration - recording.device_times[i];
  };
  for (size_t i = 0; i < recording.device_times.size(); ++i) least = std::min(least, delay(i));
  for (size_t i = 0; i < recording.device_times.size(); ++i)
    if (delay(i) > least + kDelayed) delayed.push_back(recording.scans[i].utime);
  return delayed;
}

/// CPU time of this thread [ms].
double cpuNow() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

const char* nameOf(scan_matching::MatchOutcome outcome) {
  constexpr const char* kNames[] = {"map begun",      "matched",      "undetermined",
                                    "too few points", "does not fit", "not newer"};
  return kNames[static_cast<size_t>(outcome)];
}

}  // namespace

TrackComparison compareTracks(const std::vector<MatchedPose>& poses,
                              const std::function<std::optional<Pose2>(int64_t)>& truth) {
  TrackComparison comparison;
  std::vector<Stretch> stretches(1);
  for (const MatchedPose& pose : poses) {
    if (!pose.position_known || !pose.heading_known) {
      ++comparison.unknown;
      continue;
    }
    const auto T_map_true = truth(pose.utime);
    if (!T_map_true) continue;
    const bool sideways =
        !stretches.back().empty() && slips(stretches.back().back(), pose, *T_map_true);
    if (sideways) ++comparison.sideways;
    if ((pose.new_track || sideways) && !stretches.back().empty()) stretches.emplace_back();
    Stretch& stretch = stretches.back();
    const double step =
        stretch.empty() ? 0.0 : distanceBetween(stretch.back().T_map_true, *T_map_true);
    stretch.push_back({&pose, *T_map_true, stretch.empty() ? 0.0 : stretch.back().way + step});
    ++comparison.compared;
    comparison.way += step;
  }
  Sums per_metre, per_2s;
  for (const Stretch& stretch : stretches) {
    addPairs(
        stretch, [](const Compared& a, const Compared& b) { return b.way - a.way >= kMetre; },
        per_metre);
    addPairs(
        stretch,
        [](const Compared& a, const Compared& b) {
          return b.measured->utime - a.measured->utime >= kTwoSeconds;
        },
        per_2s);
  }
  comparison.per_metre = per_metre.result();
  comparison.per_2s = per_2s.result();
  if (!stretches.back().empty()) endOf(stretches.back(), comparison);
  return comparison;
}

std::string reportOf(const TrackComparison& comparison) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(4);
  say(out, "per metre", comparison.per_metre);
  say(out, "per 2 s", comparison.per_2s);
  out << std::setprecision(2) << "  " << comparison.compared << " poses compared, "
      << comparison.unknown << " unknown, " << comparison.sideways
      << " times the reference jumps sideways; after the last " << comparison.end_way << " m "
      << comparison.end_position << " m (told deviation " << comparison.end_position_std << ") and "
      << std::setprecision(3) << comparison.end_yaw << " rad (" << comparison.end_yaw_std
      << ") off\n";
  return out.str();
}

MatchingReplay replayMatching(const MappingRecording& recording,
                              scan_matching::ScanMatchingConfig config) {
  MatchingReplay replay;
  replay.name = recording.name;
  replay.problem = recording.problem;
  PoseTrack truth(INT64_MAX);
  for (const ins_t& message : recording.poses)
    if (const auto pose = planarPose(message)) truth.push(message.utime, *pose);
  replay.truth.assign(truth.poses().begin(), truth.poses().end());
  if (!replay.truth.empty()) config.matcher.start = replay.truth.front().T_map_body;
  scan_matching::ScanMatcher matcher(config.matcher);
  double cpu = 0.0;
  std::vector<MatchedSweep> sweeps;
  for (size_t i = 0; i < recording.scans.size(); ++i) {
    std::string refusal;
    const auto scan = readScan(recording.scans[i], refusal);
    auto sweep = scan ? sweepOf(*scan, config, refusal) : std::nullopt;
    if (!sweep) {
      ++replay.outcomes["refused: " + refusal];
      continue;
    }
    // The motion has the device's clock, the true pose the recorder's.
    if (!recording.device_times.empty()) {
      const int64_t ahead = recording.device_times[i] - sweep->last;
      sweep->first += ahead;
      sweep->last += ahead;
    }
    const double begin = cpuNow();
    sweeps.push_back({*sweep, matcher.take(*sweep)});
    replay.poses.push_back(sweeps.back().pose);
    replay.poses.back().utime = scan->last;
    const double took = cpuNow() - begin;
    cpu += took;
    replay.cpu_max_ms = std::max(replay.cpu_max_ms, took);
    ++replay.outcomes[nameOf(replay.poses.back().outcome)];
  }
  replay.cpu_mean_ms = cpu / std::max(1.0, static_cast<double>(replay.poses.size()));
  replay.closure = closureOf(sweeps, config.matcher);
  const std::vector<int64_t> delayed = delaysOf(recording);
  replay.comparison = compareTracks(replay.poses, [&](int64_t utime) -> std::optional<Pose2> {
    for (const int64_t late : delayed)
      if (std::abs(late - utime) <= kAround) return std::nullopt;
    return truth.at(utime, kMaxGap);
  });
  return replay;
}

std::string reportOf(const MatchingReplay& replay) {
  std::ostringstream out;
  out << replay.name << ": " << replay.poses.size() << " scans";
  for (const auto& [outcome, count] : replay.outcomes) out << ", " << count << " " << outcome;
  out << std::fixed << std::setprecision(2) << "; " << replay.cpu_mean_ms
      << " ms of CPU a scan, at most " << replay.cpu_max_ms << '\n';
  if (!replay.problem.empty()) out << "  " << replay.problem << '\n';
  out << reportOf(replay.comparison) << std::setprecision(4)
      << "  three consecutive scans, each pair matched separately: " << replay.closure.yaw.size()
      << " triangles, open by a median of " << lowerQuantile(replay.closure.position, 0.5, 0.0)
      << " m " << lowerQuantile(replay.closure.yaw, 0.5, 0.0) << " rad, 95 % "
      << lowerQuantile(replay.closure.position, 0.95, 0.0) << " m "
      << lowerQuantile(replay.closure.yaw, 0.95, 0.0) << " rad; over told deviation "
      << std::setprecision(2) << replay.closure.normalized_position << " "
      << replay.closure.normalized_yaw << ", within two " << 100.0 * replay.closure.within_two
      << " %\n";
  return out.str();
}

void drawTracks(const MatchingReplay& replay, const std::string& path) {
  report::Picture canvas(1200, 1000, replay.name + " through scan matching");
  std::vector<Eigen::Vector2d> measured;
  std::vector<Eigen::Vector2d> truth;
  Eigen::AlignedBox2d box;
  for (const MatchedPose& pose : replay.poses) measured.push_back(pose.T_map_body.position());
  for (const TimedPose& pose : replay.truth) truth.push_back(pose.T_map_body.position());
  for (const auto* way : {&measured, &truth})
    for (const Eigen::Vector2d& p : *way) box.extend(p);
  report::Panel::Axes axes;
  axes.x_label = "x [m]";
  axes.y_label = "y [m]";
  axes.x_min = box.isEmpty() ? 0.0 : box.min().x() - 1.0;
  axes.x_max = box.isEmpty() ? 1.0 : box.max().x() + 1.0;
  axes.y_min = box.isEmpty() ? 0.0 : box.min().y() - 1.0;
  axes.y_max = box.isEmpty() ? 1.0 : box.max().y() + 1.0;
  axes.equal = true;
  report::Panel panel(canvas, {80, 60, 1080, 860}, axes);
  report::Style style;
  style.colour = report::kGrey;
  style.label = "poses of the recording";
  panel.line(truth, style);
  style.colour = report::kOrange;
  style.label = "scan matching";
  panel.line(measured, style);
  panel.finish();
  canvas.save(path);
}

}  // namespace tread
