// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/pass_overlap.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include "common/messages/ins_messages.hpp"

namespace tread {
namespace {

constexpr int kNear = 2, kFar = 10;  // [cells]
constexpr double kPass = 30.0;       // [m]

double wayOf(const MappingRecording& recording) {
  std::optional<Pose2> last;
  double way = 0.0;
  for (const ins_t& message : recording.poses)
    if (const auto pose = planarPose(message)) {
      if (last) way += distanceBetween(*last, *pose);
      last = pose;
    }
  return way;
}

/// The scans of each pass with the surrounding poses.
std::vector<MappingRecording> passesOf(const MappingRecording& recording, double way) {
  std::vector<MappingRecording> passes;
  std::optional<Pose2> last;
  double driven = 0.0;
  size_t scan = 0;
  const auto cut = [&] {
    passes.emplace_back();
    passes.back().config = recording.config;
    driven = 0.0;
  };
  cut();
  for (const ins_t& message : recording.poses) {
    if (const auto pose = planarPose(message)) {
      if (last) driven += distanceBetween(*last, *pose);
      last = pose;
    }
    passes.back().poses.push_back(message);
    bool whole = false;
    for (; scan < recording.scans.size() &&
           recording.scans[scan].utime + recording.scans[scan].duration <= message.utime;
         ++scan) {
      passes.back().scans.push_back(recording.scans[scan]);
      whole = true;
    }
    if (driven < way || !whole) continue;
    cut();
    passes.back().poses.push_back(message);
  }
  return passes;
}

/// Whether an obstacle is within `reach` cells, in both directions.
bool obstacleWithin(const Grid& grid, CellIndex cell, int reach) {
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (x * x + y * y <= reach * reach && grid.at({cell.x + x, cell.y + y}) == kObstacle)
        return true;
  return false;
}

void compare(const Grid& pass, const Grid& other, PassPairs& pairs) {
  const int64_t before = pairs.cells;
  const CellIndex from{std::max(pass.lower().x, other.lower().x),
                       std::max(pass.lower().y, other.lower().y)};
  const int right = std::min(pass.lower().x + pass.width(), other.lower().x + other.width());
  const int top = std::min(pass.lower().y + pass.height(), other.lower().y + other.height());
  for (int y = from.y; y < top; ++y)
    for (int x = from.x; x < right; ++x) {
      if (pass.at({x, y}) != kObstacle) continue;
      // Cells behind the other pass's wall are unknown, but the wall itself is known.
      const bool far = obstacleWithin(other, {x, y}, kFar);
      if (!far && other.at({x, y}) == kUnknown) continue;
      ++pairs.cells;
      if (far) ++pairs.within_ten;
      if (far && obstacleWithin(other, {x, y}, kNear)) ++pairs.within_two;
    }
  if (pairs.cells > before) ++pairs.pairs;
}

}  // namespace

PassOverlap overlapOf(const MappingRecording& recording) {
  std::vector<Grid> maps;
  for (const MappingRecording& pass : passesOf(recording, std::min(kPass, wayOf(recording) / 8.0)))
    maps.push_back(replayMapping(pass).window);
  PassOverlap overlap;
  overlap.passes = static_cast<int>(maps.size());
  for (size_t a = 0; a < maps.size(); ++a)
    for (size_t b = a + 1; b < maps.size(); ++b)
      compare(maps[b], maps[a], b == a + 1 ? overlap.in_a_row : overlap.again);
  return overlap;
}

std::string reportOf(const PassOverlap& overlap) {
  const auto line = [](const char* what, const PassPairs& pairs) {
    std::ostringstream out;
    out.precision(3);
    out << "  " << what << ": " << pairs.pairs << " pairs see common ground";
    const double percent = 100.0 / static_cast<double>(std::max<int64_t>(1, pairs.cells));
    if (pairs.cells > 0)
      out << "; of " << pairs.cells << " obstacle cells "
          << percent * static_cast<double>(pairs.within_two) << " % lie within two cells, "
          << percent * static_cast<double>(pairs.within_ten) << " % within ten";
    return out.str() + "\n";
  };
  return line("passes in a row", overlap.in_a_row) + line("passes again", overlap.again);
}

}  // namespace tread
