// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/import/foreign_drive.hpp"

#include <cmath>
#include <utility>

#include "common/drive/odometer.hpp"
#include "common/report/text.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::import {

using recordings::DriveSample;
using recordings::Fix;
using recordings::kLongestHold;
using recordings::kPeriod;
using recordings::RecordedDrive;

namespace {

/// Whether two poses are farther apart than a ground vehicle can drive in the time between them.
bool isBeyondReach(const Fix& a, const Fix& b) {
  return !isWithinReach(a.T_map_body.position(), b.T_map_body.position(), b.time - a.time);
}

/// Whether the i-th pose is out of reach from its predecessor in the same track.
bool jumps(const std::vector<Fix>& poses, size_t i) {
  return i > 0 && i < poses.size() && !poses[i].new_track && isBeyondReach(poses[i - 1], poses[i]);
}

/// Whether only the i-th pose is an outlier: its neighbours agree with each other.
bool isAlone(const std::vector<Fix>& poses, size_t i) {
  return jumps(poses, i) && jumps(poses, i + 1) && !isBeyondReach(poses[i - 1], poses[i + 1]);
}

}  // namespace

bool CommandOrder::operator()(const Command& a, const Command& b) const {
  for (size_t c = 0; c < Command::kMaxChannels; ++c)
    if (a[c] != b[c]) return a[c] < b[c];
  return false;
}

double largestShare(const std::vector<Loss>& losses) {
  std::map<std::string, double> shares;
  double largest = 0.0;
  for (const Loss& loss : losses) {
    double& share = shares[loss.unit];
    share += loss.of > 0.0 ? loss.lost / loss.of : 1.0;
    largest = std::max(largest, share);
  }
  return largest;
}

std::string lineOf(const Loss& loss) {
  if (loss.of <= 0.0) return "an unknown part: " + loss.what;
  const auto number = [](double value) {
    return formatted(value == std::floor(value) ? "%.0f" : "%.1f", value);
  };
  return number(loss.lost) + " of " + number(loss.of) + " " + loss.unit +
         formatted(" (%.2g %%): ", 100.0 * loss.lost / loss.of) + loss.what;
}

void takeJumpsOut(std::vector<Fix>& poses, const std::function<std::string(size_t)>& place,
                  ForeignDrive& result) {
  size_t all = 0, alone = 0, first_alone = 0, tracks = 0, first_track = 0;
  for (size_t i = 1; i < poses.size(); ++i) all += jumps(poses, i);
  if (all * 10 > poses.size() && all > 2) {
    result.notes.push_back(
        std::to_string(all) + " of " + std::to_string(poses.size()) +
        " poses are farther from the one before than a ground vehicle can drive; "
        "are the units of positions and times right?");
    return;
  }
  std::vector<Fix> kept;
  for (size_t i = 0; i < poses.size(); ++i) {
    if (isAlone(poses, i)) {
      if (alone++ == 0) first_alone = i;
      kept.push_back(poses[++i]);
      continue;
    }
    kept.push_back(poses[i]);
    if (!jumps(poses, i)) continue;
    kept.back().new_track = true;
    if (tracks++ == 0) first_track = i;
  }
  if (alone > 0)
    result.lose("farther from both neighbours than a ground vehicle can drive, the first at " +
                    place(first_alone),
                alone, poses.size(), "poses");
  if (tracks > 0)
    result.notes.push_back(
        "poses jump farther than a ground vehicle can drive: a new track begins " +
        std::to_string(tracks) + (tracks == 1 ? " time" : " times") + ", the first at " +
        place(first_track));
  poses = std::move(kept);
}

double usualPeriod(const std::vector<double>& times) {
  std::vector<double> steps;
  for (size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  return upperMedian(std::move(steps));
}

std::optional<std::string> timeUnitProblem(std::vector<double> times, double unit) {
  static const std::pair<const char*, double> kUnits[] = {
      {"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}};
  if (times.size() < 3) return std::nullopt;
  const double first = times.front();
  std::sort(times.begin(), times.end());
  const double period = usualPeriod(times);
  const double seconds = period * unit;
  const bool strange = first * unit > 4e9 || seconds < 1e-4 || seconds > 20.0;
  const bool unusual = seconds < 1e-3 || seconds > 2.0;
  const std::pair<const char*, double>* best = nullptr;
  for (const auto& other : kUnits) {
    const double as = period * other.second;
    if (as < 1e-4 || as > 20.0 || other.second == unit || first * other.second > 4e9) continue;
    const bool nearer = best == nullptr || std::abs(std::log(as / kPeriod)) <
                                               std::abs(std::log(period * best->second / kPeriod));
    if (isCalendar(first * other.second) || nearer) best = &other;
    if (isCalendar(first * other.second)) break;
  }
  if (period <= 0.0 || isCalendar(first * unit) || best == nullptr) return std::nullopt;
  if (!strange && !(unusual && isCalendar(first * best->second))) return std::nullopt;
  return "the times are " + threeDigits(seconds) + " s apart; in " + best->first +
         " they would be " + threeDigits(period * best->second) + " s apart";
}

double holdOf(double period) {
  return std::clamp(3.0 * period, kLongestHold, kCommandAge);
}

void holdCommands(const std::vector<DriveSample>& commands, double period, double hold,
                  RecordedDrive& drive) {
  constexpr double kSame = 1e-6;  // [s]
  const auto follows = [&](size_t i) {
    return commands[i].time - commands[i - 1].time <= hold + kSame;
  };
  for (size_t at = 0; at < commands.size(); ++at) {
    const double begin = commands[at].time;
    size_t last = at;
    while (last + 1 < commands.size() && follows(last + 1)) ++last;
    const double end = commands[last].time + std::max(kPeriod, std::min(period, hold));
    for (int i = 0; begin + kPeriod * i < end - kSame; ++i) {
      const double time = begin + kPeriod * i;
      while (at < last && commands[at + 1].time <= time + kSame) ++at;
      drive.drive.push_back(commands[at]);
      drive.drive.back().time = time;
    }
    at = last;
  }
}

void findRuns(RecordedDrive& drive) {
  std::map<Command, int, CommandOrder> numbers;
  const std::vector<DriveSample>& samples = drive.drive;
  const auto follows = [&](size_t i) {
    return samples[i].time - samples[i - 1].time <= kLongestHold;
  };
  for (size_t first = 0; first < samples.size();) {
    const Command& command = samples[first].command;
    size_t end = first + 1;
    while (end < samples.size() && samples[end].command == command && follows(end)) ++end;
    if (command != Command{}) {
      const auto next = static_cast<int>(numbers.size()) + 1;
      const int number = numbers.emplace(command, next).first->second;
      const char* const why = end == samples.size() || samples[end].apart ? "the log ended"
                              : follows(end)                              ? "the command changed"
                                             : recordings::kCommandsMissing;
      drive.runs.push_back({number, samples[first].time, samples[end - 1].time + kPeriod, why});
    }
    first = end;
  }
}

}  // namespace tread::import
