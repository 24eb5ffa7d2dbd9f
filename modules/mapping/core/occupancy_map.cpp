// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/occupancy_map.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "common/geometry/se3.hpp"

namespace tread::mapping {
namespace {

/// OctoMap indexes 2^15 voxels to each side of the origin.
constexpr double kMostCells = 32000.0;
/// A new stance counts after this change of position or height: rocking on the spot adds no
/// information.
constexpr double kStandDistance = 0.2;
constexpr double kStandHeight = 0.05;
/// The window moves when the robot is this many tiles off its middle; a smaller value would make it
/// move back and forth.
constexpr double kOffMiddle = 0.75;
/// Returns this close to the footprint are the robot's own [m].
constexpr double kOwnBodyMargin = 0.05;

bool isNewStand(const GroundPlane& stand, const GroundPlane& last) {
  const Eigen::Vector3d step = stand.p_map - last.p_map;
  return step.head<2>().norm() > kStandDistance || std::abs(step.z()) > kStandHeight;
}

bool comesAfter(CellIndex a, CellIndex b) {
  return std::tie(a.y, a.x) > std::tie(b.y, b.x);
}

}  // namespace

OccupancyMap::OccupancyMap(const OccupancyMapConfig& config)
    : config_(config),
      voxels_(config.voxels, config.tile_cells * config.window_tiles),
      ground_(config.ground, config.voxels.cell_size, config.tile_cells * config.window_tiles),
      roughness_(config.voxels.cell_size, config.tile_cells * config.window_tiles),
      classifier_(config.obstacle, config.voxels.cell_size),
      footprint_(config.robot, 0.0),
      trust_(config.tile_cells * config.window_tiles),
      tiles_(config.window_tiles),
      tile_of_cell_(trust_.size()) {
  if (config.tile_cells < 1 || config.window_tiles < 2 ||
      config.tile_cells % GroundMap::kPatchCells != 0 ||
      (config.roughness.range_noise > 0.0 && config.tile_cells % RoughnessMap::kPatchCells != 0))
    throw std::invalid_argument(
        "occupancy map: tile_cells must be a multiple of 8 (16 with roughness), window_tiles 2 or "
        "more");
  for (size_t i = 0; i < tile_of_cell_.size(); ++i) {
    const CellIndex cell = trust_.indexOf(i);
    tile_of_cell_[i] = static_cast<uint32_t>(
        tiles_.offset({cell.x / config.tile_cells, cell.y / config.tile_cells}));
  }
}

OccupancyMap::Refusal OccupancyMap::insert(const Scan& scan) {
  if (scan.utime <= utime_) return Refusal::kNotNewer;
  const auto plane = planeUnder(scan.T_map_body_last);
  if (!plane) return Refusal::kToppled;
  const double reach = kMostCells * config_.voxels.cell_size - config_.clearing_range;
  if (!(plane->p_map.cwiseAbs().maxCoeff() < reach)) return Refusal::kTooFar;
  utime_ = scan.utime;
  const bool moved = place(scan.T_map_body_last);
  learnGround(*plane, moved);
  voxels_.insert(raysOf(scan));
  for (const size_t offset : voxels_.touched()) tileOf(offset).utime = utime_;
  for (const size_t offset : voxels_.changed()) classifyAround(offset);
  learnEdges();
  if (config_.roughness.range_noise > 0.0) learnRoughness();
  standAt(planar(plane->p_map, Eigen::Quaterniond(scan.T_map_body_last.linear())));
  return Refusal::kNone;
}

bool OccupancyMap::place(const Eigen::Isometry3d& T_map_body) {
  const Eigen::Vector3d& p_map = T_map_body.translation();
  const double side = config_.tile_cells * config_.voxels.cell_size;
  const double half = 0.5 * config_.window_tiles;
  const Eigen::Vector2d at = p_map.head<2>() / side;
  const Eigen::Vector2d middle(tiles_.lower().x + half, tiles_.lower().y + half);
  const double z = p_map.z() / config_.voxels.cell_size;
  const double off_z = std::abs(z - voxels_.lowerZ() - kColumnHeight / 2);
  const bool fresh = grid_.empty();
  if (!fresh && (at - middle).cwiseAbs().maxCoeff() < kOffMiddle && off_z < kMostOffHeight)
    return false;
  const CellIndex lower{static_cast<int>(std::lround(at.x() - half)),
                        static_cast<int>(std::lround(at.y() - half))};
  const auto blocks = static_cast<int>(std::lround(z / kBlockSide));
  moveWindow(lower, blocks * kBlockSide - kColumnHeight / 2);
  if (fresh) assumeStartFree(p_map.head<2>());
  return true;
}

void OccupancyMap::moveWindow(CellIndex lower, int lower_z) {
  const CellIndex lower_cell{lower.x * config_.tile_cells, lower.y * config_.tile_cells};
  voxels_.moveTo(lower_cell, lower_z);
  ground_.moveTo(lower_cell);
  roughness_.moveTo(lower_cell);
  trust_.moveTo(lower_cell);
  tiles_.moveTo(lower);
  under_robot_.clear();
  Grid moved(config_.voxels.cell_size, lower_cell, trust_.side(), trust_.side());
  for (size_t i = 0; i < trust_.size(); ++i) {
    trust_[i].under_robot = false;
    moved.cells()[i] = grid_.at(trust_.indexOf(i));
  }
  grid_ = std::move(moved);
}

void OccupancyMap::learnGround(const GroundPlane& plane, bool window_moved) {
  if (!window_moved && !isNewStand(plane, *last_stand_)) return;
  last_stand_ = plane;
  const std::vector<CellIndex> changed = ground_.learn(plane);
  if (window_moved) {
    for (size_t i = 0; i < trust_.size(); ++i) classify(i);
  } else {
    for (const CellIndex patch : changed) classifyPatch(patch, GroundMap::kPatchCells);
  }
}

/// From the beams of the last scan that ended deep below the ground.
void OccupancyMap::learnEdges() {
  const double cell_size = config_.voxels.cell_size;
  for (const Ray& ray : rays_) {
    const Eigen::Vector3d back = ray.from - ray.to;
    const CellIndex end = grid_.indexOf(ray.to.head<2>());
    if (back.z() <= 0.0 || !grid_.contains(end)) continue;
    const GroundHeight below = ground_.at(end);
    if (ray.to.z() > below.z - below.doubt - config_.obstacle.step - cell_size) continue;
    const double share = cell_size / std::max(back.head<2>().norm(), cell_size);
    for (double way = 0.0; way < 1.0; way += share) {
      const Eigen::Vector3d p_map = ray.to + way * back;
      const CellIndex cell = grid_.indexOf(p_map.head<2>());
      const GroundHeight ground = ground_.at(cell);
      if (p_map.z() > ground.z + ground.doubt) break;
      const size_t offset = trust_.offset(cell);
      const Column& column = voxels_.columns()[offset];
      const bool seen = classifier_.surface(column, voxels_.lowerZ(), ground) >= 0;
      if (seen && way > 0.0) break;
      if (seen || trust_[offset].missed) continue;
      trust_[offset].missed = true;
      classify(offset);
    }
  }
}

/// From the returns of the last scan on free ground.
void OccupancyMap::learnRoughness() {
  std::vector<GroundPoint> points;
  for (const Ray& ray : rays_) {
    const CellIndex cell = grid_.indexOf(ray.to.head<2>());
    if (!ray.hit || !grid_.contains(cell) || !isFree(grid_.at(cell))) continue;
    const GroundHeight ground = ground_.at(cell);
    if (std::abs(ray.to.z() - ground.z) > config_.obstacle.step + ground.doubt) continue;
    const double down = (ray.to - ray.from).normalized().z() * config_.roughness.range_noise;
    points.push_back({ray.to, down * down});
  }
  for (const CellIndex patch : roughness_.take(points))
    classifyPatch(patch, RoughnessMap::kPatchCells);
}

void OccupancyMap::assumeStartFree(const Eigen::Vector2d& p_map) {
  for (size_t i = 0; i < trust_.size(); ++i)
    trust_[i].stood_on =
        (grid_.centre(trust_.indexOf(i)) - p_map).norm() < config_.start_free_radius;
}

void OccupancyMap::standAt(const Pose2& T_map_body) {
  std::vector<size_t> left = std::move(under_robot_);
  under_robot_.clear();
  for (const size_t offset : left) trust_[offset].under_robot = false;
  const Pose2 T_body_map = inverse(T_map_body);
  for (const CellIndex cell : footprint_.cells(grid_, T_map_body)) {
    const Eigen::Vector2d p_body = T_body_map * grid_.centre(cell);
    const bool inside = p_body.x() < config_.robot.front && p_body.x() > -config_.robot.rear &&
                        std::abs(p_body.y()) < config_.robot.half_width;
    if (!inside || !trust_.contains(cell)) continue;
    const size_t offset = trust_.offset(cell);
    trust_[offset].stood_on = trust_[offset].under_robot = true;
    under_robot_.push_back(offset);
    tileOf(offset).utime = utime_;
  }
  for (const size_t offset : left) classify(offset);
  for (const size_t offset : under_robot_) classify(offset);
}

bool isOwnBody(const Eigen::Vector3d& p_body, const FootprintSize& robot, double height) {
  return p_body.x() < robot.front + kOwnBodyMargin && p_body.x() > -robot.rear - kOwnBodyMargin &&
         std::abs(p_body.y()) < robot.half_width + kOwnBodyMargin && p_body.z() < height;
}

const std::vector<Ray>& OccupancyMap::raysOf(const Scan& scan) {
  rays_.clear();
  for (const Beam& beam : scan.beams) {
    if (beam.hit &&
        isOwnBody(scan.T_body_sensor * beam.end, config_.robot, config_.obstacle.robot_height))
      continue;
    const double range = beam.end.norm();
    const bool marks = beam.hit && range <= config_.marking_range;
    const double reach = marks ? range : std::min(range, config_.clearing_range);
    if (!(range > 0.0)) continue;
    const Eigen::Isometry3d T_map_sensor =
        interpolated(scan.T_map_body_first, scan.T_map_body_last, beam.share) * scan.T_body_sensor;
    rays_.push_back({T_map_sensor.translation(),
                     T_map_sensor * Eigen::Vector3d(beam.end * (reach / range)), marks});
  }
  return rays_;
}

void OccupancyMap::classify(size_t offset) {
  const Trust& trust = trust_[offset];
  const CellIndex index = trust_.indexOf(offset);
  Cell cell = kFree;
  if (!trust.under_robot) {
    const Column& column = voxels_.columns()[offset];
    cell = classifier_.classify(column, voxels_.lowerZ(), ground_.at(index));
    if (cell == kFree && trust.missed && !groundSeenAt(index)) cell = kUnknown;
    if (cell == kUnknown && trust.stood_on) cell = kFree;
  }
  if (cell == kFree && !trust.under_robot && isBelowEdge(index)) cell = kObstacle;
  if (cell == kFree) cell = roughness_.at(index);
  if (grid_.cells()[offset] == cell) return;
  grid_.cells()[offset] = cell;
  TileState& tile = tileOf(offset);
  tile.changed = true;
  tile.utime = utime_;
}

/// Observed ground may form edges with that of its neighbours.
void OccupancyMap::classifyAround(size_t offset) {
  classify(offset);
  if (voxels_.columns()[offset].occupied == 0) return;
  const CellIndex cell = trust_.indexOf(offset);
  for (int y = cell.y - 1; y <= cell.y + 1; ++y)
    for (int x = cell.x - 1; x <= cell.x + 1; ++x)
      if (trust_.contains({x, y}) && (x != cell.x || y != cell.y)) classify(trust_.offset({x, y}));
}

/// As in ColumnClassifier.
int OccupancyMap::surfaceAt(CellIndex cell) const {
  const Column& column = voxels_.columns().at(cell);
  if (column.occupied == 0) return -1;
  return classifier_.surface(column, voxels_.lowerZ(), ground_.at(cell));
}

/// In the cell or on both sides of it: returns on a slope are farther apart than cells.
bool OccupancyMap::groundSeenAt(CellIndex cell) const {
  if (surfaceAt(cell) >= 0) return true;
  for (const CellIndex step : {CellIndex{1, 0}, {0, 1}, {1, 1}, {1, -1}}) {
    const CellIndex one{cell.x + step.x, cell.y + step.y};
    const CellIndex other{cell.x - step.x, cell.y - step.y};
    if (trust_.contains(one) && trust_.contains(other) && surfaceAt(one) >= 0 &&
        surfaceAt(other) >= 0)
      return true;
  }
  return false;
}

bool OccupancyMap::isBelowEdge(CellIndex cell) const {
  const int surface = surfaceAt(cell);
  if (surface < 0) return false;
  for (int y = cell.y - 1; y <= cell.y + 1; ++y)
    for (int x = cell.x - 1; x <= cell.x + 1; ++x)
      if (trust_.contains({x, y}) && classifier_.isDrop(surface, surfaceAt({x, y}))) return true;
  return false;
}

void OccupancyMap::classifyPatch(CellIndex lower, int side) {
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) classify(trust_.offset({lower.x + x, lower.y + y}));
}

OccupancyMap::TileState& OccupancyMap::tileOf(size_t offset) {
  return tiles_[tile_of_cell_[offset]];
}

std::vector<CellIndex> OccupancyMap::seenTiles() const {
  std::vector<CellIndex> seen;
  for (size_t i = 0; i < tiles_.size(); ++i)
    if (tiles_[i].utime > 0) seen.push_back(tiles_.indexOf(i));
  return seen;
}

std::vector<CellIndex> OccupancyMap::takeChangedTiles() {
  std::vector<CellIndex> changed;
  for (size_t i = 0; i < tiles_.size(); ++i) {
    if (tiles_[i].changed) changed.push_back(tiles_.indexOf(i));
    tiles_[i].changed = false;
  }
  return changed;
}

Tile OccupancyMap::tile(CellIndex index) const {
  Tile tile{index.x, index.y, tiles_.at(index).utime, {}};
  const int side = config_.tile_cells;
  tile.cells.reserve(static_cast<size_t>(side) * static_cast<size_t>(side));
  for (int y = 0; y < side; ++y) {
    const auto row =
        grid_.cells().begin() +
        static_cast<std::ptrdiff_t>(grid_.offset({index.x * side, index.y * side + y}));
    tile.cells.insert(tile.cells.end(), row, row + side);
  }
  return tile;
}

bool TileSchedule::isQueued(CellIndex tile) const {
  return std::find(queue_.begin(), queue_.end(), tile) != queue_.end();
}

void TileSchedule::begin(const std::vector<CellIndex>& seen,
                         const std::vector<CellIndex>& changed) {
  std::deque<CellIndex> kept;
  for (const CellIndex tile : queue_)
    if (std::find(seen.begin(), seen.end(), tile) != seen.end()) kept.push_back(tile);
  queue_ = std::move(kept);
  for (const CellIndex tile : changed)
    if (!isQueued(tile)) queue_.push_back(tile);
  // The turn is kept by index, so that it survives appearing and disappearing tiles.
  const auto first = std::find_if(seen.begin(), seen.end(),
                                  [&](CellIndex tile) { return comesAfter(tile, last_turn_); });
  const size_t start = first == seen.end() ? 0 : static_cast<size_t>(first - seen.begin());
  size_t turns = 0;
  for (size_t i = 0; i < seen.size() && turns < refresh_; ++i) {
    const CellIndex tile = seen[(start + i) % seen.size()];
    if (isQueued(tile)) continue;
    queue_.push_back(tile);
    last_turn_ = tile;
    ++turns;
  }
}

CellIndex TileSchedule::take() {
  const CellIndex tile = queue_.front();
  queue_.pop_front();
  return tile;
}

}  // namespace tread::mapping
