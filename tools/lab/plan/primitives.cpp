// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/plan/primitives.hpp"

#include <algorithm>
#include <cmath>

#include "common/config/config_reader.hpp"
#include "tools/lab/plan/tokenizer.hpp"

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

/// Poses in the start pose's frame, including the start.
std::vector<Pose2> fromStart(const LatticePrimitive& primitive, double heading) {
  const Pose2 T_map_start{0.0, 0.0, heading};
  std::vector<Pose2> poses{{}};
  for (const Pose2& T_map_body : primitive.poses) {
    Pose2 pose = between(T_map_start, T_map_body);
    pose.yaw = poses.back().yaw + wrapAngle(pose.yaw - poses.back().yaw);
    poses.push_back(pose);
  }
  // Numbers in files are rounded to .1 mm and .1 mrad.
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

/// Lattice cell of a coordinate. For negative coordinates SBPL assigns a border to the cell before
/// it, which no pose of a valid set reaches.
int cellOf(double from_corner, double resolution) {
  return static_cast<int>(std::floor(from_corner / resolution));
}

std::vector<CellIndex> passedCells(const LatticePrimitive& primitive, double resolution) {
  std::vector<CellIndex> cells;
  for (const Pose2& pose : primitive.poses) {
    const CellIndex cell{cellOf(pose.x + resolution / 2.0, resolution),
                         cellOf(pose.y + resolution / 2.0, resolution)};
    if (cells.empty() || !(cells.back() == cell)) cells.push_back(cell);
  }
  return cells;
}

constexpr int kMostBins = 720;
constexpr int kMostPrimitives = 100'000;
constexpr int kMostPoses = 10'000;
constexpr int kFarthest = 10'000;  // [cells] longest primitive
constexpr int kDearest = 100'000;
constexpr double kFarthestPose = 1e3;  // [m]
constexpr double kMostTurn = 100.0;    // [rad]

int readInt(Tokenizer& tokens, const std::string& key, int min, int max) {
  tokens.expect(key + ":");
  return static_cast<int>(tokens.integer(key, min, max));
}

std::vector<double> evenHeadings(int bins) {
  std::vector<double> headings;
  for (int i = 0; i < bins; ++i) headings.push_back(i * (2.0 * kPi / bins));
  return headings;
}

/// Lines "angle:0 0.000" of a set with uneven bins.
std::vector<double> statedHeadings(Tokenizer& tokens, int bins) {
  std::vector<double> headings;
  for (int i = 0; i < bins; ++i) {
    const std::string key = "angle:" + std::to_string(i);
    tokens.expect(key);
    headings.push_back(tokens.number(key, {0.0, 2.0 * kPi}, "rad"));
    if (i > 0 && headings[static_cast<size_t>(i)] <= headings[static_cast<size_t>(i - 1)])
      throw tokens.error(key + " is not greater than the angle before it");
  }
  return headings;
}

bool startsWith(std::string_view word, std::string_view begin) {
  return word.substr(0, begin.size()) == begin;
}

void readHeader(Tokenizer& tokens, PrimitiveFile& file) {
  tokens.expect("resolution_m:");
  file.resolution = tokens.number("resolution_m", {1e-3, 100.0}, "m");
  if (tokens.peek() == "min_turning_radius_m:") {
    tokens.expect("min_turning_radius_m:");
    tokens.number("min_turning_radius_m", {0.0, 1e6}, "m");
  }
  const int bins = readInt(tokens, "numberofangles", 1, kMostBins);
  const bool stated = startsWith(tokens.peek(), "angle:");
  file.headings = stated ? statedHeadings(tokens, bins) : evenHeadings(bins);
}

/// Bins may be off by a full turn.
int wrapBin(int bin, int bins) {
  return (bin % bins + bins) % bins;
}

bool isNear(const Pose2& pose, double x, double y, double resolution) {
  // Numbers in files are rounded to .1 mm.
  const double reach = resolution / 2.0 + 1e-4;
  return std::abs(pose.x - x) <= reach && std::abs(pose.y - y) <= reach;
}

LatticePrimitive readPrimitive(Tokenizer& tokens, const PrimitiveFile& file) {
  const int bins = static_cast<int>(file.headings.size());
  LatticePrimitive primitive;
  primitive.id = readInt(tokens, "primID", 0, kMostPrimitives);
  primitive.start_bin = readInt(tokens, "startangle_c", 0, bins - 1);
  primitive.dx = readInt(tokens, "endpose_c", -kFarthest, kFarthest);
  primitive.dy = static_cast<int>(tokens.integer("endpose_c's y", -kFarthest, kFarthest));
  primitive.end_bin = wrapBin(
      static_cast<int>(tokens.integer("endpose_c's heading bin", -bins, 2 * bins - 1)), bins);
  primitive.cost_multiplier = readInt(tokens, "additionalactioncostmult", 1, kDearest);
  if (tokens.peek() == "turning_radius:") {
    tokens.expect("turning_radius:");
    tokens.number("turning_radius", {-1e9, 1e9}, "m");
  }
  const int poses = readInt(tokens, "intermediateposes", 2, kMostPoses);
  for (int i = 0; i < poses; ++i)
    primitive.poses.push_back(tokens.pose("a pose", kFarthestPose, kMostTurn));
  if (const std::string problem = endsProblem(primitive, file); !problem.empty())
    throw tokens.error(problem);
  return primitive;
}

}  // namespace

std::vector<SearchPrimitive> headingFree(const PrimitiveFile& file, const PrimitivePace& pace) {
  std::vector<SearchPrimitive> primitives;
  for (const LatticePrimitive& read : file.primitives) {
    if (read.start_bin != 0) continue;
    SearchPrimitive primitive;
    primitive.id = static_cast<int>(primitives.size());
    primitive.file_id = read.id;
    primitive.poses = fromStart(read, file.headings.front());
    const double turn = std::abs(primitive.poses.back().yaw);
    primitive.duration = seconds(lengthOf(primitive.poses), turn, pace);
    primitive.cost = primitive.duration * read.cost_multiplier;
    primitive.poses.erase(primitive.poses.begin());
    primitives.push_back(std::move(primitive));
  }
  if (primitives.empty())
    throw ConfigError(file.name + ": no primitive begins in heading bin 0; without that heading " +
                      "none can be used for all");
  return primitives;
}

std::vector<SearchPrimitive> onLattice(const PrimitiveFile& file, const PrimitivePace& pace) {
  std::vector<SearchPrimitive> primitives;
  for (int bin = 0; bin < static_cast<int>(file.headings.size()); ++bin) {
    for (const LatticePrimitive& read : file.primitives) {
      if (read.start_bin != bin) continue;
      const double start = file.headings[static_cast<size_t>(bin)];
      const double end = file.headings[static_cast<size_t>(read.end_bin)];
      SearchPrimitive primitive;
      primitive.id = static_cast<int>(primitives.size());
      primitive.file_id = read.id;
      primitive.start_bin = bin;
      primitive.duration = seconds(lengthOf(read.poses), turnBetween(start, end), pace);
      primitive.cost = std::ceil(1000.0 * primitive.duration) * read.cost_multiplier;
      Pose2 T_start_end =
          between({0.0, 0.0, start}, {read.dx * file.resolution, read.dy * file.resolution, end});
      T_start_end.yaw = wrapAngle(T_start_end.yaw);
      primitive.poses = {T_start_end};
      primitive.cells = passedCells(read, file.resolution);
      primitive.cells.push_back({read.dx, read.dy});
      primitives.push_back(std::move(primitive));
    }
  }
  return primitives;
}

std::string endsProblem(const LatticePrimitive& primitive, const PrimitiveFile& file) {
  const double cell = file.resolution;
  const Pose2& first = primitive.poses.front();
  if (!isNear(first, 0.0, 0.0, cell) || nearestBin(file.headings, first.yaw) != primitive.start_bin)
    return "its first pose misses the start by more than half a cell or bin";
  const Pose2& last = primitive.poses.back();
  if (!isNear(last, primitive.dx * cell, primitive.dy * cell, cell) ||
      nearestBin(file.headings, last.yaw) != primitive.end_bin)
    return "its last pose misses its end by more than half a cell or bin";
  if (primitive.dx == 0 && primitive.dy == 0 && primitive.end_bin == primitive.start_bin)
    return "it neither moves nor turns";
  return {};
}

int nearestBin(const std::vector<double>& headings, double yaw) {
  size_t nearest = 0;
  for (size_t i = 1; i < headings.size(); ++i)
    if (std::abs(wrapAngle(yaw - headings[i])) < std::abs(wrapAngle(yaw - headings[nearest])))
      nearest = i;
  return static_cast<int>(nearest);
}

PrimitiveFile parsePrimitives(std::string text, const std::string& name) {
  Tokenizer tokens(std::move(text), name);
  if (startsWith(tokens.peek(), "{"))
    throw tokens.error("this is JSON; nav2's lattice primitives are read from a file FILE.json");
  PrimitiveFile file;
  file.name = name;
  readHeader(tokens, file);
  const int count = readInt(tokens, "totalnumberofprimitives", 1, kMostPrimitives);
  for (int i = 0; i < count; ++i) {
    tokens.inside("primitive " + std::to_string(i + 1) + " of " + std::to_string(count));
    file.primitives.push_back(readPrimitive(tokens, file));
  }
  tokens.inside("");
  if (!tokens.atEnd())
    throw tokens.error("there is more text after the last of " + std::to_string(count) +
                       " primitives");
  return file;
}

PrimitiveFile readPrimitives(const std::string& path) {
  return parsePrimitives(readWhole(path), path);
}

}  // namespace tread::plan
