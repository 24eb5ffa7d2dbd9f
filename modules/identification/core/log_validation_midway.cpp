// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Measurements that change their meaning on the way: frozen, of another sign, turned.
#include <algorithm>
#include <cmath>

#include "modules/identification/core/log_validation.hpp"

namespace tread::gap {
namespace {

constexpr double kWindow = 15.0;    // [s] of increments that are judged together
constexpr double kClear = 0.5;      // |correlation| with which a window has a sign
constexpr double kVeryClear = 0.8;  // with which it needs no second one
constexpr double kFrozen = 2.0;     // [s] of the same numbers
constexpr size_t kFrozenRows = 10;  // messages of the same numbers
constexpr double kDriving = 0.2;    // of the largest command: more than that moves the robot
constexpr double kAlong = 0.8;      // share of the way along the heading, squared, that is sound
constexpr double kAcross = 0.4;     // and one that is not
constexpr double kGentle = 0.8;     // [rad] of a turn whose way is nearly its chord

/// Increments [first, last) and when they were.
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

std::string times(const Window& from, const Window& to) {
  return "from " + digits(from.begin) + " to " + digits(to.end) + " s";
}

/// The windows that are not as most are: the first and the last of them; nothing where too few
/// speak. `signs`: +1, -1, 0 = does not say; `sure`: one alone is enough.
std::optional<std::pair<size_t, size_t>> minority(const std::vector<int>& signs,
                                                  const std::vector<bool>& sure) {
  const auto plus = std::count(signs.begin(), signs.end(), 1);
  const auto minus = std::count(signs.begin(), signs.end(), -1);
  const int other = plus < minus ? 1 : -1;
  size_t first = signs.size(), last = 0, count = 0;
  bool any_sure = false;
  for (size_t i = 0; i < signs.size(); ++i) {
    if (signs[i] != other) continue;
    first = std::min(first, i);
    last = i;
    any_sure = any_sure || sure[i];
    ++count;
  }
  if (std::max(plus, minus) < 2 || count == 0 || (count < 2 && !any_sure)) return std::nullopt;
  return std::pair(first, last);
}

/// A rate that follows another one with one sign here and the opposite sign there.
void checkSign(const LagTable& table, const std::vector<Window>& windows,
               const std::vector<double>& lags, const std::string& what, Diagnostics& notes) {
  size_t best = lags.size();
  double most = 0.0;
  for (size_t lag = 0; lag < lags.size(); ++lag) {
    double sum = 0.0;
    for (const Window& window : windows)
      if (const auto match = table.match(lag, window.first, window.last))
        sum += std::abs(match->correlation);
    if (sum > most) best = lag;
    most = std::max(most, sum);
  }
  if (best == lags.size()) return;
  std::vector<int> signs;
  std::vector<bool> sure;
  for (const Window& window : windows) {
    const auto match = table.match(best, window.first, window.last);
    const double correlation = match ? match->correlation : 0.0;
    signs.push_back(std::abs(correlation) < kClear ? 0 : correlation > 0.0 ? 1 : -1);
    sure.push_back(std::abs(correlation) > kVeryClear);
  }
  if (const auto found = minority(signs, sure))
    notes.fatal("flipped sign: " + times(windows[found->first], windows[found->second]) + " " +
                what + ", else it does not; cut the log there");
}

/// Position and heading that belong together here and not there.
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
      // Against the heading in the middle of the turn.
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
    notes.fatal(times(windows[found->first], windows[found->second]) +
                " the way does not go along the heading, else it does: heading or position have "
                "turned; cut the log there");
}

double largestCommand(const Drive& drive) {
  double largest = 0.0;
  for (const Segment& segment : drive.segments)
    for (const CommandSample& sample : segment.commands)
      largest = std::max({largest, std::abs(sample.command.left), std::abs(sample.command.right)});
  return largest;
}

/// How long between two times commands were given that move the robot [s].
double drivenBetween(const Segment& segment, double from, double to, double least) {
  double sum = 0.0;
  for (size_t i = 0; i < segment.commands.size(); ++i) {
    const TrackCommand& command = segment.commands[i].command;
    if (std::max(std::abs(command.left), std::abs(command.right)) <= least) continue;
    const double end = i + 1 < segment.commands.size() ? segment.commands[i + 1].time : segment.end;
    sum += std::max(0.0, std::min(to, end) - std::max(from, segment.commands[i].time));
  }
  return sum;
}

bool isSame(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

/// An INS that repeats itself while the robot is driven. A gyro's noise does not stand still, not
/// even where the robot is held.
void checkFrozen(const Drive& drive, Diagnostics& notes) {
  const double least = kDriving * largestCommand(drive);
  for (const Segment& segment : drive.segments) {
    const InsSample* from = nullptr;
    const InsSample* last = nullptr;
    size_t rows = 0;
    const auto judge = [&] {
      if (from == nullptr || rows < kFrozenRows || last->time - from->time < kFrozen) return false;
      if (drivenBetween(segment, from->time, last->time, least) < kFrozen) return false;
      notes.fatal("the INS is frozen: it says the same " + std::to_string(rows) + " times from " +
                  digits(from->time) + " to " + digits(last->time) +
                  " s while the robot is driven; cut the log there");
      return true;
    };
    for (const InsSample& sample : segment.ins) {
      const bool speaks = std::isfinite(sample.omega) && sample.omega != 0.0;
      // Poses come more seldom than rates.
      const bool same = speaks && from != nullptr && sample.omega == from->omega &&
                        (!sample.hasPose() || !from->hasPose() ||
                         (sample.T_map_body.x == from->T_map_body.x &&
                          sample.T_map_body.y == from->T_map_body.y &&
                          sample.T_map_body.yaw == from->T_map_body.yaw)) &&
                        isSame(sample.roll, from->roll) && isSame(sample.pitch, from->pitch);
      if (same) {
        ++rows;
        last = &sample;
        continue;
      }
      if (judge()) return;
      from = speaks ? &sample : nullptr;
      last = from;
      rows = 1;
    }
    if (judge()) return;
  }
}

}  // namespace

void checkMidway(const Drive& drive, const std::vector<PoseIncrement>& increments,
                 Diagnostics& notes) {
  checkFrozen(drive, notes);
  const std::vector<Window> windows = windowsOf(increments);
  const std::vector<double> omega = ratesOf(increments, &PoseIncrement::omega);
  const std::vector<double> v = ratesOf(increments, &PoseIncrement::v);
  const auto check = [&](const std::vector<double>& rates, const RunningSums& sums, double reach,
                         const char* what) {
    const std::vector<double> lags = lagGrid(-0.2, reach, 0.1);
    checkSign({increments, rates, sums, lags}, windows, lags, what, notes);
  };
  check(omega, gyroSums(drive), 0.8, "the gyro turns against the heading");
  check(omega, turnCommandSums(drive), 1.5, "the heading turns against the commands");
  check(v, driveCommandSums(drive), 1.5, "the robot goes against the commands");
  checkCourses(increments, windows, notes);
}

}  // namespace tread::gap
