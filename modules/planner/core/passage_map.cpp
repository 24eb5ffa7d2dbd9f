// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/passage_map.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {
namespace {

/// Room that differs by less than this changes nobody's way [m].
constexpr float kSameRoom = 0.005F;

int floorDivide(int a, int b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

size_t at(int row, int width, int column) {
  return static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column);
}

}  // namespace

PassageMap::PassageMap(double cell_size, int tile_cells, const PassageConfig& config)
    : tiles_(cell_size, tile_cells),
      config_(config),
      coarse_(tile_cells % config.coarse == 0 ? config.coarse : 1) {}

PassageMap::Change PassageMap::merge(Tile& tile) const {
  const auto found = tiles_.tiles().find({tile.tile_x, tile.tile_y});
  Change change = Change::kNone;
  for (size_t i = 0; i < tile.cells.size(); ++i) {
    const Cell before = found == tiles_.tiles().end() ? kUnknown : found->second.cells[i];
    if (tile.cells[i] == kUnknown) tile.cells[i] = before;
    if (tile.cells[i] == before) continue;
    const bool obstacle = tile.cells[i] == kObstacle || before == kObstacle;
    change = obstacle ? Change::kObstacles : std::max(change, Change::kKnowledge);
  }
  return change;
}

bool PassageMap::put(Tile tile) {
  const auto side = static_cast<size_t>(tileCells());
  if (tile.cells.size() != side * side) return false;
  const std::pair<int, int> key{tile.tile_x, tile.tile_y};
  newest_utime_ = std::max(newest_utime_, tile.utime);
  const Change change = merge(tile);
  if (!tiles_.put(std::move(tile))) return false;
  ++revision_;
  dirty_[key] = std::max(dirty_[key], change);
  if (change != Change::kObstacles) return true;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) dirty_[{key.first + dx, key.second + dy}] = Change::kObstacles;
  return true;
}

void PassageMap::markFree(const std::vector<CellIndex>& cells) {
  std::map<std::pair<int, int>, Tile> changed;
  const int side = tileCells();
  for (const CellIndex& cell : cells) {
    const std::pair<int, int> key{floorDivide(cell.x, side), floorDivide(cell.y, side)};
    const size_t index = at(cell.y - key.second * side, side, cell.x - key.first * side);
    const auto found = tiles_.tiles().find(key);
    if (found != tiles_.tiles().end() && found->second.cells[index] != kUnknown) continue;
    Tile& tile = changed[key];
    if (tile.cells.empty()) {
      tile.tile_x = key.first;
      tile.tile_y = key.second;
      tile.utime = found == tiles_.tiles().end() ? 0 : found->second.utime;
      tile.cells.assign(static_cast<size_t>(side) * static_cast<size_t>(side), kUnknown);
    }
    tile.cells[index] = kFree;
  }
  for (auto& [key, tile] : changed) put(std::move(tile));
}

void PassageMap::forgetBeyond(const Eigen::Vector2d& p_map) {
  tiles_.forgetBeyond(p_map, config_.keep_radius);
  for (auto it = passages_.begin(); it != passages_.end();)
    it = tiles_.tiles().count(it->first) == 0 ? passages_.erase(it) : std::next(it);
}

void PassageMap::fill(PassageWindow& window) const {
  const int side = coarsePerTile();
  for (const auto& [key, tile] : passages_) {
    const int left = key.first * side;
    const int bottom = key.second * side;
    const int x_to = std::min(left + side, window.lower_x + window.width);
    const int y_to = std::min(bottom + side, window.lower_y + window.height);
    for (int y = std::max(bottom, window.lower_y); y < y_to; ++y) {
      for (int x = std::max(left, window.lower_x); x < x_to; ++x) {
        const size_t from = at(y - bottom, side, x - left);
        window.room[window.at(x, y)] = tile.room[from];
        window.unknown[window.at(x, y)] = tile.unknown[from];
      }
    }
  }
}

void PassageMap::refresh() {
  for (const auto& [key, change] : dirty_)
    if (change != Change::kNone && tiles_.tiles().count(key) > 0) refreshTile(key);
  dirty_.clear();
}

void PassageMap::refreshTile(std::pair<int, int> key) {
  const bool is_new = passages_.count(key) == 0;
  PassageTile& passage = passages_[key];
  if (is_new) {
    const auto cells = static_cast<size_t>(coarsePerTile() * coarsePerTile());
    passage.room.assign(cells, static_cast<float>(config_.room_cap));
    passage.unknown.assign(cells, 1);
  }
  bool changed = refreshUnknown(tiles_.tiles().at(key), passage);
  if (is_new || dirty_[key] == Change::kObstacles) changed = refreshRoom(key, passage) || changed;
  if (changed) ++passage_revision_;
}

bool PassageMap::refreshUnknown(const Tile& tile, PassageTile& passage) const {
  bool changed = false;
  const int side = coarsePerTile();
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      int unknown = 0;
      for (int k = 0; k < coarse_ * coarse_; ++k) {
        const size_t cell = at(y * coarse_ + k / coarse_, tileCells(), x * coarse_ + k % coarse_);
        unknown += tile.cells[cell] == kUnknown ? 1 : 0;
      }
      const uint8_t value = 2 * unknown >= coarse_ * coarse_ ? 1 : 0;
      uint8_t& cell = passage.unknown[at(y, side, x)];
      changed = changed || cell != value;
      cell = value;
    }
  }
  return changed;
}

bool PassageMap::refreshRoom(std::pair<int, int> key, PassageTile& passage) const {
  const int ring = static_cast<int>(std::ceil(config_.room_cap / cellSize()));
  const CellIndex lower{key.first * tileCells(), key.second * tileCells()};
  const int width = tileCells() + 2 * ring;
  const Grid grid = tiles_.window({lower.x - ring, lower.y - ring}, width, width);
  const ClearanceField field(grid, false);
  bool changed = false;
  const int side = coarsePerTile();
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      double room = 0.0;
      for (int k = 0; k < coarse_ * coarse_; ++k) {
        const CellIndex cell{lower.x + x * coarse_ + k % coarse_,
                             lower.y + y * coarse_ + k / coarse_};
        room = std::max(room, field.at(grid.centre(cell)));
      }
      const float value = static_cast<float>(std::min(room, config_.room_cap));
      float& cell = passage.room[at(y, side, x)];
      changed = changed || std::abs(cell - value) > kSameRoom;
      cell = value;
    }
  }
  return changed;
}

}  // namespace tread::planner
