// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Measurements that change their meaning on the way: frozen, of another sign, turned.
#include "common/soundness/core/log_validation_midway.hpp"

#include <algorithm>
#include <cmath>

#include "common/soundness/core/command_check.hpp"
#include "common/soundness/core/log_validation_motion.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::gap {
namespace {

constexpr double kWindow = 15.0;       // [s] of increments that are evaluated together
constexpr double kWindowClear = 0.5;   // |correlation| with which a window has a sign
constexpr double kLeastSpread = 0.05;  // [rad/s] or [m/s] RMS of the following rate: less is noise
constexpr double kAlike = 3.0;         // largest ratio to the usual slope, or its inverse
constexpr double kFrozen = 2.0;        // [s] of the same numbers
constexpr size_t kFrozenRows = 10;     // messages of the same numbers
constexpr double kTenth = 0.1;         // of the largest command, RMS: less means no command
constexpr double kDriving = 0.2;       // of the largest command: enough to move the robot
constexpr double kAlong = 0.8;   // share of the course along the heading, squared, that is valid
constexpr double kAcross = 0.4;  // and one that is not

/// Increments [first, last) and their times.
struct Window {
  size_t first = 0, last = 0;
  double begin = 0.0, end = 0.0;  ///< [s]
};

std::vector<Window> windowsOf(const std::vector<PoseIncrement>& increments) {
  std::vector<Window> windows;
  for (size_t first = 0; first < increments.size();) {
    Window window{first, first, increments[first].begin, 0.0};
    double sum = 0.0;
    while (window.last < increments.size() && sum < kWindow)
      sum += increments[window.last++].duration();
    window.end = increments[window.last - 1].end;
    if (sum >= 0.5 * kWindow) windows.push_back(window);
    first = window.last;
  }
  return windows;
}

/// The longest run of windows that differ from the majority, with undecided ones in between;
/// nullopt if too few are decided. `signs`: +1, -1, 0 = undecided; `sure`: one window alone is
/// enough.
std::optional<std::pair<size_t, size_t>> minority(const std::vector<int>& signs,
                                                  const std::vector<bool>& sure) {
  const auto plus = std::count(signs.begin(), signs.end(), 1);
  const auto minus = std::count(signs.begin(), signs.end(), -1);
  if (std::max(plus, minus) < 2) return std::nullopt;
  const int other = plus < minus ? 1 : -1;
  std::optional<std::pair<size_t, size_t>> longest;
  size_t most = 0, count = 0, first = 0, last = 0;
  bool any_sure = false;
  const auto end_run = [&] {
    if (count > most && (count >= 2 || any_sure)) {
      longest = std::pair(first, last);
      most = count;
    }
    count = 0;
    any_sure = false;
  };
  for (size_t i = 0; i < signs.size(); ++i) {
    if (signs[i] == -other) end_run();
    if (signs[i] != other) continue;
    if (count++ == 0) first = i;
    last = i;
    any_sure = any_sure || sure[i];
  }
  end_run();
  return longest;
}

/// Two rates of which one follows the other, and the thresholds for a decided window.
struct Followed {
  const LagTable& table;
  const std::vector<double>& lags;
  double least_leading = 0.0;  ///< RMS of the leading rate
  bool one_is_enough = false;  ///< for 15 s a person or controller may steer against the motion
  const char* what = "";       ///< the meaning of an opposite sign
};

/// The lag at which one rate follows the other best, with either sign; lags.size() = none.
size_t bestLag(const Followed& followed, const std::vector<Window>& windows) {
  size_t best = followed.lags.size();
  double most = 0.0;
  for (size_t lag = 0; lag < followed.lags.size(); ++lag) {
    double sum = 0.0;
    for (const Window& window : windows)
      if (const auto match = followed.table.match(lag, window.first, window.last))
        sum += std::abs(match->correlation);
    if (sum > most) best = lag;
    most = std::max(most, sum);
  }
  return best;
}

/// Checks for a rate that follows another one with opposite signs in different parts. A window is
/// decided if both rates vary enough and their ratio is about the usual one.
void checkSign(const Followed& followed, const std::vector<Window>& windows, Diagnostics& notes) {
  const size_t lag = bestLag(followed, windows);
  if (lag == followed.lags.size()) return;
  std::vector<std::optional<LagMatch>> matches;
  std::vector<double> slopes;
  for (const Window& window : windows) {
    matches.push_back(followed.table.match(lag, window.first, window.last));
    std::optional<LagMatch>& match = matches.back();
    if (match && (std::abs(match->correlation) < kWindowClear || match->spread < kLeastSpread ||
                  match->leading_spread < followed.least_leading))
      match.reset();
    if (match) slopes.push_back(std::abs(match->slope));
  }
  if (slopes.empty()) return;
  const double usual = quantileOf(slopes, 0.5);
  std::vector<int> signs;
  std::vector<bool> sure;
  for (const std::optional<LagMatch>& match : matches) {
    const double slope = match ? std::abs(match->slope) : 0.0;
    const bool speaks = slope > usual / kAlike && slope < usual * kAlike;
    signs.push_back(!speaks ? 0 : match->correlation > 0.0 ? 1 : -1);
    sure.push_back(speaks && followed.one_is_enough && std::abs(match->correlation) > kVeryClear);
  }
  if (const auto found = minority(signs, sure))
    notes.add(findings::kFlipsMidway, {digits(windows[found->first].begin),
                                       digits(windows[found->second].end), followed.what});
}

/// Checks for position and heading that agree in one part and not in another.
void checkCourses(const std::vector<PoseIncrement>& increments, const std::vector<Window>& windows,
                  Diagnostics& notes) {
  std::vector<int> signs;
  std::vector<bool> sure;
  for (const Window& window : windows) {
    double along = 0.0, all = 0.0;
    size_t rows = 0;
    for (size_t i = window.first; i < window.last; ++i) {
      const Pose2& step = increments[i].T_begin_end;
      const double way = step.x * step.x + step.y * step.y;
      if (std::abs(step.yaw) > kGentle || way < 0.01) continue;
      // A turn on the spot moves a point that is not at its centre.
      if (way < std::pow(kLever * step.yaw, 2)) continue;
      // Relative to the heading in the middle of the turn.
      along += way * std::pow(std::cos(std::atan2(step.y, step.x) - 0.5 * step.yaw), 2);
      all += way;
      ++rows;
    }
    const bool speaks = rows >= 8;
    signs.push_back(!speaks ? 0 : along > kAlong * all ? 1 : along < kAcross * all ? -1 : 0);
    sure.push_back(false);
  }
  const auto found = minority(signs, sure);
  if (found &&
      std::count(signs.begin(), signs.end(), -1) < std::count(signs.begin(), signs.end(), 1))
    notes.add(findings::kTurnsMidway,
              {digits(windows[found->first].begin), digits(windows[found->second].end)});
}

bool isSame(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

/// A run of identical messages.
struct Frozen {
  const InsSample* first = nullptr;
  const InsSample* last = nullptr;
  const InsSample* pose = nullptr;  ///< the first with a pose: poses are less frequent than rates
  size_t rows = 0;

  bool goesOn(const InsSample& sample) const {
    if (first == nullptr || sample.omega != first->omega || !isSame(sample.roll, first->roll) ||
        !isSame(sample.pitch, first->pitch))
      return false;
    if (!sample.hasPose() || pose == nullptr) return true;
    const Pose2& a = sample.T_map_body;
    const Pose2& b = pose->T_map_body;
    return a.x == b.x && a.y == b.y && a.yaw == b.yaw;
  }
  void add(const InsSample& sample) {
    if (first == nullptr) first = &sample;
    if (pose == nullptr && sample.hasPose()) pose = &sample;
    last = &sample;
    ++rows;
  }
};

/// Checks for an INS that repeats itself while the robot is driven.
/** A gyro's noise is never constant, not even while the robot is held; a gyro that reads exactly 0
 * may have no noise. */
void checkFrozen(const Drive& drive, Diagnostics& notes) {
  for (const LogNote& note : drive.notes)
    if (note.is(findings::kInsFrozen)) return;  // the reader has found it
  const double least = kDriving * largestCommand(drive);
  if (!(least > 0.0)) return;  // it stood all the time
  for (const Segment& segment : drive.segments) {
    Frozen run;
    const auto told = [&] {
      if (run.rows < kFrozenRows || run.pose == nullptr ||
          drivenBetween(drive.layout, segment.commands, segment.end, run.first->time,
                        run.last->time, least) < kFrozen)
        return false;
      notes.add(findings::kInsRepeats,
                {std::to_string(run.rows), digits(run.first->time), digits(run.last->time)});
      return true;
    };
    for (const InsSample& sample : segment.ins) {
      if (!run.goesOn(sample)) {
        if (told()) return;
        run = {};
      }
      if (std::isfinite(sample.omega) && sample.omega != 0.0) run.add(sample);
    }
    if (told()) return;
  }
}

}  // namespace

void checkMidway(const Drive& drive, const std::vector<PoseIncrement>& increments,
                 Diagnostics& notes) {
  checkFrozen(drive, notes);
  const std::vector<Window> windows = windowsOf(increments);
  const std::vector<double> omega = ratesOf(increments, &PoseIncrement::omega);
  const std::vector<double> v = ratesOf(increments, &PoseIncrement::v);
  const double command = kTenth * largestCommand(drive);
  const auto check = [&](const std::vector<double>& rates, const RunningSums& sums, double reach,
                         double least_leading, bool one_is_enough, const char* what) {
    const std::vector<double> lags = lagGrid(-0.2, reach, 0.1);
    const LagTable table(increments, rates, sums, lags);
    checkSign({table, lags, least_leading, one_is_enough, what}, windows, notes);
  };
  check(omega, gyroSums(drive), 0.8, kLeastSpread, true, "the gyro turns against the heading");
  check(omega, turnCommandSums(drive), 1.5, command, false,
        "the heading turns against the commands");
  check(v, driveCommandSums(drive), 1.5, command, false, "the robot goes against the commands");
  if (drive.layout != VehicleLayout::kOmni) checkCourses(increments, windows, notes);
}

}  // namespace tread::gap
