// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/mapping_node.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <sstream>

#include "common/geometry/se2.hpp"
#include "common/messages/blank.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/vehicle/robot_description.hpp"

namespace tread::mapping {
namespace {

std::string metres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", length);
  return text;
}

void readGrid(ConfigReader& reader, OccupancyMapConfig& map) {
  int64_t tile_cells = map.tile_cells;
  int64_t window_tiles = map.window_tiles;
  reader.number("cell_size", map.voxels.cell_size, {kFinestCell, kCoarsestCell}, "m");
  reader.integer("tile_cells", tile_cells, {8, 128}, "cells");
  reader.integer("window_tiles", window_tiles, {2, 32}, "tiles");
  if (tile_cells % GroundMap::kPatchCells != 0)
    throw reader.error("tile_cells", "must be a multiple of 8");
  if (tile_cells * window_tiles > 1024)
    throw reader.error("window_tiles", "window_tiles x tile_cells must not be above 1024 cells");
  map.tile_cells = static_cast<int>(tile_cells);
  map.window_tiles = static_cast<int>(window_tiles);
}

/// Whole cells within which the robot can turn on the spot, with a margin of 0.2 m [m].
double turningRadius(const OccupancyMapConfig& map) {
  const double cells = (Footprint(map.robot, 0.0).circumscribed() + 0.2) / map.voxels.cell_size;
  return std::ceil(cells) * map.voxels.cell_size;
}

void takeRobot(const RobotDescription& robot, OccupancyMapConfig& map) {
  map.robot = robot.outline;
  map.obstacle.robot_height = robot.height;
  map.start_free_radius = turningRadius(map);
}

void checkRobot(const ConfigReader& reader, const RobotDescription& robot,
                const OccupancyMapConfig& map) {
  if (robot.height <= map.obstacle.step)
    throw reader.error("step",
                       "must be below the robot's height of " + metres(robot.height) + " m");
  const double highest = kVoxelsAboveGround * map.voxels.cell_size;
  if (robot.height > highest)
    throw reader.error("cell_size", "a robot of " + metres(robot.height) +
                                        " m needs larger cells: the map keeps " +
                                        std::to_string(kVoxelsAboveGround) +
                                        " of them above the ground, which is " + metres(highest) +
                                        " m");
}

void readMap(ConfigReader& reader, OccupancyMapConfig& map) {
  reader.number("marking_range", map.marking_range, {0.5, 100.0}, "m");
  reader.number("clearing_range", map.clearing_range, {0.5, 100.0}, "m");
  reader.number("start_free_radius", map.start_free_radius, {0.0, 20.0}, "m");
  reader.number("step", map.obstacle.step, {0.02, 1.0}, "m");
  ConfigReader evidence = reader.section("evidence");
  evidence.number("hit", map.voxels.hit, {0.51, 0.99}, "");
  evidence.number("miss", map.voxels.miss, {0.01, 0.49}, "");
  evidence.number("clamp_min", map.voxels.clamp_min, {0.01, 0.49}, "");
  evidence.number("clamp_max", map.voxels.clamp_max, {0.51, 0.99}, "");
  ConfigReader roughness = reader.section("roughness");
  roughness.number("range_noise", map.roughness.range_noise, {0.0, 0.2}, "m, 0 = not looked at");
  if (map.roughness.range_noise > 0.0 && map.tile_cells % RoughnessMap::kPatchCells != 0)
    throw reader.error("tile_cells", "must be a multiple of 16 where roughness is looked at");
  ConfigReader ground = reader.section("ground");
  ground.number("height_noise", map.ground.height_noise, {0.001, 1.0}, "m");
  ground.number("slope_noise", map.ground.slope_noise, {0.0, 1.0}, "");
  ground.number("curvature", map.ground.curvature, {0.0, 1.0}, "1/m");
  ground.number("slope_doubt", map.ground.slope_doubt, {0.0, 1.0}, "");
}

/// How long poses are kept [us]: longer than any scan waits.
constexpr int64_t kTrackSpan = 6'000'000;
/// Scans that may wait for poses at the same time; more means that no poses arrive.
constexpr size_t kMostWaiting = 20;
/// Largest number of range finders.
constexpr size_t kMostFinders = 8;
/// A message stamped further in the future comes from another clock [us].
constexpr int64_t kFarthestAhead = 200'000;
/// LCM loses data above 100 kB per publisher in 20 ms, which is this node's period.
constexpr size_t kBytesPerStep = 80'000;
constexpr size_t kTileOverhead = 80;

int64_t microseconds(double seconds) {
  return std::llround(seconds * 1e6);
}

size_t turnsPerCycle(const MappingConfig& config) {
  const double cycles = std::max(1.0, std::floor(config.refresh_period / config.publish_period));
  const double tiles = config.map.window_tiles * config.map.window_tiles;
  return static_cast<size_t>(std::ceil(tiles / cycles));
}

const char* reasonOf(OccupancyMap::Refusal refusal) {
  switch (refusal) {
    case OccupancyMap::Refusal::kNotNewer:
      return "not newer than the scan before";
    case OccupancyMap::Refusal::kToppled:
      return "robot lies on its side";
    case OccupancyMap::Refusal::kTooFar:
      return "too far from the origin of map";
    case OccupancyMap::Refusal::kNone:
      break;
  }
  return "";
}

}  // namespace

MappingConfig readMappingConfig(ConfigReader& reader) {
  MappingConfig config;
  readGrid(reader, config.map);
  const RobotDescription robot = readRobot(reader);
  takeRobot(robot, config.map);
  readMap(reader, config.map);
  checkRobot(reader, robot, config.map);
  config.top_speed = robot.max_speed;
  reader.number("publish_period", config.publish_period, {0.02, 2.0}, "s");
  reader.number("refresh_period", config.refresh_period, {0.2, 60.0}, "s");
  reader.number("max_ins_gap", config.max_ins_gap, {0.005, 2.0}, "s");
  reader.number("max_wait", config.max_wait, {0.02, 5.0}, "s");
  reader.number("silence", config.silence, {0.1, 60.0}, "s");
  reader.finish();
  config.effective = reader.effective();
  return config;
}

MappingNode::MappingNode(const MappingConfig& config, Bus& bus)
    : config_(config),
      bus_(bus),
      health_(bus, "mapping", config.effective),
      map_(std::make_unique<OccupancyMap>(config.map)),
      track_(kTrackSpan, config.top_speed),
      turns_(turnsPerCycle(config)),
      last_scan_(bus.now()),
      last_ins_(bus.now()),
      last_taken_(bus.now()) {
  health_.watchNamesakes();
  bus.subscribe<ins_t>(kIns, [this](const ins_t& message) { hear(message); });
  bus.subscribe<scan_t>(kScan, [this](const scan_t& message) { hear(message); });
}

/// A bus that follows the messages' time does not know it before the first one: silence is counted
/// from then on.
void MappingNode::startClock() {
  if (heard_) return;
  heard_ = true;
  last_scan_ = last_ins_ = last_taken_ = bus_.now();
}

void MappingNode::hear(const ins_t& message) {
  startClock();
  const auto T_map_body = spatialPose(message);
  if (!T_map_body) return health_.addToCounter("INS without pose");
  if (message.utime > bus_.now() + kFarthestAhead)
    return health_.addToCounter("INS refused: time is ahead");
  if (message.utime <= track_.newest()) return health_.addToCounter("INS refused: not newer");
  last_ins_ = bus_.now();
  if ((message.ins_status & ins_t::STATUS_JUMP) != 0) {
    track_.clear();
    beginNewMap();
  }
  const auto verdict = track_.push(message.utime, *T_map_body);
  if (verdict == SpatialTrack::PoseCheck::kDoubted) health_.addToCounter("INS doubted: far off");
  if (verdict == SpatialTrack::PoseCheck::kJump) beginNewMap();
}

void MappingNode::beginNewMap() {
  health_.addToCounter("new maps: INS jumped");
  map_ = std::make_unique<OccupancyMap>(config_.map);
  monitors_.clear();
  turns_.clear();
}

void MappingNode::hear(const scan_t& message) {
  startClock();
  last_scan_ = bus_.now();
  std::string reason;
  auto scan = readScan(message, reason);
  if (!scan) return refuse(reason);
  if (scan->last > bus_.now() + kFarthestAhead) return refuse("time is ahead");
  waiting_.push_back(std::move(*scan));
  if (waiting_.size() <= kMostWaiting) return;
  waiting_.pop_front();
  refuse("no INS at its time");
}

void MappingNode::refuse(const std::string& reason) {
  last_refusal_ = reason;
  health_.addToCounter("scans refused: " + reason);
}

void MappingNode::step(int64_t utime) {
  while (!waiting_.empty() && tryFirst(utime) == Fate::kDone) waiting_.pop_front();
  publishTiles(utime);
  reportHealth(utime);
  health_.step(utime);
}

MappingNode::Fate MappingNode::tryFirst(int64_t now) {
  const ReceivedScan& scan = waiting_.front();
  if (track_.newest() >= scan.last) {
    insert(scan);
    return Fate::kDone;
  }
  if (now - scan.last <= microseconds(config_.max_wait)) return Fate::kWaits;
  refuse("no INS at its time");
  return Fate::kDone;
}

void MappingNode::insert(const ReceivedScan& scan) {
  const int64_t max_gap = microseconds(config_.max_ins_gap);
  const auto first = track_.at(scan.first, max_gap);
  const auto last = track_.at(scan.last, max_gap);
  if (!first || !last) return refuse("gap in INS at its time");
  const Scan placed{scan.last, *first, *last, scan.T_body_sensor, scan.beams};
  ScanMonitor& monitor = monitorOf(scan.T_body_sensor);
  const ScanDefect defect = monitor.update(
      {placed, scan.fingerprint}, [&](int64_t utime) { return track_.at(utime, max_gap); });
  if (monitor.verdict() != ScanDefect::kNone) return refuse("range finder not believed");
  if (defect != ScanDefect::kNone) return refuse("in doubt");
  const auto refusal = map_->insert(placed);
  if (refusal != OccupancyMap::Refusal::kNone) return refuse(reasonOf(refusal));
  last_taken_ = bus_.now();
  health_.addToCounter("scans taken");
}

ScanMonitor& MappingNode::monitorOf(const Eigen::Isometry3d& T_body_sensor) {
  for (auto& [T_known, monitor] : monitors_)
    if (T_known.isApprox(T_body_sensor, 1e-6)) return monitor;
  // Broken messages may contain any mounting.
  if (monitors_.size() >= kMostFinders) monitors_.clear();
  const OccupancyMapConfig& map = config_.map;
  monitors_.emplace_back(T_body_sensor, ScanMonitor(map.robot, map.obstacle.robot_height));
  return monitors_.back().second;
}

/// What is wrong with a distrusted range finder, in one line; empty if all are trusted.
std::string MappingNode::lyingFinder() const {
  for (const auto& [T_body_sensor, monitor] : monitors_) {
    if (monitor.verdict() == ScanDefect::kNone) continue;
    const Eigen::Vector3d& p_body = T_body_sensor.translation();
    return "range finder at " + metres(p_body.x()) + ", " + metres(p_body.y()) + ", " +
           metres(p_body.z()) + " m: " + monitor.words();
  }
  return "";
}

void MappingNode::publishTiles(int64_t utime) {
  if (utime >= next_cycle_) {
    next_cycle_ = utime + microseconds(config_.publish_period);
    turns_.begin(map_->seenTiles(), map_->takeChangedTiles());
  }
  const auto side = static_cast<size_t>(config_.map.tile_cells);
  const size_t most = std::max<size_t>(1, kBytesPerStep / (side * side + kTileOverhead));
  for (size_t sent = 0; sent < most && !turns_.empty(); ++sent) send(turns_.take());
}

void MappingNode::send(CellIndex index) {
  Tile tile = map_->tile(index);
  auto message = blank<map_tile_t>();
  message.utime = tile.utime;
  message.seq = seq_++;
  message.tile_x = tile.tile_x;
  message.tile_y = tile.tile_y;
  message.tile_cells = config_.map.tile_cells;
  message.cell_size = config_.map.voxels.cell_size;
  message.num_cells = static_cast<int32_t>(tile.cells.size());
  message.cells = std::move(tile.cells);
  bus_.publish(kMap, message);
}

void MappingNode::reportHealth(int64_t now) {
  const std::string lie = lyingFinder();
  if (!lie.empty()) return health_.fail(lie);
  const int64_t silence = microseconds(config_.silence);
  if (now - last_taken_ < silence) return health_.setState(health_t::HEALTH_OK, "");
  std::ostringstream line;
  line << "no scan went into the map for " << (now - last_taken_) / 1'000'000 << " s: ";
  if (now - last_scan_ >= silence) {
    line << "no SCAN comes; is lidar_driver running?";
  } else if (now - last_ins_ >= silence) {
    line << "no INS with a pose comes; is ins_driver running, has it a fix and a heading?";
  } else {
    line << (last_refusal_.empty() ? "none was complete" : last_refusal_);
  }
  health_.setState(health_t::HEALTH_DEGRADED, line.str());
}

}  // namespace tread::mapping
