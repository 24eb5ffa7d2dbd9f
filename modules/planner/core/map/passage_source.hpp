// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace tread::planner {

/// A rectangle of coarse cells; cell (x, y) has its lower corner at (x, y) * coarseSize().
struct PassageWindow {
  int lower_x = 0;
  int lower_y = 0;
  int width = 0;
  int height = 0;
  std::vector<float> room;       ///< [m] greatest distance to an obstacle in the cell
  std::vector<uint8_t> unknown;  ///< 1 where at least half of the cell is unknown

  size_t at(int x, int y) const {
    return static_cast<size_t>(y - lower_y) * static_cast<size_t>(width) +
           static_cast<size_t>(x - lower_x);
  }
};

/// Where there is room for passing.
class PassageSource {
 public:
  virtual ~PassageSource() = default;
  /// [m] side of a coarse cell.
  virtual double coarseSize() const = 0;
  /// The whole of it where it ends, without room and unknown; nothing if it is endless.
  virtual std::optional<PassageWindow> bounds() const { return std::nullopt; }
  /// Fills in what is known in the window's rectangle and leaves the rest as it is.
  virtual void fill(PassageWindow& window) const = 0;
};

}  // namespace tread::planner
