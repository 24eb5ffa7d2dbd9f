// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/mapping_node.hpp"

#include <cmath>
#include <sstream>

#include "common/messages/blank.hpp"
#include "common/messages/ins_messages.hpp"

namespace tread::mapping {
namespace {

/// Poses are kept for so long [us]: longer than any scan waits.
constexpr int64_t kTrackSpan = 6'000'000;
/// Scans that wait for poses at the same time; more means that the poses do not come.
constexpr size_t kMostWaiting = 20;
/// What comes from farther ahead has a foreign clock [us].
constexpr int64_t kFarthestAhead = 200'000;
/// LCM loses what a publisher sends above 100 kB in 20 ms, which is this node's period.
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

const char* reasonOf(LocalMap::Refusal refusal) {
  switch (refusal) {
    case LocalMap::Refusal::kNotNewer:
      return "not newer than the scan before";
    case LocalMap::Refusal::kToppled:
      return "robot lies on its side";
    case LocalMap::Refusal::kTooFar:
      return "too far from the origin of map";
    case LocalMap::Refusal::kNone:
      break;
  }
  return "";
}

}  // namespace

MappingNode::MappingNode(const MappingConfig& config, Bus& bus)
    : config_(config),
      bus_(bus),
      health_(bus, "mapping", config.effective),
      map_(std::make_unique<LocalMap>(config.map)),
      track_(kTrackSpan, config.top_speed),
      turns_(turnsPerCycle(config)),
      last_scan_(bus.now()),
      last_ins_(bus.now()),
      last_taken_(bus.now()) {
  bus.subscribe<ins_t>(kIns, [this](const ins_t& message) { hear(message); });
  bus.subscribe<scan_t>(kScan, [this](const scan_t& message) { hear(message); });
}

/// A bus that follows the messages' time does not know it before the first one: what counts silence
/// begins then.
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
  map_ = std::make_unique<LocalMap>(config_.map);
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
  const WaitingScan& scan = waiting_.front();
  if (track_.newest() >= scan.last) {
    insert(scan);
    return Fate::kDone;
  }
  if (now - scan.last <= microseconds(config_.max_wait)) return Fate::kWaits;
  refuse("no INS at its time");
  return Fate::kDone;
}

void MappingNode::insert(const WaitingScan& scan) {
  const int64_t max_gap = microseconds(config_.max_ins_gap);
  const auto first = track_.at(scan.first, max_gap);
  const auto last = track_.at(scan.last, max_gap);
  if (!first || !last) return refuse("gap in INS at its time");
  const auto refusal = map_->insert({scan.last, *first, *last, scan.T_body_sensor, scan.beams});
  if (refusal != LocalMap::Refusal::kNone) return refuse(reasonOf(refusal));
  last_taken_ = bus_.now();
  health_.addToCounter("scans taken");
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
  const int64_t silence = microseconds(config_.silence);
  if (now - last_taken_ < silence) return health_.setState(health_t::HEALTH_OK, "");
  std::ostringstream line;
  line << "no scan went into the map for " << (now - last_taken_) / 1'000'000 << " s: ";
  if (now - last_scan_ >= silence) {
    line << "no SCAN comes; is lidar_driver running?";
  } else if (now - last_ins_ >= silence) {
    line << "no INS with a pose comes; is ins_driver running, has it a fix and a heading?";
  } else {
    line << (last_refusal_.empty() ? "none came whole" : last_refusal_);
  }
  health_.setState(health_t::HEALTH_DEGRADED, line.str());
}

}  // namespace tread::mapping
