// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/plan/primitives.hpp"

#include <algorithm>
#include <cmath>

#include "common/config/config_reader.hpp"

namespace tread::plan {
namespace {

double lengthOf(const std::vector<Pose2>& poses) {
  double length = 0.0;
  for (size_t i = 1; i < poses.size(); ++i) {
    const double dx = poses[i].x - poses[i - 1].x;
    const double dy = poses[i].y - poses[i - 1].y;
    length += std::sqrt(dx * dx + dy * dy);
  }
  return length;
}

double seconds(double length, double turn, const PrimitivePace& pace) {
  return std::max(length / pace.speed, turn / ((kPi / 4.0) / pace.turn_time));
}

/// Poses from the start pose on in its frame, the start itself first.
std::vector<Pose2> fromStart(const Primitive& primitive, double heading) {
  const Pose2 T_map_start{0.0, 0.0, heading};
  std::vector<Pose2> poses{{}};
  for (const Pose2& T_map_body : primitive.poses) {
    Pose2 pose = between(T_map_start, T_map_body);
    pose.yaw = poses.back().yaw + wrapAngle(pose.yaw - poses.back().yaw);
    poses.push_back(pose);
  }
  // Numbers in files are rounded to a tenth of a millimetre and of a milliradian.
  const Pose2& first = poses[1];
  if (std::hypot(first.x, first.y) < 1e-4 && std::abs(first.yaw) < 1e-4)
    poses.erase(poses.begin() + 1);
  return poses;
}

/// Smallest turn between two headings of 0..2 pi [rad].
double turnBetween(double from, double to) {
  const double difference = std::abs(to - from);
  return difference > kPi ? std::abs(difference - 2.0 * kPi) : difference;
}

/// The lattice's cell of a coordinate; behind the start's cell SBPL counts a border to the cell
/// before it, which no pose of a sensible set meets.
int cellOf(double from_corner, double resolution) {
  return static_cast<int>(std::floor(from_corner / resolution));
}

std::vector<CellIndex> passedCells(const Primitive& primitive, double resolution) {
  std::vector<CellIndex> cells;
  for (const Pose2& pose : primitive.poses) {
    const CellIndex cell{cellOf(pose.x + resolution / 2.0, resolution),
                         cellOf(pose.y + resolution / 2.0, resolution)};
    if (cells.empty() || !(cells.back() == cell)) cells.push_back(cell);
  }
  return cells;
}

}  // namespace

std::vector<FreePrimitive> headingFree(const PrimitiveFile& file, const PrimitivePace& pace) {
  std::vector<FreePrimitive> free;
  for (const Primitive& primitive : file.primitives) {
    if (primitive.start_bin != 0) continue;
    std::vector<Pose2> poses = fromStart(primitive, file.headings.front());
    const double turn = std::abs(poses.back().yaw);
    const double duration = seconds(lengthOf(poses), turn, pace);
    poses.erase(poses.begin());
    free.push_back(
        {primitive.id, std::move(poses), duration, static_cast<double>(primitive.cost_multiplier)});
  }
  if (free.empty())
    throw ConfigError(file.name + ": no primitive begins in heading bin 0; without that heading " +
                      "none can be used for all");
  return free;
}

std::vector<std::vector<LatticeAction>> latticeActions(const PrimitiveFile& file,
                                                       const PrimitivePace& pace) {
  std::vector<std::vector<LatticeAction>> actions(file.headings.size());
  for (const Primitive& primitive : file.primitives) {
    const auto start = static_cast<size_t>(primitive.start_bin);
    const double turn =
        turnBetween(file.headings[start], file.headings[static_cast<size_t>(primitive.end_bin)]);
    const double duration = seconds(lengthOf(primitive.poses), turn, pace);
    const double time = std::ceil(1000.0 * duration);
    actions[start].push_back({primitive.id, primitive.dx, primitive.dy, primitive.end_bin,
                              static_cast<int64_t>(time) * primitive.cost_multiplier, duration,
                              passedCells(primitive, file.resolution)});
  }
  return actions;
}

}  // namespace tread::plan
