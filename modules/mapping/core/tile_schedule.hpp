// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <vector>

#include "common/grid/grid.hpp"

namespace tread::mapping {

/// Which tiles to send next: changed ones first, the rest in turn.
class TileSchedule {
 public:
  /// Sends `refresh` unchanged tiles a cycle, if there are so many, beside those that changed.
  explicit TileSchedule(size_t refresh) : refresh_(refresh) {}

  /// Begins a cycle. What an earlier cycle left over stays first if it is still in `seen`.
  /** `seen`: all tiles that may be sent; `changed`: those of them that changed, in the same order.
   */
  void begin(const std::vector<CellIndex>& seen, const std::vector<CellIndex>& changed);
  bool empty() const { return queue_.empty(); }
  /// The next tile to send; call only if there is one.
  CellIndex take();
  void clear() { queue_.clear(); }

 private:
  bool isQueued(CellIndex tile) const;

  size_t refresh_;
  std::deque<CellIndex> queue_;
  CellIndex last_turn_;  // the last tile that came in turn, not by change
};

}  // namespace tread::mapping
