// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "common/soundness/core/lag_table.hpp"

#include <algorithm>
#include <cmath>

namespace tread::gap {
namespace {

constexpr double kShortest = 0.4;         // [s] of an increment
constexpr double kLongest = 1.2;          // [s]
constexpr double kGyroGap = 0.5;          // [s] over which the gyro is not interpolated
constexpr double kEncoderGap = 0.5;       // [s] over which encoders and currents are held
constexpr size_t kFewestIncrements = 12;  // increments of a match

/// Running sums of a reading of the motor controller, each held until the next one.
template <class Sample, class Rate>
RunningSums heldSums(const Drive& drive, const std::vector<Sample>& samples, const Rate& rate) {
  RunningSums sums;
  for (const Segment& segment : drive.segments) {
    RunningSum sum;
    auto sample = std::lower_bound(samples.begin(), samples.end(), segment.begin() - kEncoderGap,
                                   [](const Sample& one, double time) { return one.time < time; });
    for (; sample != samples.end() && sample->time < segment.end; ++sample) {
      const auto next = std::next(sample);
      const bool held = next != samples.end() && next->time - sample->time <= kEncoderGap;
      const double value = rate(*sample);
      if (held && std::isfinite(value)) sum.add(sample->time, next->time, value);
    }
    sums.push_back(std::move(sum));
  }
  return sums;
}

}  // namespace

std::vector<PoseIncrement> poseIncrements(const Drive& drive) {
  std::vector<PoseIncrement> increments;
  for (size_t s = 0; s < drive.segments.size(); ++s) {
    const InsSample* from = nullptr;
    for (const InsSample& sample : drive.segments[s].ins) {
      if (!sample.hasPose() || !std::isfinite(sample.time)) continue;
      const double duration = from == nullptr ? 0.0 : sample.time - from->time;
      if (from != nullptr && duration < kShortest) continue;
      if (from != nullptr && duration <= kLongest)
        increments.push_back({s, from->time, sample.time,
                              between(from->T_map_body, sample.T_map_body), from->T_map_body});
      from = &sample;
    }
  }
  return increments;
}

std::vector<double> ratesOf(const std::vector<PoseIncrement>& increments,
                            double (PoseIncrement::*rate)() const) {
  std::vector<double> rates;
  for (const PoseIncrement& increment : increments) rates.push_back((increment.*rate)());
  return rates;
}

void RunningSum::add(double begin, double end, double rate) {
  if (!(end > begin) || !std::isfinite(rate)) return;
  const bool goes_on = !points_.empty() && std::abs(points_.back().time - begin) < 1e-9;
  if (!goes_on) {
    if (!points_.empty() && begin < points_.back().time) return;
    const size_t piece = points_.empty() ? 0 : points_.back().piece + 1;
    points_.push_back({begin, points_.empty() ? 0.0 : points_.back().sum, piece});
  }
  points_.push_back({end, points_.back().sum + rate * (end - begin), points_.back().piece});
}

std::optional<std::pair<double, size_t>> RunningSum::at(double time) const {
  const auto next = std::lower_bound(points_.begin(), points_.end(), time,
                                     [](const Point& point, double t) { return point.time < t; });
  if (next == points_.end()) return std::nullopt;
  if (next->time == time) return std::pair{next->sum, next->piece};
  if (next == points_.begin() || std::prev(next)->piece != next->piece) return std::nullopt;
  const Point& before = *std::prev(next);
  const double share = (time - before.time) / (next->time - before.time);
  return std::pair{before.sum + share * (next->sum - before.sum), next->piece};
}

std::optional<double> RunningSum::mean(double begin, double end) const {
  const auto from = at(begin);
  const auto to = at(end);
  if (!from || !to || from->second != to->second) return std::nullopt;
  return (to->first - from->first) / (end - begin);
}

RunningSums gyroSums(const Drive& drive) {
  RunningSums sums;
  for (const Segment& segment : drive.segments) {
    RunningSum sum;
    const InsSample* last = nullptr;
    for (const InsSample& sample : segment.ins) {
      if (!std::isfinite(sample.omega) || !std::isfinite(sample.time)) continue;
      if (last != nullptr && sample.time - last->time <= kGyroGap)
        sum.add(last->time, sample.time, 0.5 * (last->omega + sample.omega));
      last = &sample;
    }
    sums.push_back(std::move(sum));
  }
  return sums;
}

RunningSums encoderSums(const Drive& drive,
                        const std::function<double(const TrackCommand&)>& rate) {
  return heldSums(drive, drive.encoders,
                  [&rate](const EncoderSample& sample) { return rate(sample.speed.tracks()); });
}

RunningSums currentSums(const Drive& drive, double CurrentSample::*side) {
  return heldSums(drive, drive.currents,
                  [side](const CurrentSample& sample) { return sample.*side; });
}

RunningSums commandSums(const Drive& drive,
                        const std::function<double(const TrackCommand&)>& rate) {
  RunningSums sums;
  for (const Segment& segment : drive.segments) {
    RunningSum sum;
    for (size_t i = 0; i < segment.commands.size(); ++i) {
      const bool last = i + 1 == segment.commands.size();
      sum.add(segment.commands[i].time, last ? segment.end : segment.commands[i + 1].time,
              rate(drive.sides(segment.commands[i].command)));
    }
    sums.push_back(std::move(sum));
  }
  return sums;
}

RunningSums turnCommandSums(const Drive& drive) {
  return commandSums(drive, [](const TrackCommand& c) { return c.right - c.left; });
}

RunningSums driveCommandSums(const Drive& drive) {
  return commandSums(drive, [](const TrackCommand& c) { return 0.5 * (c.left + c.right); });
}

LagTable::LagTable(const std::vector<PoseIncrement>& increments, const std::vector<double>& rates,
                   const RunningSums& sums, std::vector<double> lags)
    : rates_(rates), lags_(std::move(lags)) {
  for (const double lag : lags_) {
    std::vector<double> column;
    for (const PoseIncrement& increment : increments)
      column.push_back(sums[increment.segment]
                           .mean(increment.begin - lag, increment.end - lag)
                           .value_or(kNotMeasured));
    leading_.push_back(std::move(column));
  }
  // Lags are compared over the same increments, because those late in a segment are steadier.
  for (size_t i = 0; i < rates_.size(); ++i)
    for (const std::vector<double>& column : leading_)
      if (!std::isfinite(column[i])) rates_[i] = kNotMeasured;
}

std::optional<LagMatch> LagTable::match(size_t lag, size_t first, size_t last) const {
  double n = 0.0, x = 0.0, y = 0.0;
  const std::vector<double>& leading = leading_[lag];
  for (size_t i = first; i < last; ++i) {
    if (!std::isfinite(leading[i]) || !std::isfinite(rates_[i])) continue;
    n += 1.0;
    x += leading[i];
    y += rates_[i];
  }
  const auto rows = static_cast<size_t>(n);
  if (rows < kFewestIncrements || 3 * rows < last - first) return std::nullopt;
  x /= n;
  y /= n;
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (size_t i = first; i < last; ++i) {
    if (!std::isfinite(leading[i]) || !std::isfinite(rates_[i])) continue;
    xx += (leading[i] - x) * (leading[i] - x);
    yy += (rates_[i] - y) * (rates_[i] - y);
    xy += (leading[i] - x) * (rates_[i] - y);
  }
  const double scale = std::sqrt(xx * yy);
  if (!(scale > 1e-12) || !std::isfinite(scale)) return std::nullopt;
  return LagMatch{lags_[lag], xy / scale,        xy / xx,          y - xy / xx * x,
                  rows,       std::sqrt(yy / n), std::sqrt(xx / n)};
}

std::optional<LagMatch> LagTable::best(size_t first, size_t last, double sign, double from,
                                       double to) const {
  std::vector<std::optional<LagMatch>> all;
  size_t top = 0;
  for (const double lag : lags_) {
    const bool within = lag >= from - 1e-9 && lag <= to + 1e-9;
    all.push_back(within ? match(all.size(), first, last) : std::nullopt);
    const auto& now = all.back();
    if (now && (!all[top] || sign * now->correlation > sign * all[top]->correlation))
      top = all.size() - 1;
  }
  if (all.empty() || !all[top]) return std::nullopt;
  LagMatch found = *all[top];
  if (top == 0 || top + 1 == lags_.size() || !all[top - 1] || !all[top + 1]) return found;
  // The peak of the parabola through three neighbours.
  const double left = sign * all[top - 1]->correlation;
  const double right = sign * all[top + 1]->correlation;
  const double bend = left - 2.0 * sign * found.correlation + right;
  if (bend < 0.0) found.lag += 0.5 * (left - right) / bend * (lags_[top + 1] - lags_[top]);
  return found;
}

std::optional<LagMatch> LagTable::near(double lag, size_t first, size_t last) const {
  size_t nearest = 0;
  for (size_t i = 0; i < lags_.size(); ++i)
    if (std::abs(lags_[i] - lag) < std::abs(lags_[nearest] - lag)) nearest = i;
  return lags_.empty() ? std::nullopt : match(nearest, first, last);
}

std::vector<double> lagGrid(double begin, double end, double step) {
  std::vector<double> lags;
  const auto count = static_cast<int>(std::lround((end - begin) / step));
  for (int i = 0; i <= count; ++i) lags.push_back(begin + step * i);
  return lags;
}

}  // namespace tread::gap
