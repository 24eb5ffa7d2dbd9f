// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/plan/plan_task.hpp"

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "common/config/config_reader.hpp"
#include "common/config/scalars.hpp"
#include "common/grid/footprint.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/store/store.hpp"
#include "tools/plan/query_file.hpp"

namespace tread::plan {
namespace {

constexpr double kDeadline = 1000.0;  // [ms]

/// Numbers with commas between, as many as `form` has names.
std::vector<double> readList(const std::string& option, const std::string& text,
                             const std::string& form, size_t count, Range range) {
  std::vector<double> values;
  for (size_t from = 0; from <= text.size();) {
    const size_t comma = std::min(text.find(',', from), text.size());
    const auto value = parseNumber(text.substr(from, comma - from));
    if (!value || *value < range.min || *value > range.max) break;
    values.push_back(*value);
    from = comma + 1;
    if (comma == text.size() && values.size() == count) return values;
  }
  throw std::runtime_error(option + " is " + formatText(text.substr(0, 60)) + "; " + form +
                           " is needed, each " + formatNumber(range.min) + ".." +
                           formatNumber(range.max));
}

std::optional<Pose2> readPose(const std::string& option, const std::string& text,
                              const std::optional<Pose2>& otherwise) {
  if (text.empty()) return otherwise;
  const auto values = readList(option, text, "x,y,yaw [m, m, rad]", 3, {-1e6, 1e6});
  return Pose2{values[0], values[1], values[2]};
}

RobotShape readShape(const PlanOptions& options, const MapFile& map) {
  if (!options.footprint.empty() && options.radius)
    throw std::runtime_error("--footprint and --radius exclude each other");
  if (!options.footprint.empty()) {
    const auto size =
        readList("--footprint", options.footprint, "LENGTH,WIDTH [m]", 2, {1e-3, 100.0});
    return {size[0], size[1], 0.0};
  }
  if (!options.radius && map.costs.empty())
    throw std::runtime_error(
        "the map says nothing of the robot; give --footprint LENGTH,WIDTH or --radius (0 = a "
        "point)");
  return {0.0, 0.0, options.radius.value_or(0.0)};
}

bool evenlySpaced(const PrimitiveFile& file) {
  const double bin = 2.0 * kPi / static_cast<double>(file.headings.size());
  for (size_t i = 0; i < file.headings.size(); ++i)
    if (std::abs(file.headings[i] - static_cast<double>(i) * bin) > 1e-3) return false;
  return true;
}

void checkExact(const PlanTask& task) {
  if (!task.primitives) throw std::runtime_error("--mprim-exact needs --patterns with a .mprim");
  if (!task.shape.isPoint())
    throw std::runtime_error("--mprim-exact plans for a point; leave --footprint and --radius out");
  if (task.map.costs.empty())
    throw std::runtime_error("--mprim-exact needs --map with an SBPL environment (.cfg)");
  if (!evenlySpaced(*task.primitives))
    throw std::runtime_error("--mprim-exact needs headings that are evenly spaced; those of " +
                             task.primitives->name + " are not");
  if (std::abs(task.primitives->resolution - task.grid.cellSize()) > 1e-9)
    throw std::runtime_error("--mprim-exact needs cells of one size; " + task.map.name + " has " +
                             formatNumber(task.grid.cellSize()) + " m, " + task.primitives->name +
                             " " + formatNumber(task.primitives->resolution) + " m");
}

void readPatterns(const PlanOptions& options, PlanTask& task) {
  const std::string extension = std::filesystem::path(options.patterns).extension().string();
  if (extension == ".mprim") {
    task.primitives = readPrimitives(options.patterns);
  } else {
    task.patterns = readPatternFile(options.patterns);
  }
  task.pace.speed = options.speed.value_or(task.map.nominal_speed.value_or(task.pace.speed));
  task.pace.turn_time =
      options.turn_time.value_or(task.map.turn_time.value_or(task.pace.turn_time));
}

std::vector<PlanQuery> drawQueries(const PlanOptions& options, const PlanTask& task) {
  const ClearanceField clearance(task.grid, true);
  const RandomQueries wanted{static_cast<size_t>(options.random), options.seed, options.apart};
  return randomQueries(task.grid, task.map.T_map_grid, wanted, [&](const Pose2& T_grid_body) {
    return standsFree(task, clearance, T_grid_body);
  });
}

std::vector<PlanQuery> theQuery(const PlanOptions& options, const MapFile& map) {
  const auto start = readPose("--start", options.start, map.T_map_start);
  const auto goal = readPose("--goal", options.goal, map.T_map_goal);
  if (!start || !goal)
    throw std::runtime_error("from where to where? Give --start and --goal, --queries or --random");
  return {{*start, *goal}};
}

void readWanted(const PlanOptions& options, PlanTask& task) {
  const bool random = options.random > 0;
  const bool single = !options.start.empty() || !options.goal.empty();
  if ((random ? 1 : 0) + (options.queries.empty() ? 0 : 1) + (single ? 1 : 0) > 1)
    throw std::runtime_error("--start and --goal, --queries and --random exclude each other");
  if (!options.write_queries.empty() && !random)
    throw std::runtime_error("--write-queries needs --random");
  task.many = random || !options.queries.empty();
  if (task.many && !options.picture.empty())
    throw std::runtime_error("--picture shows one plan; leave --queries and --random out");
  if (!task.many) {
    task.queries = theQuery(options, task.map);
  } else {
    task.queries = random ? drawQueries(options, task) : readQueries(options.queries);
  }
}

/// Nothing that is read may be written over.
void protectInputs(const PlanOptions& options, const MapFile& map) {
  checkOutputs({options.json, options.picture, options.write_queries},
               {options.map, map.image, options.patterns, options.queries});
}

}  // namespace

PlanTask loadTask(const PlanOptions& options) {
  PlanTask task;
  task.map = readMap(options.map);
  protectInputs(options, task.map);
  task.shape = readShape(options, task.map);
  task.grid = task.shape.isPoint() ? gridForPoint(task.map) : gridForFootprint(task.map);
  if (task.shape.radius > 0.0) task.grid = grownBy(task.grid, task.shape.radius);
  readPatterns(options, task);
  task.exact = options.exact;
  if (task.exact) checkExact(task);
  const auto tolerance =
      readList("--tolerance", options.tolerance, "METRES,RADIANS", 2, {1e-3, 1e3});
  task.position_tolerance = tolerance[0];
  task.yaw_tolerance = tolerance[1];
  task.come_close = options.come_close;
  if (task.come_close && task.exact)
    throw std::runtime_error("--come-close is for footprints; leave it out with --mprim-exact");
  task.deadline_ms = options.deadline_ms;
  if (!task.deadline_ms && !task.exact) task.deadline_ms = kDeadline;
  readWanted(options, task);
  if (!options.write_queries.empty())
    writeOutput(options.write_queries, formatQueries(task.queries), {});
  return task;
}

bool standsFree(const PlanTask& task, const ClearanceField& clearance, const Pose2& T_grid_body) {
  if (task.shape.isRectangle()) {
    const double half_length = task.shape.length / 2.0;
    const Footprint footprint({half_length, half_length, task.shape.width / 2.0}, 0.0);
    return footprint.isFree(clearance, turned(T_grid_body));
  }
  return isFree(task.grid.at(task.grid.indexOf(T_grid_body.position())));
}

}  // namespace tread::plan
