// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/planner_config.hpp"

#include <algorithm>

#include "common/vehicle/robot_file.hpp"

namespace tread::planner {
namespace {

void count(ConfigReader& reader, const std::string& key, int& value, Range range) {
  int64_t wide = value;
  reader.integer(key, wide, range, "1");
  value = static_cast<int>(wide);
}

/// What plans keep free is the robot's; logs from before robots were described in a file of their
/// own have it here.
FootprintSize footprintOf(ConfigReader& reader) {
  const tread::FootprintSize size = reader.has("footprint")
                                        ? readFootprint(reader.section("footprint"))
                                        : readRobot(reader).footprint;
  return {size.front, size.rear, size.half_width};
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

void readMap(ConfigReader reader, LocalMapConfig& local_map) {
  reader.number("window", local_map.window, {5.0, 100.0}, "m");
  reader.seconds("window_period", local_map.window_period, {0.02, 0.5});
  reader.number("keep_radius", local_map.clearance.keep_radius, {10.0, 500.0}, "m");
  reader.number("room_cap", local_map.clearance.clearance_cap, {0.1, 5.0}, "m");
  count(reader, "coarse", local_map.clearance.coarse, {1, 8});
  reader.flag("unknown_blocks", local_map.unknown_blocks);
}

void readField(ConfigReader reader, LocalMapConfig& local_map) {
  DistanceFieldConfig& field = local_map.field;
  field.inflation = local_map.footprint.half_width;
  reader.number("inflation", field.inflation, {0.0, 5.0}, "m");
  reader.number("wide", field.wide, {0.0, 5.0}, "m");
  reader.number("tight_weight", field.tight_weight, {0.0, 20.0}, "1");
  reader.number("detour_weight", field.detour_weight, {0.0, 100.0}, "1");
  reader.number("area_margin", field.area_margin, {2.0, 100.0}, "m");
  reader.number("max_area", field.max_area, {20.0, 1000.0}, "m");
  reader.number("max_distance", field.max_distance, {10.0, 1000.0}, "m");
  reader.number("reach", field.reach, {5.0, 100.0}, "m");
  reader.seconds("period", local_map.field_period, {0.05, 10.0});
}

void readSearch(ConfigReader reader, SearchConfig& search) {
  reader.number("cell", search.cell, {0.02, 1.0}, "m");
  count(reader, "heading_bins", search.heading_bins, {8, 255});
  reader.number("distance_share", search.distance_share, {0.1, 1.0}, "1");
  reader.number("heuristic_weight", search.heuristic_weight, {1.0, 10.0}, "1");
  reader.number("turn_weight", search.turn_weight, {0.0, 5.0}, "1");
  count(reader, "improvements", search.improvements, {0, 10});
  reader.number("reverse_penalty", search.reverse_penalty, {0.0, 20.0}, "1");
  reader.number("stop_penalty", search.stop_penalty, {0.0, 20.0}, "s");
  reader.number("turn_penalty", search.turn_penalty, {0.0, 20.0}, "s/rad");
  reader.number("near_penalty", search.near_penalty, {0.0, 20.0}, "1");
  reader.number("near_distance", search.near_distance, {0.05, 5.0}, "m");
  reader.number("unknown_penalty", search.unknown_penalty, {0.0, 20.0}, "1");
  reader.number("switch_penalty", search.switch_penalty, {0.0, 20.0}, "s");
  reader.number("horizon", search.horizon, {1.0, 60.0}, "s");
  reader.number("least_rate", search.least_rate, {0.0, 1.0}, "1");
  reader.number("frontier", search.frontier, {0.5, 20.0}, "m");
  reader.number("least_progress", search.least_progress, {0.0, 10.0}, "s");
  count(reader, "escape_patterns", search.escape_patterns, {0, 10});
  reader.number("goal_share", search.goal_share, {0.1, 1.0}, "1");
}

void readPolicy(ConfigReader reader, PolicyConfig& policy) {
  reader.seconds("plan_period", policy.plan_period, {0.05, 2.0});
  reader.seconds("blocked_period", policy.blocked_period, {0.05, 10.0});
  reader.seconds("freeze", policy.freeze, {0.05, 1.0});
  reader.seconds("stop_lead", policy.stop_lead, {0.1, 5.0});
  reader.number("coast_time", policy.coast_time, {0.0, 3.0}, "s");
  reader.seconds("settle_limit", policy.settle_limit, {0.5, 30.0});
  reader.seconds("patience", policy.patience, {2.0, 600.0});
  reader.seconds("recovery_wait", policy.recovery_wait, {0.1, 60.0});
  count(reader, "recoveries", policy.recoveries, {0, 100});
  count(reader, "detours", policy.detours, {0, 100});
  count(reader, "driving_expansions", policy.driving_expansions, {100, 1e6});
  count(reader, "standing_expansions", policy.standing_expansions, {100, 1e6});
}

void readCommitment(ConfigReader reader, SideHysteresisConfig& side_hysteresis) {
  reader.number("gain", side_hysteresis.gain, {0.0, 60.0}, "s");
  reader.number("turn", side_hysteresis.turn, {0.01, 3.0}, "rad");
  reader.number("ahead", side_hysteresis.ahead, {0.0, 30.0}, "s");
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

PlannerConfig readPlannerConfig(ConfigReader& reader) {
  PlannerConfig config;
  config.local_map.footprint = footprintOf(reader);
  readMargins(reader.section("margins"), config.local_map.margins);
  readMap(reader.section("map"), config.local_map);
  readField(reader.section("field"), config.local_map);
  readSearch(reader.section("search"), config.search);
  readPolicy(reader.section("policy"), config.policy);
  reader.flag("come_close", config.local_map.come_close);
  readCommitment(reader.section("commitment"), config.side_hysteresis);
  readAges(reader.section("ages"), config.ages);
  ConfigReader sweep = reader.section("sweep");
  sweep.number("distance", config.sweep.distance, {0.01, 0.5}, "m");
  sweep.number("turn", config.sweep.turn, {0.01, 0.5}, "rad");
  const Margins& margins = config.local_map.margins;
  config.sweep = resolutionFor(config.local_map.footprint, std::max(margins.plan, margins.largest),
                               config.sweep);
  reader.number("default_sigma", config.default_sigma.position, {0.0, 1.0}, "m");
  reader.number("default_yaw_sigma", config.default_sigma.yaw, {0.0, 1.0}, "rad");
  reader.seconds("lease", config.lease, {0.1, 0.2});
  reader.seconds("deadline", config.deadline, {0.005, 0.045});
  reader.finish();
  config.effective = reader.effective();
  return config;
}

}  // namespace tread::planner
