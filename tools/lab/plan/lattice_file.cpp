// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/plan/lattice_file.hpp"

#include <cmath>

#include "common/config/config_reader.hpp"
#include "common/config/scalars.hpp"
#include "tools/lab/plan/primitives.hpp"

namespace tread::plan {
namespace {

constexpr double kMostReach = 1e3;  // [m]

/// The poses of a moving primitive begin after its start: adds the start.
void addStart(const PrimitiveFile& file, LatticePrimitive& primitive) {
  const Pose2 start{0.0, 0.0, file.headings[static_cast<size_t>(primitive.start_bin)]};
  const Pose2& first = primitive.poses.front();
  if (std::hypot(first.x, first.y) > 1e-4 || std::abs(wrapAngle(first.yaw - start.yaw)) > 1e-4)
    primitive.poses.insert(primitive.poses.begin(), start);
}

LatticePrimitive readPrimitive(ConfigReader& reader, const PrimitiveFile& file) {
  const Range bins{0.0, static_cast<double>(file.headings.size()) - 1.0};
  int64_t id = 0;
  int64_t start = 0;
  int64_t end = 0;
  reader.integer("trajectory_id", id, {0.0, 1e6}, "", true);
  reader.integer("start_angle_index", start, bins, "", true);
  reader.integer("end_angle_index", end, bins, "", true);
  std::vector<std::vector<double>> poses;
  reader.table("poses", poses, 3, {-kMostReach, kMostReach}, "m, m, rad", true);
  if (poses.empty()) throw reader.error("poses", "none are there");
  LatticePrimitive primitive;
  primitive.id = static_cast<int>(id);
  primitive.start_bin = static_cast<int>(start);
  primitive.end_bin = static_cast<int>(end);
  for (const auto& pose : poses) primitive.poses.push_back({pose[0], pose[1], pose[2]});
  primitive.dx = static_cast<int>(std::lround(poses.back()[0] / file.resolution));
  primitive.dy = static_cast<int>(std::lround(poses.back()[1] / file.resolution));
  addStart(file, primitive);
  if (const std::string problem = endsProblem(primitive, file); !problem.empty())
    throw reader.error("poses", problem);
  return primitive;
}

/// Counts in the file must match its content.
void checkCount(ConfigReader& reader, const char* key, size_t found, const char* of) {
  if (!reader.has(key)) return;
  int64_t count = 0;
  reader.integer(key, count, {0.0, 1e9}, "");
  if (count != static_cast<int64_t>(found))
    throw reader.error(key, "says " + std::to_string(count) + ", but there are " +
                                std::to_string(found) + " " + of +
                                "; is the file cut off or edited? Generate it again");
}

}  // namespace

PrimitiveFile readLattice(const std::string& path) {
  ConfigReader reader = ConfigReader::fromFile(path);
  PrimitiveFile file;
  file.name = path;
  ConfigReader about = reader.section("lattice_metadata", true);
  about.number("grid_resolution", file.resolution, {1e-3, 100.0}, "m", true);
  about.numbers("heading_angles", file.headings, 0, {0.0, 2.0 * kPi}, "rad", true);
  for (size_t i = 1; i < file.headings.size(); ++i)
    if (file.headings[i] <= file.headings[i - 1])
      throw about.error("heading_angles", "must rise from each to the next");
  if (file.headings.empty()) throw about.error("heading_angles", "none are there");
  for (ConfigReader& primitive : reader.sections("primitives", true))
    file.primitives.push_back(readPrimitive(primitive, file));
  checkCount(about, "num_of_headings", file.headings.size(), "headings");
  checkCount(about, "number_of_trajectories", file.primitives.size(), "primitives");
  return file;
}

}  // namespace tread::plan
