// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/tile_schedule.hpp"

#include <algorithm>
#include <tuple>

namespace tread::mapping {
namespace {

bool comesAfter(CellIndex a, CellIndex b) {
  return std::tie(a.y, a.x) > std::tie(b.y, b.x);
}

}  // namespace

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
  // The turn goes by index, so that it survives tiles that come and go.
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
