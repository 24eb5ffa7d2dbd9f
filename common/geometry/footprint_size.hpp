// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

namespace tread {

/// A robot's rectangle in the body frame [m].
struct FootprintSize {
  double front = 0.0;       ///< from the body origin forward
  double rear = 0.0;        ///< and backward
  double half_width = 0.0;  ///< to both sides

  constexpr double length() const { return front + rear; }
  constexpr FootprintSize widened(double margin) const {
    return {front + margin, rear + margin, half_width + margin};
  }
};

}  // namespace tread
