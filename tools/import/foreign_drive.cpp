// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/import/foreign_drive.hpp"

#include <algorithm>
#include <utility>

namespace tread::import {

using recordings::DriveSample;
using recordings::kPeriod;
using recordings::RecordedDrive;

namespace {

/// A longer silence of the commands leaves no samples [s].
constexpr double kLongestIdle = 60.0;

}  // namespace

void holdCommands(std::vector<DriveSample> commands, double age, RecordedDrive& drive) {
  if (commands.empty()) return;
  std::stable_sort(commands.begin(), commands.end(),
                   [](const DriveSample& a, const DriveSample& b) { return a.time < b.time; });
  size_t at = 0;
  const double begin = commands.front().time;
  const auto count = static_cast<size_t>((commands.back().time - begin) / kPeriod) + 1;
  for (size_t i = 0; i < count; ++i) {
    const double time = begin + kPeriod * static_cast<double>(i);
    while (at + 1 < commands.size() && commands[at + 1].time <= time) ++at;
    if (time - commands[at].time > std::max(age, kLongestIdle)) continue;
    DriveSample sample = commands[at];
    sample.automatic = time - sample.time <= age;
    if (!sample.automatic) sample.command = {0.0, 0.0};
    sample.time = time;
    drive.drive.push_back(sample);
  }
}

void findRuns(RecordedDrive& drive) {
  std::map<std::pair<double, double>, int> numbers;
  const std::vector<DriveSample>& samples = drive.drive;
  for (size_t first = 0; first < samples.size();) {
    const TrackCommand& command = samples[first].command;
    size_t end = first + 1;
    while (end < samples.size() && samples[end].command == command) ++end;
    if (command != TrackCommand{}) {
      const auto next = static_cast<int>(numbers.size()) + 1;
      const int number =
          numbers.emplace(std::pair(command.left, command.right), next).first->second;
      const char* const why = end < samples.size() ? "the command changed" : "the log ended";
      drive.runs.push_back({number, samples[first].time, samples[end - 1].time + kPeriod, why});
    }
    first = end;
  }
}

}  // namespace tread::import
