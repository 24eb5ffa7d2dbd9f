// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/planner_config.hpp"

#include <algorithm>

#include "common/vehicle/robot_file.hpp"

namespace tread::planner {
namespace {

/// What plans keep free is the robot's; logs from before robots were described in a file of their
/// own have it here.
FootprintSize footprintOf(ConfigReader& reader) {
  return reader.has("footprint") ? readFootprint(reader.section("footprint"))
                                 : readRobot(reader).footprint;
}

void readMargins(ConfigReader reader, Margins& margins) {
  reader.number("check", margins.check, {0.0, 1.0}, "m");
  reader.number("plan", margins.plan, {0.0, 1.0}, "m");
  reader.number("growth", margins.growth, {0.0, 3.0}, "1");
  reader.number("largest", margins.largest, {0.0, 2.0}, "m");
  reader.number("regain", margins.regain, {0.0, 1.0}, "1");
  if (margins.check > margins.plan) throw reader.error("check", "must not be more than plan");
  if (margins.largest < margins.plan) throw reader.error("largest", "must not be less than plan");
}

void readMap(ConfigReader reader, PlanningMapConfig& map) {
  reader.number("keep_radius", map.clearance.keep_radius, {10.0, 500.0}, "m");
  reader.flag("unknown_blocks", map.unknown_blocks);
}

void readField(ConfigReader reader, DistanceFieldConfig& field) {
  reader.number("tight_weight", field.tight_weight, {0.0, 20.0}, "1");
  reader.number("max_distance", field.max_distance, {10.0, 1000.0}, "m");
}

void readSearch(ConfigReader reader, SearchConfig& search) {
  reader.number("horizon", search.horizon, {1.0, 60.0}, "s");
  reader.number("reverse_penalty", search.reverse_penalty, {0.0, 20.0}, "1");
  reader.number("near_penalty", search.near_penalty, {0.0, 20.0}, "1");
}

/// The limits can be made stricter, or a little wider; none can be switched off.
void readAges(ConfigReader reader, AgeLimits& ages) {
  reader.seconds("pose", ages.pose, {0.02, 0.3});
  reader.seconds("bridge", ages.bridge, {0.1, 1.0});
  reader.seconds("map_slow", ages.map_slow, {0.2, 5.0});
  reader.seconds("map_stop", ages.map_stop, {0.5, 10.0});
  reader.seconds("pattern_set", ages.pattern_set, {2.5, 30.0});
}

}  // namespace

PlannerConfig readLoggedPlannerConfig(ConfigReader& reader) {
  PlannerConfig config;
  PlanningMapConfig& map = config.map;
  map.footprint = footprintOf(reader);
  map.field.inflation = map.footprint.half_width;
  map.clearance.clearance_cap =
      std::max(map.clearance.clearance_cap, 1.5 * map.footprint.half_width);
  readMargins(reader.section("margins"), map.margins);
  readMap(reader.section("map"), map);
  readField(reader.section("field"), map.field);
  readSearch(reader.section("search"), config.search);
  ConfigReader policy = reader.section("policy");
  policy.seconds("patience", config.policy.patience, {2.0, 600.0});
  reader.flag("come_close", map.come_close);
  ConfigReader commitment = reader.section("commitment");
  commitment.number("gain", config.side_hysteresis.gain, {0.0, 60.0}, "s");
  readAges(reader.section("ages"), config.ages);
  reader.seconds("deadline", config.deadline, {0.005, 0.045});
  const Margins& margins = map.margins;
  config.sweep = resolutionFor(map.footprint, std::max(margins.plan, margins.largest), {});
  config.effective = reader.effective();
  return config;
}

PlannerConfig readPlannerConfig(ConfigReader& reader) {
  PlannerConfig config = readLoggedPlannerConfig(reader);
  reader.finish();
  return config;
}

}  // namespace tread::planner
