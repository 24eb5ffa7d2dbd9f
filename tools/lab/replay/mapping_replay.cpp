// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/replay/mapping_replay.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "common/bus/virtual_bus.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/report/plot.hpp"
#include "tools/lab/replay/ins_replay.hpp"

namespace tread {
namespace {

/// Poses continue for this time after the last scan, until tiles and counters are published.
constexpr int64_t kPosesAfterUs = 200'000;
constexpr int64_t kAfterwardsUs = 2'000'000;

/// Copies a tile's known cells into the map; unknown cells leave it unchanged.
void take(const map_tile_t& message, TileMap& map) {
  Tile tile{message.tile_x, message.tile_y, message.utime, message.cells};
  const auto known = map.tiles().find({tile.tile_x, tile.tile_y});
  if (known != map.tiles().end())
    for (size_t i = 0; i < tile.cells.size(); ++i)
      if (tile.cells[i] == kUnknown) tile.cells[i] = known->second.cells[i];
  map.put(std::move(tile));
}

void play(const MappingRecording& recording, VirtualBus& bus) {
  auto pose = recording.poses.begin();
  const auto posesUntil = [&](int64_t utime) {
    for (; pose != recording.poses.end() && pose->utime <= utime; ++pose) {
      bus.runUntil(pose->utime);
      bus.outside().publish(kIns, *pose);
    }
  };
  for (const scan_t& scan : recording.scans) {
    posesUntil(scan.utime + scan.duration);
    bus.runUntil(std::max(bus.now(), scan.utime + scan.duration));
    bus.outside().publish(kScan, scan);
  }
  posesUntil(bus.now() + kPosesAfterUs);
}

/// The smallest window that contains all tiles.
Grid windowOf(const TileMap& map) {
  if (map.tiles().empty()) return Grid(map.cellSize(), {}, 0, 0);
  CellIndex low{map.tiles().begin()->first.first, map.tiles().begin()->first.second};
  CellIndex high = low;
  for (const auto& [key, tile] : map.tiles()) {
    low = {std::min(low.x, key.first), std::min(low.y, key.second)};
    high = {std::max(high.x, key.first), std::max(high.y, key.second)};
  }
  const int side = map.tileCells();
  return map.window({low.x * side, low.y * side}, (high.x - low.x + 1) * side,
                    (high.y - low.y + 1) * side);
}

void takeTrack(const MappingRecording& recording, MappingReplay& replay) {
  for (const ins_t& message : recording.poses)
    if (const auto pose = planarPose(message)) replay.track.push_back({message.utime, *pose});
  if (replay.track.empty()) return;
  replay.duration =
      static_cast<double>(replay.track.back().utime - replay.track.front().utime) * 1e-6;
}

double wayOf(const std::vector<TimedPose>& track) {
  double way = 0.0;
  for (size_t i = 1; i < track.size(); ++i)
    way += (track[i].T_map_body.position() - track[i - 1].T_map_body.position()).norm();
  return way;
}

}  // namespace

MappingReplay replayMapping(const MappingRecording& recording) {
  MappingReplay replay;
  replay.name = recording.name;
  replay.scans = static_cast<int64_t>(recording.scans.size());
  replay.skipped = recording.skipped;
  replay.problem = recording.problem;
  replay.map = TileMap(recording.config.map.voxels.cell_size, recording.config.map.tile_cells);
  VirtualBus bus(0);
  bool playing = true;
  bus.outside().subscribe<map_tile_t>(kMap, [&](const map_tile_t& message) {
    ++replay.tiles;
    take(message, replay.map);
  });
  bus.outside().subscribe<health_t>(kHealth, [&](const health_t& health) {
    if (playing) replay.health = health.health_reason;
    for (const counter_t& counter : health.counters)
      replay.counters[counter.counter_name] = counter.counted;
  });
  bus.addNode("mapping", [&](Bus& end) {
    return std::make_unique<mapping::MappingNode>(recording.config, end);
  });
  play(recording, bus);
  playing = false;
  bus.runUntil(bus.now() + kAfterwardsUs);
  takeTrack(recording, replay);
  replay.window = windowOf(replay.map);
  return replay;
}

std::string reportOf(const MappingReplay& replay) {
  std::ostringstream out;
  const auto count = [&](auto wanted) {
    return std::count_if(replay.window.cells().begin(), replay.window.cells().end(), wanted);
  };
  const double cell_area = replay.map.cellSize() * replay.map.cellSize();
  out << std::fixed << std::setprecision(1);
  out << replay.name << ": " << replay.scans << " scans, " << replay.skipped
      << " records not whole, " << replay.duration << " s, " << wayOf(replay.track) << " m\n";
  if (!replay.problem.empty()) out << "  " << replay.problem << '\n';
  if (!replay.health.empty()) out << "  HEALTH at the end: " << replay.health << '\n';
  for (const auto& [name, counted] : replay.counters)
    out << "  " << name << ": " << counted << '\n';
  out << "  map: " << static_cast<double>(count([](Cell cell) { return isFree(cell); })) * cell_area
      << " m2 free, "
      << static_cast<double>(count([](Cell cell) { return cell == kObstacle; })) * cell_area
      << " m2 obstacle, " << replay.tiles << " tiles sent\n";
  return out.str();
}

void drawMap(const MappingReplay& replay, const std::string& path) {
  report::Picture canvas(1200, 1000, replay.name + " through mapping");
  const Grid& window = replay.window;
  const double size = window.cellSize();
  report::Panel::Axes axes;
  axes.x_label = "x [m]";
  axes.y_label = "y [m]";
  axes.x_min = window.lower().x * size;
  axes.y_min = window.lower().y * size;
  axes.x_max = (window.lower().x + std::max(1, window.width())) * size;
  axes.y_max = (window.lower().y + std::max(1, window.height())) * size;
  axes.equal = true;
  report::Panel panel(canvas, {80, 60, 1080, 860}, axes);
  panel.grid(window);
  std::vector<Eigen::Vector2d> way;
  for (const TimedPose& pose : replay.track) way.push_back(pose.T_map_body.position());
  report::Style line;
  line.colour = report::kOrange;
  line.label = "robot";
  panel.line(way, line);
  panel.legendEntry({report::kBlack, 6.0, false, "obstacle"});
  panel.legendEntry({report::kGrey, 6.0, false, "unknown"});
  panel.finish();
  canvas.save(path);
}

}  // namespace tread
