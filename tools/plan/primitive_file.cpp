// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/plan/primitive_file.hpp"

#include <cmath>

#include "common/config/scalars.hpp"
#include "tools/plan/words.hpp"

namespace tread::plan {
namespace {

constexpr int kMostBins = 720;
constexpr int kMostPrimitives = 100'000;
constexpr int kMostPoses = 10'000;
constexpr int kFarthest = 10'000;  // [cells] that a primitive may reach
constexpr int kDearest = 100'000;
constexpr double kFarthestPose = 1e3;  // [m]
constexpr double kMostTurn = 100.0;    // [rad]

int readInt(Words& words, const std::string& key, int min, int max) {
  words.expect(key + ":");
  return static_cast<int>(words.integer(key, min, max));
}

std::vector<double> evenHeadings(int bins) {
  std::vector<double> headings;
  for (int i = 0; i < bins; ++i) headings.push_back(i * (2.0 * kPi / bins));
  return headings;
}

/// The lines "angle:0 0.000" of a set whose bins are uneven.
std::vector<double> statedHeadings(Words& words, int bins) {
  std::vector<double> headings;
  for (int i = 0; i < bins; ++i) {
    const std::string key = "angle:" + std::to_string(i);
    words.expect(key);
    headings.push_back(words.number(key, {0.0, 2.0 * kPi}, "rad"));
    if (i > 0 && headings[static_cast<size_t>(i)] <= headings[static_cast<size_t>(i - 1)])
      throw words.error(key + " is not greater than the angle before it");
  }
  return headings;
}

bool startsWith(std::string_view word, std::string_view begin) {
  return word.substr(0, begin.size()) == begin;
}

void readHeader(Words& words, PrimitiveFile& file) {
  words.expect("resolution_m:");
  file.resolution = words.number("resolution_m", {1e-3, 100.0}, "m");
  if (words.peek() == "min_turning_radius_m:") {
    words.expect("min_turning_radius_m:");
    words.number("min_turning_radius_m", {0.0, 1e6}, "m");
  }
  const int bins = readInt(words, "numberofangles", 1, kMostBins);
  const bool stated = startsWith(words.peek(), "angle:");
  file.headings = stated ? statedHeadings(words, bins) : evenHeadings(bins);
}

Pose2 readPose(Words& words) {
  const double x = words.number("a pose's x", {-kFarthestPose, kFarthestPose}, "m");
  const double y = words.number("a pose's y", {-kFarthestPose, kFarthestPose}, "m");
  return {x, y, words.number("a pose's heading", {-kMostTurn, kMostTurn}, "rad")};
}

/// Bins may be written as one turn more or less.
int wrapBin(int bin, int bins) {
  return (bin % bins + bins) % bins;
}

bool isNear(const Pose2& pose, double x, double y, double resolution) {
  // Numbers in files are rounded to a tenth of a millimetre.
  const double reach = resolution / 2.0 + 1e-4;
  return std::abs(pose.x - x) <= reach && std::abs(pose.y - y) <= reach;
}

void checkEnds(const Words& words, const Primitive& primitive, const PrimitiveFile& file) {
  const auto refuse = [&](const std::string& what) {
    throw words.error(what + " by more than half a cell or bin");
  };
  const Pose2& first = primitive.poses.front();
  if (!isNear(first, 0.0, 0.0, file.resolution) ||
      nearestBin(file.headings, first.yaw) != primitive.start_bin)
    refuse("its first pose misses the start");
  const Pose2& last = primitive.poses.back();
  if (!isNear(last, primitive.dx * file.resolution, primitive.dy * file.resolution,
              file.resolution) ||
      nearestBin(file.headings, last.yaw) != primitive.end_bin)
    refuse("its last pose misses endpose_c");
  if (primitive.dx == 0 && primitive.dy == 0 && primitive.end_bin == primitive.start_bin)
    throw words.error("it neither moves nor turns");
}

Primitive readPrimitive(Words& words, const PrimitiveFile& file) {
  const int bins = static_cast<int>(file.headings.size());
  Primitive primitive;
  primitive.id = readInt(words, "primID", 0, kMostPrimitives);
  primitive.start_bin = readInt(words, "startangle_c", 0, bins - 1);
  primitive.dx = readInt(words, "endpose_c", -kFarthest, kFarthest);
  primitive.dy = static_cast<int>(words.integer("endpose_c's y", -kFarthest, kFarthest));
  primitive.end_bin = wrapBin(
      static_cast<int>(words.integer("endpose_c's heading bin", -bins, 2 * bins - 1)), bins);
  primitive.cost_multiplier = readInt(words, "additionalactioncostmult", 1, kDearest);
  if (words.peek() == "turning_radius:") {
    words.expect("turning_radius:");
    words.number("turning_radius", {-1e9, 1e9}, "m");
  }
  const int poses = readInt(words, "intermediateposes", 2, kMostPoses);
  for (int i = 0; i < poses; ++i) primitive.poses.push_back(readPose(words));
  checkEnds(words, primitive, file);
  return primitive;
}

}  // namespace

int nearestBin(const std::vector<double>& headings, double yaw) {
  size_t nearest = 0;
  for (size_t i = 1; i < headings.size(); ++i)
    if (std::abs(wrapAngle(yaw - headings[i])) < std::abs(wrapAngle(yaw - headings[nearest])))
      nearest = i;
  return static_cast<int>(nearest);
}

PrimitiveFile parsePrimitives(std::string text, const std::string& name) {
  Words words(std::move(text), name);
  PrimitiveFile file;
  file.name = name;
  readHeader(words, file);
  const int count = readInt(words, "totalnumberofprimitives", 1, kMostPrimitives);
  for (int i = 0; i < count; ++i) {
    words.inside("primitive " + std::to_string(i + 1) + " of " + std::to_string(count));
    file.primitives.push_back(readPrimitive(words, file));
  }
  words.inside("");
  if (!words.atEnd())
    throw words.error("more follows behind the last of " + std::to_string(count) + " primitives");
  return file;
}

PrimitiveFile readPrimitives(const std::string& path) {
  return parsePrimitives(readWhole(path), path);
}

}  // namespace tread::plan
