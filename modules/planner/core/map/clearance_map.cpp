// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/map/clearance_map.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tread::planner {
namespace {

/// One field serves all changed tiles if their bounding rectangle has at most this many times as
/// many tiles.
constexpr size_t kTogether = 2;
/// Smaller changes of clearance are ignored [m].
constexpr float kSameClearance = 0.005F;

size_t at(int row, int width, int column) {
  return static_cast<size_t>(row) * static_cast<size_t>(width) + static_cast<size_t>(column);
}

}  // namespace

ClearanceMap::ClearanceMap(double cell_size, int tile_cells, const ClearanceMapConfig& config)
    : tiles_(cell_size, tile_cells),
      config_(config),
      coarse_(tile_cells % config.coarse == 0 ? config.coarse : 1) {}

ClearanceMap::Change ClearanceMap::merge(Tile& tile) const {
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

bool ClearanceMap::put(Tile tile) {
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

void ClearanceMap::assumeFree(const std::vector<CellIndex>& cells) {
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

void ClearanceMap::forgetBeyond(const Eigen::Vector2d& p_map) {
  tiles_.forgetBeyond(p_map, config_.keep_radius);
  for (auto it = clearances_.begin(); it != clearances_.end();)
    it = tiles_.tiles().count(it->first) == 0 ? clearances_.erase(it) : std::next(it);
}

void ClearanceMap::fill(ClearanceWindow& window) const {
  const int side = coarsePerTile();
  for (const auto& [key, tile] : clearances_) {
    const int left = key.first * side;
    const int bottom = key.second * side;
    const int x_to = std::min(left + side, window.lower_x + window.width);
    const int y_to = std::min(bottom + side, window.lower_y + window.height);
    for (int y = std::max(bottom, window.lower_y); y < y_to; ++y) {
      for (int x = std::max(left, window.lower_x); x < x_to; ++x) {
        const size_t from = at(y - bottom, side, x - left);
        window.clearance[window.at(x, y)] = tile.clearance[from];
        window.unknown[window.at(x, y)] = tile.unknown[from];
        if (!window.roughness.empty()) window.roughness[window.at(x, y)] = tile.roughness[from];
      }
    }
  }
}

void ClearanceMap::refresh() {
  std::vector<std::pair<int, int>> clearances;  // tiles whose clearance may have changed
  for (const auto& [key, change] : dirty_) {
    if (change == Change::kNone || tiles_.tiles().count(key) == 0) continue;
    if (change == Change::kObstacles || clearances_.count(key) == 0) clearances.push_back(key);
    refreshKnowledge(key);
  }
  refreshClearances(clearances);
  dirty_.clear();
}

void ClearanceMap::refreshKnowledge(std::pair<int, int> key) {
  const bool is_new = clearances_.count(key) == 0;
  ClearanceTile& coarse_tile = clearances_[key];
  if (is_new) {
    const auto cells = static_cast<size_t>(coarsePerTile() * coarsePerTile());
    coarse_tile.clearance.assign(cells, static_cast<float>(config_.clearance_cap));
    coarse_tile.unknown.assign(cells, 1);
    coarse_tile.roughness.assign(cells, kFree);
  }
  if (refreshUnknown(tiles_.tiles().at(key), coarse_tile)) ++clearance_revision_;
}

void ClearanceMap::refreshClearances(const std::vector<std::pair<int, int>>& keys) {
  if (keys.empty()) return;
  TileBox box{keys.front().first, keys.front().second, keys.front().first, keys.front().second};
  for (const auto& [x, y] : keys)
    box = {std::min(box.left, x), std::min(box.bottom, y), std::max(box.right, x),
           std::max(box.top, y)};
  const size_t tiles =
      static_cast<size_t>(box.right - box.left + 1) * static_cast<size_t>(box.top - box.bottom + 1);
  // A separate tile needs a wide ring: many tiles close together share one field.
  const bool together = tiles <= kTogether * keys.size();
  const ClearanceField shared = together ? fieldOver(box) : ClearanceField();
  for (const auto& key : keys) {
    ClearanceField own;
    if (!together) own = fieldOver({key.first, key.second, key.first, key.second});
    if (refreshClearance(key, together ? shared : own, clearances_[key])) ++clearance_revision_;
  }
}

bool ClearanceMap::refreshUnknown(const Tile& tile, ClearanceTile& coarse_tile) const {
  const int side = coarsePerTile();
  std::vector<uint8_t> unknown(static_cast<size_t>(side * side), 0);
  std::vector<Cell> roughness(unknown.size(), kFree);
  std::vector<uint8_t> counts(static_cast<size_t>(side));
  for (int y = 0; y < side; ++y) {
    std::fill(counts.begin(), counts.end(), uint8_t{0});
    for (int row = y * coarse_; row < (y + 1) * coarse_; ++row) {
      const Cell* const cells = tile.cells.data() + at(row, tileCells(), 0);
      for (int x = 0; x < side; ++x) {
        int count = counts[static_cast<size_t>(x)];
        Cell& rough = roughness[at(y, side, x)];
        for (int k = 0; k < coarse_; ++k) {
          const Cell cell = cells[x * coarse_ + k];
          count += cell == kUnknown ? 1 : 0;
          if (isFree(cell)) rough = std::max(rough, cell);
        }
        counts[static_cast<size_t>(x)] = static_cast<uint8_t>(count);
      }
    }
    for (int x = 0; x < side; ++x)
      unknown[at(y, side, x)] = 2 * counts[static_cast<size_t>(x)] >= coarse_ * coarse_ ? 1 : 0;
  }
  if (unknown == coarse_tile.unknown && roughness == coarse_tile.roughness) return false;
  coarse_tile.unknown = std::move(unknown);
  coarse_tile.roughness = std::move(roughness);
  return true;
}

/// Clearance to obstacles in a rectangle of tiles, including a ring as wide as the cap around it.
ClearanceField ClearanceMap::fieldOver(const TileBox& box) const {
  const int ring = static_cast<int>(std::ceil(config_.clearance_cap / cellSize()));
  const CellIndex lower{box.left * tileCells() - ring, box.bottom * tileCells() - ring};
  const int width = (box.right - box.left + 1) * tileCells() + 2 * ring;
  const int height = (box.top - box.bottom + 1) * tileCells() + 2 * ring;
  return ClearanceField(tiles_.window(lower, width, height), false, config_.clearance_cap);
}

bool ClearanceMap::refreshClearance(std::pair<int, int> key, const ClearanceField& field,
                                    ClearanceTile& coarse_tile) const {
  const auto cap = static_cast<float>(config_.clearance_cap);
  const int side = coarsePerTile();
  const int column = key.first * tileCells() - field.lower().x;
  const int row = key.second * tileCells() - field.lower().y;
  std::vector<float> clearances(static_cast<size_t>(side * side), 0.0F);
  for (int y = 0; y < side * coarse_; ++y) {
    const float* fine = field.row(row + y) + column;
    float* coarse = clearances.data() + at(y / coarse_, side, 0);
    for (int x = 0; x < side; ++x)
      for (int k = 0; k < coarse_; ++k)
        coarse[x] = std::max(coarse[x], std::min(cap, fine[x * coarse_ + k]));
  }
  const auto differs = [](float a, float b) { return std::abs(a - b) > kSameClearance; };
  const bool changed = !std::equal(clearances.begin(), clearances.end(),
                                   coarse_tile.clearance.begin(), std::not_fn(differs));
  coarse_tile.clearance = std::move(clearances);
  return changed;
}

CoarseClearance::CoarseClearance(const Grid& grid, const ClearanceField& field, int coarse)
    : size_(grid.cellSize() * coarse) {
  cells_.lower_x = floorDivide(grid.lower().x, coarse);
  cells_.lower_y = floorDivide(grid.lower().y, coarse);
  if (grid.empty()) return;
  cells_.width = floorDivide(grid.lower().x + grid.width() - 1, coarse) - cells_.lower_x + 1;
  cells_.height = floorDivide(grid.lower().y + grid.height() - 1, coarse) - cells_.lower_y + 1;
  const size_t cells = static_cast<size_t>(cells_.width) * static_cast<size_t>(cells_.height);
  cells_.clearance.assign(cells, 0.0F);
  cells_.unknown.assign(cells, 0);
  std::vector<size_t> columns(static_cast<size_t>(grid.width()));
  for (size_t x = 0; x < columns.size(); ++x)
    columns[x] = static_cast<size_t>(floorDivide(grid.lower().x + static_cast<int>(x), coarse) -
                                     cells_.lower_x);
  std::vector<int> unknowns(cells, 0);
  for (int y = 0; y < grid.height(); ++y) {
    const size_t row = cells_.at(cells_.lower_x, floorDivide(grid.lower().y + y, coarse));
    const float* fine = field.row(y);
    const Cell* kinds = grid.cells().data() + grid.offset({grid.lower().x, grid.lower().y + y});
    for (size_t x = 0; x < columns.size(); ++x) {
      const size_t to = row + columns[x];
      cells_.clearance[to] = std::max(cells_.clearance[to], fine[x]);
      unknowns[to] += kinds[x] == kUnknown ? 1 : 0;
    }
  }
  for (size_t i = 0; i < cells; ++i) cells_.unknown[i] = 2 * unknowns[i] >= coarse * coarse ? 1 : 0;
}

void CoarseClearance::fill(ClearanceWindow& window) const {
  for (int y = window.lower_y; y < window.lower_y + window.height; ++y) {
    for (int x = window.lower_x; x < window.lower_x + window.width; ++x) {
      const size_t to = window.at(x, y);
      window.clearance[to] = contains(x, y) ? cells_.clearance[cells_.at(x, y)] : 0.0F;
      window.unknown[to] = contains(x, y) ? cells_.unknown[cells_.at(x, y)] : 1;
    }
  }
}

void CoarseClearance::label(double radius) {
  area_.assign(cells_.clearance.size(), 0);
  int areas = 0;
  const auto needed = static_cast<float>(radius);
  for (int y = cells_.lower_y; y < cells_.lower_y + cells_.height; ++y) {
    for (int x = cells_.lower_x; x < cells_.lower_x + cells_.width; ++x) {
      const float clearance = cells_.clearance[cells_.at(x, y)];
      if (area_[cells_.at(x, y)] == 0 && clearance > 0.0F && clearance >= needed)
        flood(x, y, ++areas, needed);
    }
  }
}

void CoarseClearance::flood(int x, int y, int number, float radius) {
  std::vector<CellIndex> open{{x, y}};
  area_[cells_.at(x, y)] = number;
  while (!open.empty()) {
    const CellIndex cell = open.back();
    open.pop_back();
    // Corners count as connected, so that separate areas are really separate.
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!contains(cell.x + dx, cell.y + dy)) continue;
        const size_t next = cells_.at(cell.x + dx, cell.y + dy);
        const float clearance = cells_.clearance[next];
        if (area_[next] != 0 || !(clearance > 0.0F) || clearance < radius) continue;
        area_[next] = number;
        open.push_back({cell.x + dx, cell.y + dy});
      }
    }
  }
}

int CoarseClearance::areaAt(const Eigen::Vector2d& p_map) const {
  const double x = std::floor(p_map.x() / size_) - cells_.lower_x;
  const double y = std::floor(p_map.y() / size_) - cells_.lower_y;
  if (!(x >= 0.0 && y >= 0.0 && x < cells_.width && y < cells_.height)) return 0;
  return area_[cells_.at(cells_.lower_x + static_cast<int>(x),
                         cells_.lower_y + static_cast<int>(y))];
}

std::vector<int> CoarseClearance::areasNear(const Eigen::Vector2d& p_map, double distance) const {
  std::vector<int> areas;
  const auto clamped = [this](double coordinate, int lower, int size) {
    // In this order NaN counts as outside.
    const double cell = std::floor(coordinate / size_) - lower;
    return lower + static_cast<int>(std::min(static_cast<double>(size), std::max(-1.0, cell)));
  };
  // A cell's corner may be close enough although its centre is not.
  const double reach = distance + 0.71 * size_;
  const int x_to = clamped(p_map.x() + reach, cells_.lower_x, cells_.width);
  const int y_to = clamped(p_map.y() + reach, cells_.lower_y, cells_.height);
  for (int y = clamped(p_map.y() - reach, cells_.lower_y, cells_.height); y <= y_to; ++y) {
    for (int x = clamped(p_map.x() - reach, cells_.lower_x, cells_.width); x <= x_to; ++x) {
      if (!contains(x, y)) continue;
      const int area = area_[cells_.at(x, y)];
      if (area == 0 || (centreOf(x, y) - p_map).norm() > reach) continue;
      if (std::find(areas.begin(), areas.end(), area) == areas.end()) areas.push_back(area);
    }
  }
  return areas;
}

std::optional<Eigen::Vector2d> CoarseClearance::nearestIn(const std::vector<int>& areas,
                                                          const Eigen::Vector2d& p_map) const {
  std::optional<Eigen::Vector2d> nearest;
  for (int y = cells_.lower_y; y < cells_.lower_y + cells_.height; ++y) {
    for (int x = cells_.lower_x; x < cells_.lower_x + cells_.width; ++x) {
      if (std::find(areas.begin(), areas.end(), area_[cells_.at(x, y)]) == areas.end()) continue;
      const Eigen::Vector2d centre = centreOf(x, y);
      if (!nearest || (centre - p_map).squaredNorm() < (*nearest - p_map).squaredNorm())
        nearest = centre;
    }
  }
  return nearest;
}

}  // namespace tread::planner
