// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "tools/gap/drive_log.hpp"
#include "tools/gap/stretches.hpp"

namespace tread::gap {
namespace {

constexpr double kTolerance = 0.03;         // [s] within which an execution is as long as wanted
constexpr double kMostlyNamed = 1.0 / 3.0;  // of a stretch that executions should cover

/// Pieces of the wanted length from `begin` on.
void cut(size_t stretch, double begin, double end, std::vector<Execution>& pieces) {
  while (begin + kExecutionLength <= end + kTolerance) {
    pieces.push_back({stretch, begin, begin + kExecutionLength});
    begin += kExecutionLength;
  }
}

bool isZero(const TrackCommand& command) {
  return command.left == 0.0 && command.right == 0.0;
}

/// Whether anything is commanded in a piece or in the second before it.
bool drives(const Stretch& stretch, const Execution& piece) {
  for (size_t i = 0; i < stretch.commands.size(); ++i) {
    const double begin = stretch.commands[i].time;
    const double end = i + 1 < stretch.commands.size() ? stretch.commands[i + 1].time : stretch.end;
    if (begin < piece.end && end > piece.begin - 1.0 && !isZero(stretch.commands[i].command))
      return true;
  }
  return false;
}

/// From when on a stretch has poses [s].
double posesBegin(const Stretch& stretch) {
  for (const InsSample& sample : stretch.ins)
    if (std::isfinite(sample.T_map_body.x)) return sample.time;
  return stretch.end;
}

std::vector<Execution> namedIn(size_t index, const Stretch& stretch, double from,
                               const std::vector<Execution>& records) {
  std::vector<Execution> pieces;
  for (const Execution& record : records)
    if (record.begin >= from - kTolerance && record.end <= stretch.end + kTolerance)
      cut(index, record.begin, record.end, pieces);
  return pieces;
}

}  // namespace

std::vector<Execution> executionsOf(const std::vector<Stretch>& stretches,
                                    const std::vector<Execution>& records) {
  std::vector<Execution> all;
  for (size_t index = 0; index < stretches.size(); ++index) {
    const Stretch& stretch = stretches[index];
    // Where commands lead the poses, executions begin with the poses.
    const double first_pose = posesBegin(stretch);
    const double from = first_pose - stretch.begin() > 1.5 ? first_pose : stretch.begin();
    std::vector<Execution> pieces = namedIn(index, stretch, from, records);
    const double covered = kExecutionLength * static_cast<double>(pieces.size());
    if (covered < kMostlyNamed * (stretch.end - from)) {
      pieces.clear();
      cut(index, from, stretch.end, pieces);
    }
    for (const Execution& piece : pieces)
      if (drives(stretch, piece)) all.push_back(piece);
  }
  return all;
}

}  // namespace tread::gap
