// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/soundness/core/log_validation.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/soundness/core/command_check.hpp"
#include "common/soundness/core/log_validation_midway.hpp"
#include "common/soundness/core/log_validation_motion.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::gap {
namespace {

constexpr double kPrecedes = 0.1;  // of correlation^2 that a motion before its command must explain
constexpr double kLagStep = 0.6;   // [s] more than any vehicle's lag varies within a drive
constexpr double kBetterSquare = 0.25;  // of correlation^2 that another lag must gain
constexpr double kLagGrid = 0.02;       // [s] between the tested lags of the gyro
constexpr const char* kFitted = "the fit determines the delay of the heading (INS latency)";
constexpr const char* kAhead = "the heading is ahead of the gyro: are both stamped by one clock?";
constexpr double kPart = 60.0;       // [s] of increments
constexpr double kLeastDrift = 0.3;  // [s] over a drive
constexpr double kEvenly = 0.9;      // share of the lags' differences that a drift must explain

double square(double value) {
  return value * value;
}

/// Standard error of the lag, from ten groups of increments.
double lagError(const LagTable& table, double correlation) {
  constexpr size_t kGroups = 8;
  std::vector<double> lags;
  const size_t size = table.increments();
  for (size_t g = 0; g < kGroups; ++g) {
    const auto match = table.best(g * size / kGroups, (g + 1) * size / kGroups);
    if (match && match->correlation > 0.5 * correlation) lags.push_back(match->lag);
  }
  if (lags.size() < 4) return kNotMeasured;
  double mean = 0.0;
  for (const double lag : lags) mean += lag / static_cast<double>(lags.size());
  double sum = 0.0;
  for (const double lag : lags) sum += square(lag - mean);
  const auto n = static_cast<double>(lags.size());
  return std::sqrt(sum / (n - 1.0) / n);
}

/// Whether the heading is ahead of the gyro, which no INS latency causes.
bool isAhead(const LagTable& table, const LagMatch& match) {
  const double error = lagError(table, match.correlation);
  return std::isfinite(error) && match.lag + 2.58 * error < -kLagGrid;
}

LagTable gyroTable(const Drive& drive, const std::vector<PoseIncrement>& increments) {
  return {increments, ratesOf(increments, &PoseIncrement::omega), gyroSums(drive),
          lagGrid(-0.3, 0.8, kLagGrid)};
}

/// Whether the heading turns enough to be compared.
bool turns(const std::vector<PoseIncrement>& increments) {
  double sum = 0.0;
  for (const PoseIncrement& increment : increments) sum += square(increment.omega());
  return sum > square(0.03) * static_cast<double>(increments.size());
}

/// Checks for a gyro that is constant while the heading turns.
void checkFrozenGyro(const Drive& drive, Diagnostics& notes) {
  for (const Segment& segment : drive.segments) {
    const InsSample* from = nullptr;
    double yaw = kNotMeasured;
    double yaw_from = kNotMeasured;
    for (const InsSample& sample : segment.ins) {
      if (std::isfinite(sample.T_map_body.yaw)) yaw = sample.T_map_body.yaw;
      if (!std::isfinite(sample.omega)) continue;
      if (from == nullptr || sample.omega != from->omega) {
        from = &sample;
        yaw_from = yaw;
      }
      const double time = sample.time - from->time;
      const double turned = std::abs(yaw - yaw_from);
      if (time > 3.0 && turned > 1.0 + 3.0 * std::abs(from->omega) * time)
        return notes.add(findings::kGyroFrozen, {digits(from->omega, 4), digits(from->time),
                                                 digits(sample.time), digits(turned)});
    }
  }
}

/// A part of a drive and the lag by which it follows its commands.
struct PartLag {
  double begin = 0.0, end = 0.0;  ///< [s]
  LagMatch match;
};

/// The parts that follow their commands clearly.
std::vector<PartLag> partLags(const LagTable& table, const std::vector<PoseIncrement>& increments) {
  std::vector<PartLag> parts;
  for (size_t first = 0, last = 0; first < increments.size(); first = last) {
    double sum = 0.0;
    while (last < increments.size() && sum < kPart) sum += increments[last++].duration();
    const auto own = table.best(first, last);
    if (sum >= 0.5 * kPart && own && own->correlation > 0.6)
      parts.push_back({increments[first].begin, increments[last - 1].end, *own});
  }
  return parts;
}

/// Checks for clocks at different rates: the lag grows steadily.
/** Only if a line separates the lags and explains nearly all of their differences. */
bool clocksDrift(const std::vector<PartLag>& parts, Diagnostics& notes) {
  const auto n = static_cast<double>(parts.size());
  if (parts.size() < 5) return false;
  double t = 0.0, lag = 0.0, tt = 0.0, tl = 0.0, ll = 0.0;
  for (const PartLag& part : parts) {
    t += 0.5 * (part.begin + part.end) / n;
    lag += part.match.lag / n;
  }
  for (const PartLag& part : parts) {
    const double at = 0.5 * (part.begin + part.end) - t;
    tt += at * at;
    tl += at * (part.match.lag - lag);
    ll += square(part.match.lag - lag);
  }
  const double slope = tl / tt;
  const double span = parts.back().end - parts.front().begin;
  if (std::abs(slope) * span < kLeastDrift || tl * tl < kEvenly * tt * ll) return false;
  notes.add(findings::kClocksDrift,
            {digits(lag + slope * (parts.front().begin - t), 2), digits(parts.front().begin, 0),
             digits(lag + slope * (parts.back().end - t), 2), digits(parts.back().end, 0),
             digits(1e6 * slope, 0)});
  return true;
}

/// Checks for a clock that jumped: one part of the drive follows its commands with another lag.
void checkParts(const LagTable& table, const std::vector<PartLag>& parts,
                const std::vector<PoseIncrement>& increments, const LagMatch& whole,
                Diagnostics& notes) {
  const auto indexOf = [&](double time) {
    return static_cast<size_t>(
        std::lower_bound(increments.begin(), increments.end(), time,
                         [](const PoseIncrement& one, double t) { return one.begin < t; }) -
        increments.begin());
  };
  for (const PartLag& part : parts) {
    const auto as_whole = table.near(whole.lag, indexOf(part.begin), indexOf(part.end));
    const double left = as_whole ? square(std::max(0.0, as_whole->correlation)) : 0.0;
    if (std::abs(part.match.lag - whole.lag) > kLagStep &&
        square(part.match.correlation) - left > kBetterSquare)
      return notes.add(findings::kLagJumps, {digits(part.begin), digits(part.end),
                                             digits(part.match.lag), digits(whole.lag)});
  }
}

void checkLag(const LagTable& table, const std::vector<PoseIncrement>& increments,
              Diagnostics& notes) {
  const auto best = table.best(0, increments.size());
  const std::vector<PartLag> parts = partLags(table, increments);
  if (clocksDrift(parts, notes)) return;
  if (!best || best->correlation < kClear) return;
  const auto usual = table.best(0, increments.size(), 1.0, -kEarlier, kLongestLag);
  const double left = usual ? square(std::max(0.0, usual->correlation)) : 0.0;
  if (best->lag < -kEarlier && square(best->correlation) - left > kPrecedes)
    return notes.add(findings::kMotionPrecedes, {digits(-best->lag)});
  checkParts(table, parts, increments, *best, notes);
}

constexpr size_t kFewest = 10;  // fewest segments among which an outlier can be detected
constexpr double kLeastTurn =
    0.35;  // [rad] of allowed difference between heading and gyro over a segment
constexpr double kLeastCourse = 0.6;  // [rad] of allowed difference between course and heading
constexpr double kFar = 6.0;          // robust standard deviations

/// Segments whose value deviates from the median by more than a least distance and than six robust
/// standard deviations.
void markOutliers(const std::map<size_t, double>& values, double least,
                  std::vector<size_t>& marked) {
  if (values.size() < kFewest) return;
  std::vector<double> all;
  for (const auto& [segment, value] : values) all.push_back(value);
  const double middle = quantileOf(all, 0.5);
  for (double& value : all) value = std::abs(value - middle);
  const double limit = std::max(least, kFar * 1.4826 * quantileOf(all, 0.5));
  for (const auto& [segment, value] : values)
    if (std::abs(value - middle) > limit) marked.push_back(segment);
}

/// How much more the heading turned than the gyro, by segment [rad].
std::map<size_t, double> turnExcess(const Drive& drive,
                                    const std::vector<PoseIncrement>& increments) {
  std::map<size_t, double> excess;
  const auto match = headingBesideGyro(drive);
  if (!match || std::abs(match->correlation) < 0.5) return excess;
  const RunningSums gyro = gyroSums(drive);
  for (const PoseIncrement& increment : increments) {
    const auto rate =
        gyro[increment.segment].mean(increment.begin - match->lag, increment.end - match->lag);
    if (rate)
      excess[increment.segment] +=
          increment.T_begin_end.yaw - (match->slope * *rate + match->offset) * increment.duration();
  }
  return excess;
}

/// Course relative to the heading, forwards and backwards alike, by segment [rad].
std::map<size_t, double> courses(const std::vector<PoseIncrement>& increments) {
  struct Sum {
    double cos2 = 0.0, sin2 = 0.0;
    int rows = 0;
  };
  std::map<size_t, Sum> sums;
  for (const PoseIncrement& increment : increments) {
    const Pose2& step = increment.T_begin_end;
    const double way = std::hypot(step.x, step.y);
    if (std::abs(step.yaw) > 0.3 || way < 0.2) continue;
    // From the middle of the turn, with twice the angle: forwards and backwards are equal then.
    const double angle = 2.0 * (std::atan2(step.y, step.x) - step.yaw / 2.0);
    Sum& sum = sums[increment.segment];
    sum.cos2 += way * std::cos(angle);
    sum.sin2 += way * std::sin(angle);
    ++sum.rows;
  }
  std::map<size_t, double> result;
  for (const auto& [segment, sum] : sums)
    if (sum.rows >= 5) result[segment] = 0.5 * std::atan2(sum.sin2, sum.cos2);
  return result;
}

}  // namespace

std::optional<LagMatch> headingBesideGyro(const Drive& drive) {
  const auto increments = poseIncrements(drive);
  return gyroTable(drive, increments).best(0, increments.size());
}

void checkGyro(const Drive& drive, Diagnostics& notes) {
  checkFrozenGyro(drive, notes);
  const auto increments = poseIncrements(drive);
  const LagTable table = gyroTable(drive, increments);
  const auto match = table.best(0, increments.size());
  if (!match || !turns(increments)) return notes.add(findings::kNoGyro);
  if (goesAgainst(table, -1.0, 1.0)) {
    const auto against = table.best(0, increments.size(), -1.0);
    return notes.add(findings::kGyroFlipped,
                     {digits(against->slope, 2), digits(against->correlation, 2),
                      std::to_string(against->rows)});
  }
  const std::string r = digits(match->correlation, 2), rows = std::to_string(match->rows);
  if (match->correlation < kClear) return notes.add(findings::kGyroHardlyAgrees, {r, rows});
  // Steady turns show little of a lag: the fit, which uses the commands, determines it.
  notes.add(findings::kGyroAgrees,
            {digits(match->slope, 3), r, rows, isAhead(table, *match) ? kAhead : kFitted});
}

void checkLags(const Drive& drive, const std::vector<PoseIncrement>& increments,
               Diagnostics& notes) {
  const double reach = lagReach(drive);
  const auto lags = lagGrid(-reach, reach, 0.1);
  checkLag({increments, ratesOf(increments, &PoseIncrement::omega), turnCommandSums(drive), lags},
           increments, notes);
  checkLag({increments, ratesOf(increments, &PoseIncrement::v), driveCommandSums(drive), lags},
           increments, notes);
}

std::vector<LogNote> validateLog(const Drive& drive) {
  Diagnostics notes(drive.name);
  const auto increments = poseIncrements(drive);
  if (increments.empty()) {
    notes.add(findings::kNoKnownMotion);
    return notes.notes();
  }
  checkMotion(drive, increments, notes);
  // Signals read in the wrong unit or sign prove nothing about gyro and clocks.
  if (notes.hasFatal()) return notes.notes();
  checkGyro(drive, notes);
  checkLags(drive, increments, notes);
  checkMidway(drive, increments, notes);
  checkPoses(drive, increments, notes);
  describeStandstill(drive, notes);
  describeDriving(drive, increments, notes);
  return notes.notes();
}

std::vector<size_t> brokenSegments(const Drive& drive) {
  const auto increments = poseIncrements(drive);
  std::vector<size_t> marked;
  markOutliers(turnExcess(drive, increments), kLeastTurn, marked);
  markOutliers(courses(increments), kLeastCourse, marked);
  std::sort(marked.begin(), marked.end());
  marked.erase(std::unique(marked.begin(), marked.end()), marked.end());
  return marked;
}

void removeSegments(const std::vector<size_t>& segments, Drive& drive) {
  std::vector<size_t> index(drive.segments.size());
  std::vector<Segment> kept;
  for (size_t i = 0; i < drive.segments.size(); ++i) {
    const bool out = std::binary_search(segments.begin(), segments.end(), i);
    index[i] = out ? SIZE_MAX : kept.size();
    if (!out) kept.push_back(std::move(drive.segments[i]));
  }
  drive.segments = std::move(kept);
  std::vector<Execution> executions;
  for (Execution execution : drive.executions) {
    execution.segment = index[execution.segment];
    if (execution.segment != SIZE_MAX) executions.push_back(execution);
  }
  drive.executions = std::move(executions);
}

}  // namespace tread::gap
