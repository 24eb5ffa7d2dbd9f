// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/lie_table.hpp"

#include <algorithm>

namespace tread::faults {
namespace {

constexpr int64_t kBegin = 7'000'000;     // [us] since the start: it drives
constexpr double kMission = 20.0;         // [s]
constexpr double kHalfSecond = 0.645;     // strength of a delay of half a second
constexpr double kMirrored = -1.4 / 1.2;  // ... for a pattern set with mirrored turns

Lie lieOf(const char* input, const char* way, FaultKind kind, double strength = 1.0,
          const char* channel = "*") {
  return {input, way, {kind, kBegin, INT64_MAX, channel, "*", strength}};
}

}  // namespace

std::vector<Lie> lies() {
  using Kind = FaultKind;
  return {lieOf("INS", "silent", Kind::kInsOutage, 0.2),
          lieOf("INS", "frozen", Kind::kInsFreeze),
          lieOf("INS", "delayed", Kind::kDelay, kHalfSecond, "INS"),
          lieOf("INS", "lying: a jump of 3 m", Kind::kInsJump),
          lieOf("INS", "lying: drifts 0.4 m/s", Kind::kInsDrift),
          lieOf("INS", "mirrored", Kind::kInsMirror),
          lieOf("range finder", "silent", Kind::kDrop, 1.0, "SCAN"),
          lieOf("range finder", "frozen", Kind::kScanFreeze, 0.2),
          lieOf("range finder", "frozen: three in turn", Kind::kScanFreeze, 0.8),
          lieOf("range finder", "delayed, and says so", Kind::kDelay, kHalfSecond, "SCAN"),
          lieOf("range finder", "delayed, under new times", Kind::kScanLag, 0.3),
          lieOf("range finder", "lying: all far", Kind::kScanFar, 0.2),
          lieOf("range finder", "lying: all zero", Kind::kScanZero),
          lieOf("range finder", "lying: turned", Kind::kScanTurn, 0.3),
          lieOf("range finder", "mirrored", Kind::kScanMirror),
          lieOf("motor controller", "silent", Kind::kMotorLine, 0.5),
          lieOf("motor controller", "silent: cable cut", Kind::kMotorLine, 0.2),
          lieOf("motor controller", "mirrored: tracks swapped", Kind::kDriveMirror),
          lieOf("battery", "lying: sags", Kind::kBattery),
          lieOf("map", "silent", Kind::kDrop, 1.0, "MAP"),
          lieOf("map", "delayed", Kind::kDelay, kHalfSecond, "MAP"),
          lieOf("pattern set", "silent", Kind::kDrop, 1.0, "PATTERN_SET"),
          lieOf("pattern set", "delayed", Kind::kDelay, kHalfSecond, "PATTERN_SET"),
          lieOf("pattern set", "lying: turns 1.6 fold", Kind::kWrongSet),
          lieOf("pattern set", "mirrored", Kind::kWrongSet, kMirrored),
          lieOf("operator", "silent", Kind::kOperatorLost),
          lieOf("operator", "delayed", Kind::kDelay, 1.0, "OPERATOR")};
}

LieFigures measure(const missions::RobotConfig& robot, const Lie& lie,
                   const std::vector<uint64_t>& seeds) {
  LieFigures figures;
  RunOptions options;
  options.duration = kMission;
  for (const uint64_t seed : seeds) {
    FaultSchedule schedule;
    schedule.seed = seed;
    schedule.faults = {lie.fault};
    const FaultyRun run = runFaulty(robot, schedule, options);
    if (!run.effect.moved) continue;
    ++figures.missions;
    figures.collisions += run.collisions;
    if (!run.effect.zero_after) continue;
    ++figures.stopped;
    figures.after = std::max(figures.after, *run.effect.zero_after);
    figures.way = std::max(figures.way, run.effect.zero_way);
    figures.reason = run.effect.reason;
  }
  return figures;
}

}  // namespace tread::faults
