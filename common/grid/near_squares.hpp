// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tread {

/// Squared distances from cells' centres to the blocked areas, in half cells, where those below a
/// small cap are all that matters.
/** Looks at every column within the cap, which the compiler does for many cells at once: quicker
 * than the envelope up to some thirty cells. Exact below cap * cap; what is farther is at least
 * that. */
class NearSquares {
 public:
  /// The widest cap that sums of two squares leave room for [half cells].
  static constexpr int kWidest = 64;

  NearSquares(const std::vector<uint8_t>& blocked, int width, int height, bool outside_blocks,
              int cap)
      : blocked_(blocked),
        w_(static_cast<size_t>(width)),
        h_(static_cast<size_t>(height)),
        outside_(outside_blocks ? int16_t{0} : kNone),
        cap_(cap),
        reach_(static_cast<size_t>(cap / 2 + 1)),
        padded_(w_ + 2 * reach_) {}

  /// Row by row; calls `take` with the number of the row and its squares.
  template <typename Take>
  void forEachRow(Take take) {
    workOutColumns();
    std::vector<int16_t> squares(w_);
    for (size_t y = 0; y < h_; ++y) {
      const int16_t* const own = along_y_.data() + y * padded_ + reach_;
      std::copy(own, own + w_, squares.begin());
      for (size_t step = 1; step <= reach_; ++step) {
        const auto along = static_cast<int>(2 * step - 1);
        spread(own - step, own + step, static_cast<int16_t>(along * along), squares.data());
      }
      take(y, squares.data());
    }
  }

 private:
  static constexpr int16_t kNone = 20'000;  // with a square of the reach added it fits as well

  /// Squared distances along y, with as much of the outside as is looked at on both sides.
  void workOutColumns() {
    along_y_.assign(padded_ * h_, outside_);
    const auto far = static_cast<int16_t>(cap_);
    std::vector<int16_t> steps(w_, outside_ == 0 ? int16_t{0} : far);  // rows to the last blocked
    std::vector<int16_t> rows(w_ * h_);
    for (size_t y = 0; y < h_; ++y)
      count(blocked_.data() + y * w_, steps.data(), rows.data() + y * w_);
    std::fill(steps.begin(), steps.end(), outside_ == 0 ? int16_t{0} : far);
    std::vector<int16_t> up(w_);
    for (size_t y = h_; y-- > 0;) {
      count(blocked_.data() + y * w_, steps.data(), up.data());
      const int16_t* const down = rows.data() + y * w_;
      int16_t* const out = along_y_.data() + y * padded_ + reach_;
      for (size_t x = 0; x < w_; ++x) {
        const int nearer = std::min(down[x], up[x]);
        const int along = std::max(0, 2 * nearer - 1);
        out[x] = along >= cap_ ? kNone : static_cast<int16_t>(along * along);
      }
    }
  }

  void count(const uint8_t* blocked, int16_t* steps, int16_t* out) const {
    const auto far = static_cast<int16_t>(cap_);
    for (size_t x = 0; x < w_; ++x) {
      const auto next = static_cast<int16_t>(steps[x] + 1);
      steps[x] = blocked[x] != 0 ? int16_t{0} : std::min(next, far);
      out[x] = steps[x];
    }
  }

  void spread(const int16_t* left, const int16_t* right, int16_t along, int16_t* squares) const {
    for (size_t x = 0; x < w_; ++x) {
      const auto through = static_cast<int16_t>(std::min(left[x], right[x]) + along);
      squares[x] = std::min(squares[x], through);
    }
  }

  const std::vector<uint8_t>& blocked_;
  size_t w_;
  size_t h_;
  int16_t outside_;
  int cap_;
  size_t reach_;
  size_t padded_;
  std::vector<int16_t> along_y_;
};

}  // namespace tread
