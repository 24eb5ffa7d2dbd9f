// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/missions/given_worlds.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "common/config/config_reader.hpp"
#include "common/config/foreign_text.hpp"
#include "common/config/scalars.hpp"
#include "common/log/unpacked_file.hpp"
#include "common/recordings/csv_table.hpp"
#include "modules/simulator/simulator_files.hpp"
#include "tools/lab/missions/world_kind.hpp"

namespace tread::missions {
namespace {

using Eigen::Vector2d;

constexpr double kPlain = 1000.0;  ///< [m] all coordinates of a world must be within it
/// Margin around everything in a world [m].
constexpr double kBorder = 10.0;
/// Height of the discs, above any range finder [m].
constexpr double kDiscHeight = 1.0;
/// Reference speed of the metric [m/s].
constexpr double kMetricSpeed = 2.0;

/// Start and goal of a run; by default those of the BARN benchmark.
struct Course {
  Pose2 start{-2.25, 3.0, kPi / 2.0};
  Vector2d goal{-2.25, 13.0};
  TimedRun timed;
};

MissionWorld worldOf(const Course& course, sim::WorldDescription description, double path) {
  MissionWorld world;
  world.T_map_start = course.start;
  world.T_map_goal = {course.goal.x(), course.goal.y(), 0.0};
  world.straight_line = (course.goal - course.start.position()).norm();
  world.timed = course.timed;
  world.timed->path = path > 0.0 ? path : world.straight_line;
  world.description = std::move(description);
  return world;
}

/// Bounding box of the course and all discs.
sim::Extent boundsOf(const Course& course, const std::vector<sim::Obstacle>& discs) {
  sim::Extent bounds = sim::extentOf({course.start.position(), course.goal});
  for (const sim::Obstacle& disc : discs) {
    const sim::Extent extent = sim::extentOf(disc);
    bounds.low = bounds.low.cwiseMin(extent.low);
    bounds.high = bounds.high.cwiseMax(extent.high);
  }
  bounds.low.array() -= kBorder;
  bounds.high.array() += kBorder;
  return bounds;
}

/// Lengths of reference paths [m] by world; empty if there is no table.
std::map<std::string, double> pathsBeside(const std::string& file) {
  std::map<std::string, double> paths;
  const auto index = std::filesystem::path(file).parent_path() / "index.csv";
  if (!std::filesystem::exists(index)) return paths;
  const recordings::CsvTable table(index.string());
  table.require({"world", "path_m"});
  for (size_t row = 0; row < table.rows(); ++row)
    paths[table.text(row, "world")] = table.numberWithin(row, "path_m", 0.1, kPlain);
  return paths;
}

/// Reads lines "world x y radius".
class DiscFile {
 public:
  explicit DiscFile(const std::string& file) : file_(file) {}

  std::vector<MissionWorld> read(const Course& course) {
    const UnpackedFile unpacked(file_);
    std::ifstream lines(unpacked.path());
    if (!lines) throw ConfigError(file_ + ": cannot be read; give a file of worlds");
    if (!unpacked.problem().empty()) throw ConfigError(unpacked.problem());
    for (std::string line; std::getline(lines, line);) take(line);
    if (worlds_.empty())
      throw ConfigError(file_ + ": contains no world; lines are \"world x y radius\" in metres");
    const std::map<std::string, double> paths = pathsBeside(file_);
    std::vector<MissionWorld> worlds;
    for (sim::WorldDescription& world : worlds_) {
      const auto path = paths.find(world.name);
      world.bounds = boundsOf(course, world.obstacles);
      worlds.push_back(worldOf(course, world, path == paths.end() ? 0.0 : path->second));
    }
    return worlds;
  }

 private:
  void take(const std::string& line) {
    ++line_;
    std::istringstream words(line.substr(0, line.find('#')));
    std::string name;
    if (!(words >> name)) return;
    const double x = number(words, -kPlain), y = number(words, -kPlain),
                 radius = number(words, 0.0);
    std::string more;
    if (radius <= 0.0 || words >> more) fail();
    const auto [place, is_new] = by_name_.emplace(name, worlds_.size());
    if (is_new) {
      worlds_.emplace_back();
      worlds_.back().name = name;
      worlds_.back().base_surface = "tarmac";
    }
    worlds_[place->second].obstacles.push_back(sim::discObstacle({x, y}, radius, kDiscHeight));
  }

  double number(std::istringstream& words, double lowest) const {
    std::string word;
    words >> word;
    const std::optional<double> value = parseForeignNumber(word);
    if (!value || *value < lowest || *value > kPlain) fail();
    return *value;
  }

  [[noreturn]] void fail() const {
    throw ConfigError(
        file_ + ":" + std::to_string(line_) +
        ": is not \"world x y radius\" in metres, the radius above 0, all below 1000");
  }

  std::string file_;
  int line_ = 0;
  std::vector<sim::WorldDescription> worlds_;
  std::map<std::string, size_t> by_name_;
};

Course readCourse(ConfigReader& reader, Course course) {
  constexpr Range kPlace{-kPlain, kPlain};
  std::vector<double> start{course.start.x, course.start.y, course.start.yaw};
  std::vector<double> goal{course.goal.x(), course.goal.y()};
  reader.numbers("start", start, 3, kPlace, "m m rad");
  reader.numbers("goal", goal, 2, kPlace, "m");
  reader.number("tolerance", course.timed.tolerance, {0.05, 100.0}, "m");
  reader.number("limit", course.timed.limit, {1.0, 100000.0}, "s");
  course.start = {start[0], start[1], start[2]};
  course.goal = {goal[0], goal[1]};
  return course;
}

std::vector<MissionWorld> readListed(const std::string& file) {
  ConfigReader reader = ConfigReader::fromFile(file);
  const Course course = readCourse(reader, {});
  std::vector<MissionWorld> worlds;
  std::string discs;
  reader.path("discs", discs);
  if (!discs.empty()) worlds = DiscFile(discs).read(course);
  for (ConfigReader& entry : reader.sections("worlds")) {
    std::string name = std::to_string(worlds.size());
    entry.text("name", name);
    const Course own = readCourse(entry, course);
    double path = 0.0;
    entry.number("path", path, {0.1, kPlain}, "m");
    sim::WorldDescription description = sim::readWorld(entry.file("world", "world.yaml"));
    description.name = name;
    worlds.push_back(worldOf(own, std::move(description), path));
  }
  if (worlds.empty()) throw reader.error("worlds", "contains no world; give worlds or discs");
  reader.finish();
  return worlds;
}

bool isYaml(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".yaml" || extension == ".yml";
}

std::vector<MissionWorld> wantedOf(std::vector<MissionWorld> all, const std::string& file,
                                   const std::vector<std::string>& only) {
  if (only.empty()) return all;
  std::vector<MissionWorld> wanted;
  for (const std::string& name : only) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const MissionWorld& world) {
      return world.description.name == name;
    });
    if (found == all.end())
      throw ConfigError("--only " + name + ": " + file + " has no world of that name; it has " +
                        all.front().description.name + " to " + all.back().description.name);
    wanted.push_back(*found);
  }
  return wanted;
}

}  // namespace

sim::SurfaceParameters surfaceOf(const GivenGround& ground) {
  const std::string like = ground.surface.empty() ? "ice" : ground.surface;
  std::vector<sim::SurfaceParameters> known = sim::builtInSurfaces();
  for (const sim::SurfaceParameters& surface : surfacesOfKinds()) known.push_back(surface);
  const auto named = [&](const sim::SurfaceParameters& surface) { return surface.name == like; };
  const auto found = std::find_if(known.begin(), known.end(), named);
  if (found == known.end()) {
    std::set<std::string> names;
    for (const sim::SurfaceParameters& surface : known) names.insert(surface.name);
    throw ConfigError("--surface " + like + ": no such ground; there are " +
                      joinWords({names.begin(), names.end()}));
  }
  sim::SurfaceParameters surface = *found;
  if (!ground.friction) return surface;
  surface.friction = *ground.friction;
  surface.name += " of friction " + formatNumber(*ground.friction);
  return surface;
}

std::vector<MissionWorld> readGivenWorlds(const std::string& file,
                                          const std::vector<std::string>& only,
                                          const GivenGround& ground) {
  std::vector<MissionWorld> all = isYaml(file) ? readListed(file) : DiscFile(file).read({});
  for (size_t i = 0; i < all.size(); ++i) all[i].seed = i;
  std::vector<MissionWorld> worlds = wantedOf(std::move(all), file, only);
  if (ground.empty()) return worlds;
  const sim::SurfaceParameters surface = surfaceOf(ground);
  for (MissionWorld& world : worlds) {
    world.description.base_surface = surface.name;
    world.description.regions.clear();
    world.description.surfaces.push_back(surface);
  }
  return worlds;
}

double navigationMetric(const MissionResult& result) {
  if (!result.timed || result.outcome != MissionOutcome::kArrived) return 0.0;
  const double best = result.timed->path / kMetricSpeed;
  return best / std::clamp(result.clock, 2.0 * best, 8.0 * best);
}

}  // namespace tread::missions
