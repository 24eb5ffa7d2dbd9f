// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Commands and poses on two clocks: where motion does not follow its commands as a vehicle does, it
// is looked for over the whole log, speed and turn together, and found where one offset alone
// explains it.
#include "common/soundness/clock_offset.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/track.hpp"
#include "common/messages/ins_messages.hpp"

namespace tread::gap {
namespace {

constexpr double kStep = 0.2;             // [s] of the grid, more for long logs
constexpr double kMostCells = 8000.0;     // of a grid
constexpr double kShortestMotion = 0.3;   // [s] between two poses used for a rate
constexpr double kLongestMotion = 1.2;    // [s]
constexpr double kUsual[] = {-0.3, 2.0};  // [s] of lag between a vehicle and its commands
constexpr double kLeastOverlap = 20.0;    // [s]
constexpr double kLongOverlap = 60.0;     // [s] of overlap from which less correlation is enough
constexpr double kExplains = 0.4;         // mean correlation^2 of speed and turn
constexpr double kExplainsShort = 0.7;    // the same of less driving
constexpr double kBetter = 0.3;           // improvement required over no offset
constexpr double kAloneBetter = 0.15;     // improvement required over any other offset
constexpr double kApart = 3.0;  // [s] of difference between offsets that count as different

/// Speed and turn at equal steps; NaN where they are not known.
struct Grid {
  double begin = 0.0;  ///< [s]
  std::vector<double> speed, turn;

  Grid(double from, double to, double step) : begin(from) {
    const auto cells = static_cast<size_t>(std::max(0.0, (to - from) / step)) + 1;
    speed.assign(cells, kNotMeasured);
    turn.assign(cells, kNotMeasured);
  }
  void put(double time, double step, double v, double omega) {
    const double cell = (time - begin) / step;
    if (!(cell >= 0.0) || cell >= static_cast<double>(speed.size())) return;
    speed[static_cast<size_t>(cell)] = v;
    turn[static_cast<size_t>(cell)] = omega;
  }
};

/// The squared correlation of two rates, one of them shifted; 0 if it is negative.
double explained(const std::vector<double>& led, const std::vector<double>& leading, long shift,
                 size_t least) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  const long first = std::max(0L, -shift);
  const long last =
      std::min(static_cast<long>(led.size()), static_cast<long>(leading.size()) - shift);
  for (long i = first; i < last; ++i) {
    const double a = leading[static_cast<size_t>(i + shift)];
    const double b = led[static_cast<size_t>(i)];
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    n += 1.0;
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
  }
  if (n < static_cast<double>(least)) return 0.0;
  const double covariance = xy - x * y / n;
  const double spread = (xx - x * x / n) * (yy - y * y / n);
  return covariance > 0.0 && spread > 1e-18 ? covariance * covariance / spread : 0.0;
}

Grid commandGrid(const std::vector<HeardSpan>& spans, double step) {
  Grid grid(spans.front().commands.begin(), spans.back().commands.end, step);
  for (const HeardSpan& span : spans)
    for (double time = span.commands.begin(); time < span.commands.end; time += step) {
      const TrackCommand command = sidesOf(span.commands.layout, commandAt(span.commands, time));
      grid.put(time, step, 0.5 * (command.left + command.right), command.right - command.left);
    }
  return grid;
}

Grid motionGrid(const std::vector<PoseSample>& poses, double step) {
  Grid grid(poses.front().time, poses.back().time, step);
  for (size_t i = 0, before = 0; i < poses.size(); ++i) {
    while (poses[i].time - poses[before].time > kLongestMotion) ++before;
    size_t from = before;
    while (from + 1 < i && poses[i].time - poses[from + 1].time >= kShortestMotion) ++from;
    const double time = poses[i].time - poses[from].time;
    if (time < kShortestMotion) continue;
    const Pose2 moved = between(poses[from].T_map_body, poses[i].T_map_body);
    grid.put(0.5 * (poses[from].time + poses[i].time), step, moved.x / time,
             wrapAngle(moved.yaw) / time);
  }
  return grid;
}

size_t known(const Grid& grid) {
  return static_cast<size_t>(std::count_if(grid.speed.begin(), grid.speed.end(),
                                           [](double v) { return std::isfinite(v); }));
}

/// Offsets and what they explain.
struct Offsets {
  std::vector<std::pair<double, double>> all;  ///< [s] of the motion behind the commands; share

  std::pair<double, double> best(double from, double to) const {
    std::pair<double, double> found{0.0, 0.0};
    for (const auto& one : all)
      if (one.first >= from && one.first <= to && one.second > found.second) found = one;
    return found;
  }
};

Offsets offsets(const Grid& commands, const Grid& motion, double step, double from, double to) {
  const size_t least = std::max(static_cast<size_t>(kLeastOverlap / step),
                                std::min(known(commands), known(motion)) / 2);
  Offsets result;
  const auto cells = [&](double lag) {
    return static_cast<long>(std::floor((motion.begin - commands.begin - lag) / step));
  };
  const long first = std::max(cells(to), 1L - static_cast<long>(motion.speed.size()));
  const long last = std::min(cells(from), static_cast<long>(commands.speed.size()) - 1);
  for (long shift = first; shift <= last; ++shift)
    result.all.push_back({motion.begin - commands.begin - step * static_cast<double>(shift),
                          0.5 * (explained(motion.speed, commands.speed, shift, least) +
                                 explained(motion.turn, commands.turn, shift, least))});
  return result;
}

}  // namespace

void checkOffset(const SortedLog& log, const std::vector<HeardSpan>& spans, Diagnostics& notes) {
  std::vector<PoseSample> poses;
  for (const ins_t& ins : log.ins)
    if (const auto pose = planarPose(ins)) poses.push_back({log.seconds(ins.utime), *pose});
  if (spans.empty() || poses.size() < 2) return;
  const double longest = std::max(spans.back().commands.end - spans.front().commands.begin(),
                                  poses.back().time - poses.front().time);
  const double step = std::max(kStep, longest / kMostCells);
  const Grid commands = commandGrid(spans, step);
  const Grid motion = motionGrid(poses, step);
  const auto usual = offsets(commands, motion, step, kUsual[0], kUsual[1]).best(-1e300, 1e300);
  if (usual.second > kExplains) return;
  const Offsets all = offsets(commands, motion, step, -1e12, 1e12);
  const auto best = all.best(-1e300, 1e300);
  const double other = std::max(all.best(-1e300, best.first - kApart).second,
                                all.best(best.first + kApart, 1e300).second);
  const bool is_usual = best.first > kUsual[0] - step && best.first < kUsual[1] + step;
  const double driven = step * static_cast<double>(std::min(known(commands), known(motion)));
  const double enough = driven < 2.0 * kLongOverlap ? kExplainsShort : kExplains;
  if (is_usual || best.second < enough || best.second < usual.second + kBetter ||
      best.second < other + kAloneBetter)
    return;
  notes.add(findings::kTwoClocks,
            {digits(std::abs(best.first)), best.first > 0.0 ? "after" : "before",
             digits(std::sqrt(best.second), 2), digits(std::sqrt(usual.second), 2)});
}

}  // namespace tread::gap
