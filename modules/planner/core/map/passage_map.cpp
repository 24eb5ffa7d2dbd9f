// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/map/passage_map.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tread::planner {
namespace {

/// So many times as many tiles may lie in a rectangle as need room there.
constexpr size_t kTogether = 2;
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
  std::vector<std::pair<int, int>> rooms;  // tiles whose room may have changed
  for (const auto& [key, change] : dirty_) {
    if (change == Change::kNone || tiles_.tiles().count(key) == 0) continue;
    if (change == Change::kObstacles || passages_.count(key) == 0) rooms.push_back(key);
    refreshKnowledge(key);
  }
  refreshRooms(rooms);
  dirty_.clear();
}

void PassageMap::refreshKnowledge(std::pair<int, int> key) {
  const bool is_new = passages_.count(key) == 0;
  PassageTile& passage = passages_[key];
  if (is_new) {
    const auto cells = static_cast<size_t>(coarsePerTile() * coarsePerTile());
    passage.room.assign(cells, static_cast<float>(config_.room_cap));
    passage.unknown.assign(cells, 1);
  }
  if (refreshUnknown(tiles_.tiles().at(key), passage)) ++passage_revision_;
}

void PassageMap::refreshRooms(const std::vector<std::pair<int, int>>& keys) {
  if (keys.empty()) return;
  TileBox box{keys.front().first, keys.front().second, keys.front().first, keys.front().second};
  for (const auto& [x, y] : keys)
    box = {std::min(box.left, x), std::min(box.bottom, y), std::max(box.right, x),
           std::max(box.top, y)};
  const size_t tiles =
      static_cast<size_t>(box.right - box.left + 1) * static_cast<size_t>(box.top - box.bottom + 1);
  // A tile of its own needs a wide ring: where many lie close together one field serves them all.
  const bool together = tiles <= kTogether * keys.size();
  const ClearanceField shared = together ? fieldOver(box) : ClearanceField();
  for (const auto& key : keys) {
    ClearanceField own;
    if (!together) own = fieldOver({key.first, key.second, key.first, key.second});
    if (refreshRoom(key, together ? shared : own, passages_[key])) ++passage_revision_;
  }
}

bool PassageMap::refreshUnknown(const Tile& tile, PassageTile& passage) const {
  const int side = coarsePerTile();
  std::vector<uint8_t> unknown(static_cast<size_t>(side * side), 0);
  std::vector<uint8_t> counts(static_cast<size_t>(side));
  for (int y = 0; y < side; ++y) {
    std::fill(counts.begin(), counts.end(), uint8_t{0});
    for (int row = y * coarse_; row < (y + 1) * coarse_; ++row) {
      const Cell* const cells = tile.cells.data() + at(row, tileCells(), 0);
      for (int x = 0; x < side; ++x) {
        int count = counts[static_cast<size_t>(x)];
        for (int k = 0; k < coarse_; ++k) count += cells[x * coarse_ + k] == kUnknown ? 1 : 0;
        counts[static_cast<size_t>(x)] = static_cast<uint8_t>(count);
      }
    }
    for (int x = 0; x < side; ++x)
      unknown[at(y, side, x)] = 2 * counts[static_cast<size_t>(x)] >= coarse_ * coarse_ ? 1 : 0;
  }
  if (unknown == passage.unknown) return false;
  passage.unknown = std::move(unknown);
  return true;
}

/// Clearance to obstacles in a rectangle of tiles, and in as wide a ring around it as counts.
ClearanceField PassageMap::fieldOver(const TileBox& box) const {
  const int ring = static_cast<int>(std::ceil(config_.room_cap / cellSize()));
  const CellIndex lower{box.left * tileCells() - ring, box.bottom * tileCells() - ring};
  const int width = (box.right - box.left + 1) * tileCells() + 2 * ring;
  const int height = (box.top - box.bottom + 1) * tileCells() + 2 * ring;
  return ClearanceField(tiles_.window(lower, width, height), false, config_.room_cap);
}

bool PassageMap::refreshRoom(std::pair<int, int> key, const ClearanceField& field,
                             PassageTile& passage) const {
  const auto cap = static_cast<float>(config_.room_cap);
  const int side = coarsePerTile();
  const int column = key.first * tileCells() - field.lower().x;
  const int row = key.second * tileCells() - field.lower().y;
  std::vector<float> rooms(static_cast<size_t>(side * side), 0.0F);
  for (int y = 0; y < side * coarse_; ++y) {
    const float* clearance = field.row(row + y) + column;
    float* room = rooms.data() + at(y / coarse_, side, 0);
    for (int x = 0; x < side; ++x)
      for (int k = 0; k < coarse_; ++k)
        room[x] = std::max(room[x], std::min(cap, clearance[x * coarse_ + k]));
  }
  const auto differs = [](float a, float b) { return std::abs(a - b) > kSameRoom; };
  const bool changed =
      !std::equal(rooms.begin(), rooms.end(), passage.room.begin(), std::not_fn(differs));
  passage.room = std::move(rooms);
  return changed;
}

}  // namespace tread::planner
