// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "common/grid/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tread {
namespace {

// All lengths in this file are half cells: centres of cells have even, their borders odd
// coordinates, and every squared distance is an integer that a float represents exactly.
constexpr float kFar = 1e12f;

/// Distance along y from each cell's centre to the nearest blocked cell's area in its column.
/** Row by row over the whole width, so that the compiler can vectorize over columns; `cap` and more
 * [half cells] is kFar. */
std::vector<float> columnDistances(const std::vector<uint8_t>& blocked, int width, int height,
                                   bool outside_blocks, float cap) {
  const auto w = static_cast<size_t>(width);
  const auto h = static_cast<size_t>(height);
  constexpr float kNone = 1e6f;
  std::vector<float> distance(w * h);
  std::vector<float> steps(w, outside_blocks ? 0.0f : kNone);  // rows since the last blocked one
  for (size_t y = 0; y < h; ++y)
    for (size_t x = 0; x < w; ++x) {
      steps[x] = blocked[y * w + x] ? 0.0f : steps[x] + 1.0f;
      distance[y * w + x] = steps[x];
    }
  std::fill(steps.begin(), steps.end(), outside_blocks ? 0.0f : kNone);
  for (size_t y = h; y-- > 0;)
    for (size_t x = 0; x < w; ++x) {
      steps[x] = blocked[y * w + x] ? 0.0f : steps[x] + 1.0f;
      const float rows = std::min(distance[y * w + x], steps[x]);
      const float along = std::max(0.0f, 2.0f * rows - 1.0f);
      distance[y * w + x] = along >= cap ? kFar : along;
    }
  return distance;
}

/// For each cell the number of free cells of its row, from it to the right.
std::vector<uint16_t> freeRuns(const std::vector<uint8_t>& blocked, int width, int height) {
  const auto w = static_cast<size_t>(width);
  std::vector<uint16_t> runs(blocked.size());
  for (size_t row = 0; row < static_cast<size_t>(height); ++row) {
    int run = 0;
    for (size_t x = w; x-- > 0;) {
      const size_t at = row * w + x;
      run = blocked[at] ? 0 : run + 1;
      runs[at] = static_cast<uint16_t>(std::min(run, 65535));
    }
  }
  return runs;
}

/// Lower envelope of parabolas (Felzenszwalb and Huttenlocher 2012, section 2) along one row.
/** The parabolas are placed on the borders between cells: the distance along x to the area of a
 * cell is that to its nearer border. */
class RowEnvelope {
 public:
  explicit RowEnvelope(int width) : vertex_(size_t(width) + 1), from_(size_t(width) + 2) {}

  /// Squared distances to the blocked areas from the squared distances along y.
  void transform(const float* along_y, int width, bool outside_blocks, float* squared) {
    count_ = 0;
    for (int border = 0; border <= width; ++border) {
      const float outside = outside_blocks ? 0.0f : kFar;
      const float left = border > 0 ? along_y[border - 1] : outside;
      const float right = border < width ? along_y[border] : outside;
      const float height = std::min(left, right);
      if (height < kFar) add(static_cast<float>(2 * border - 1), height);
    }
    size_t k = 0;
    for (int x = 0; x < width; ++x) {
      squared[x] = along_y[x];
      if (count_ == 0) continue;
      const auto centre = static_cast<float>(2 * x);
      while (k + 1 < count_ && from_[k + 1] < centre) ++k;
      const float step = centre - vertex_[k].position;
      squared[x] = std::min(squared[x], step * step + vertex_[k].height);
    }
  }

 private:
  struct Vertex {
    float position;
    float height;
    double key;  // position^2 + height
  };

  void add(float position, float height) {
    const Vertex next{position, height, double(position) * double(position) + double(height)};
    double from = -std::numeric_limits<double>::infinity();
    while (count_ > 0) {
      const Vertex& last = vertex_[count_ - 1];
      from = (next.key - last.key) / (2.0 * (double(position) - double(last.position)));
      if (from > from_[count_ - 1]) break;
      from = -std::numeric_limits<double>::infinity();
      --count_;
    }
    vertex_[count_] = next;
    from_[count_] = from;
    ++count_;
  }

  std::vector<Vertex> vertex_;
  std::vector<double> from_;
  size_t count_ = 0;
};

/// Squared distances from cells' centres to the blocked areas, in half cells, where only those
/// below a small cap matter.
/** Checks every column within the cap, which the compiler vectorizes: faster than the envelope up
 * to some thirty cells. Exact below cap * cap; larger distances are at least that. */
class NearSquares {
 public:
  /// The widest cap for which the sum of two squares fits [half cells].
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
  static constexpr int16_t kNone = 20'000;  // fits even with the square of the cap added

  /// Squared distances along y, including the outside within the cap on both sides.
  /** Not inlined into its only caller, because that is slower. */
  [[gnu::noinline]] void workOutColumns() {
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

}  // namespace

ClearanceField::ClearanceField(const Grid& grid, bool unknown_blocks, double cap)
    : cell_size_(grid.cellSize()),
      per_cell_(1.0 / grid.cellSize()),
      cap_(static_cast<float>(cap)),
      half_diagonal_(static_cast<float>(0.708 * grid.cellSize())),
      lower_(grid.lower()),
      width_(grid.width()),
      height_(grid.height()),
      unknown_blocks_(unknown_blocks) {
  std::vector<uint8_t> blocked(grid.cells().size());
  std::transform(grid.cells().begin(), grid.cells().end(), blocked.begin(),
                 [&](Cell cell) { return static_cast<uint8_t>(isBlocked(cell, unknown_blocks)); });
  runs_ = freeRuns(blocked, width_, height_);
  const double cap_steps = std::ceil(cap / (0.5 * cell_size_));  // half cells
  if (cap_steps <= NearSquares::kWidest)
    lookNearby(blocked, static_cast<int>(cap_steps));
  else
    lookEverywhere(blocked, static_cast<float>(std::min(cap_steps, 1e6)));
}

void ClearanceField::lookNearby(const std::vector<uint8_t>& blocked, int cap_steps) {
  clearance_.resize(blocked.size());
  const auto w = static_cast<size_t>(width_);
  const auto half_cell = static_cast<float>(0.5 * cell_size_);
  // A square is an integer: its root is looked up.
  const int farthest = cap_steps * cap_steps;
  std::vector<float> roots(static_cast<size_t>(farthest) + 1);
  for (size_t i = 0; i < roots.size(); ++i)
    roots[i] = std::min(cap_, std::sqrt(static_cast<float>(i)) * half_cell);
  roots.back() = cap_;  // rounding must not reduce it: larger clearances are not distinguished
  NearSquares near(blocked, width_, height_, unknown_blocks_, cap_steps);
  near.forEachRow([&](size_t y, const int16_t* squares) {
    float* const values = clearance_.data() + y * w;
    for (size_t x = 0; x < w; ++x)
      values[x] = roots[static_cast<size_t>(std::min<int>(squares[x], farthest))];
  });
}

/// Without a cap `cap_steps` [half cells] exceeds the number of rows.
void ClearanceField::lookEverywhere(const std::vector<uint8_t>& blocked, float cap_steps) {
  clearance_ = columnDistances(blocked, width_, height_, unknown_blocks_, cap_steps);
  for (float& value : clearance_) value = value >= kFar ? kFar : value * value;
  RowEnvelope envelope(width_);
  std::vector<float> row(static_cast<size_t>(width_));
  const auto half_cell = static_cast<float>(0.5 * cell_size_);
  for (int y = 0; y < height_; ++y) {
    float* const values = clearance_.data() + static_cast<size_t>(y) * row.size();
    envelope.transform(values, width_, unknown_blocks_, row.data());
    for (size_t x = 0; x < row.size(); ++x)
      values[x] = row[x] >= kFar ? cap_ : std::min(cap_, std::sqrt(row[x]) * half_cell);
  }
}

ClearanceField::Bounds ClearanceField::bounds(const Eigen::Vector2d& p_map) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double x = p_map.x() / cell_size_ - lower_.x;
  const double y = p_map.y() / cell_size_ - lower_.y;
  const bool inside = x >= 0.0 && y >= 0.0 && x < width_ && y < height_;
  if (!inside) return {outside(p_map), kInfinity};
  const auto column = static_cast<int>(x);
  const auto row = static_cast<int>(y);
  const double value = double(clearance_[static_cast<size_t>(row) * static_cast<size_t>(width_) +
                                         static_cast<size_t>(column)]);
  const double dx = x - column - 0.5;
  const double dy = y - row - 0.5;
  if (value == 0.0 || value == kInfinity) return {value, value};
  const double from_centre = std::sqrt(dx * dx + dy * dy) * cell_size_ + kRounding * value;
  const bool capped = value >= static_cast<double>(cap_);
  return {std::max(0.0, value - from_centre), capped ? kInfinity : value + from_centre};
}

ClearanceField::Verdict ClearanceField::compareOutside(double x, double y, float near,
                                                       float far) const {
  const Bounds close = bounds({x, y});
  if (close.lower >= static_cast<double>(far)) return Verdict::kAtLeast;
  return close.upper < static_cast<double>(near) ? Verdict::kLess : Verdict::kUnsure;
}

bool ClearanceField::squareFree(double column, double row, float reach) const {
  // No farther than the window, to avoid overflow; everything outside either blocks or not.
  const double cells = std::min(static_cast<double>(reach) * per_cell_, 1.0 + width_ + height_);
  const int first = lower_.x + static_cast<int>(std::floor(column - cells));
  const int last = lower_.x + static_cast<int>(std::floor(column + cells));
  const int end = lower_.y + static_cast<int>(std::floor(row + cells));
  for (int y = lower_.y + static_cast<int>(std::floor(row - cells)); y <= end; ++y)
    if (anyBlocked(y, first, last)) return false;
  return true;
}

/// For cells of which some lie outside the window.
bool ClearanceField::anyBlockedBeyond(int y, int x, int end) const {
  if (unknown_blocks_) return true;
  if (y < 0 || y >= height_ || end < 0 || x >= width_) return false;
  const int first = std::max(x, 0);
  return runs_[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(first)] <=
         std::min(end, width_ - 1) - first;
}

double ClearanceField::outside(const Eigen::Vector2d& p_map) const {
  const bool finite = std::isfinite(p_map.x()) && std::isfinite(p_map.y());
  if (unknown_blocks_ || width_ == 0 || height_ == 0 || !finite) return 0.0;
  // The window is convex: its nearest point is closer to everything inside.
  const auto clamp = [&](double value, int lower, int size) {
    const double inset = 0.5 * cell_size_;
    return std::min(std::max(value, lower * cell_size_ + inset),
                    (lower + size) * cell_size_ - inset);
  };
  return bounds({clamp(p_map.x(), lower_.x, width_), clamp(p_map.y(), lower_.y, height_)}).lower;
}

}  // namespace tread
