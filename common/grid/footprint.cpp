// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/grid/footprint.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace tread {
namespace {

/// Less than this share of a cell is rounding, not overlap.
constexpr double kTouch = 1e-8;

/// Faster than the library's, for cell numbers below 2^31.
int floorOf(double value) {
  const int whole = static_cast<int>(value);
  return whole - static_cast<int>(value < whole);
}
int ceilOf(double value) {
  const int whole = static_cast<int>(value);
  return whole + static_cast<int>(value > whole);
}

/// A rectangle in the body's axes, from `rear` to `front` along x [m].
struct Extent {
  double rear;
  double front;
  double half_width;
};

/// The rows of cells that an oriented rectangle overlaps, each with its span of columns.
/** A row's band cuts a convex piece out of the rectangle: the cells between the ends of that piece
 * are exactly those that overlap the rectangle. Lengths are cells, relative to the cell `base`. */
class RowSpans {
 public:
  RowSpans(const Extent& extent, const TurnedPose& T_map_body, double cell_size)
      : base_{static_cast<int>(std::floor(T_map_body.x / cell_size)),
              static_cast<int>(std::floor(T_map_body.y / cell_size))} {
    const double c = T_map_body.cos_yaw;
    const double s = T_map_body.sin_yaw;
    const double front = extent.front / cell_size;
    const double rear = extent.rear / cell_size;
    const double w = extent.half_width / cell_size;
    const double x = T_map_body.x / cell_size - base_.x;
    const double y = T_map_body.y / cell_size - base_.y;
    y_min_ = y + s * (s > 0.0 ? rear : front) - std::abs(c) * w;
    y_max_ = y + s * (s > 0.0 ? front : rear) + std::abs(c) * w;
    const double side = s > 0.0 ? w : -w;  // of the leftmost corner
    y_leftmost_ = y + s * (c > 0.0 ? rear : front) + c * side;
    y_rightmost_ = y + s * (c > 0.0 ? front : rear) - c * side;
    // Front and rear: rear <= c dx + s dy <= front. Sides: -w <= c dy - s dx <= w.
    if (std::abs(c) > kLevel) across_ = between(rear / c, front / c, -s / c, x, y);
    if (std::abs(s) > kLevel) along_ = between(-w / s, w / s, c / s, x, y);
  }

  int firstRow() const { return base_.y + floorOf(y_min_ + kTouch); }
  int lastRow() const { return base_.y + ceilOf(y_max_ - kTouch) - 1; }

  struct Span {
    int first;
    int last;  // inclusive
  };
  Span span(int row) const {
    const double low = std::max(static_cast<double>(row - base_.y), y_min_);
    const double high = std::min(static_cast<double>(row - base_.y) + 1.0, y_max_);
    const double y_left = std::min(std::max(y_leftmost_, low), high);
    const double y_right = std::min(std::max(y_rightmost_, low), high);
    const double left = std::max(across_.left + across_.slope * y_left,  //
                                 along_.left + along_.slope * y_left);
    const double right =
        std::min(across_.right + across_.slope * y_right, along_.right + along_.slope * y_right);
    return {base_.x + floorOf(left + kTouch), base_.x + ceilOf(right - kTouch) - 1};
  }

 private:
  /// Borders closer to horizontal than this bound only the rows, not the columns.
  static constexpr double kLevel = 1e-9;

  /// Two parallel borders: left + slope y <= x <= right + slope y.
  struct Strip {
    double left = -1e9;
    double right = 1e9;
    double slope = 0.0;
  };
  static Strip between(double a, double b, double slope, double x, double y) {
    const double offset = x - slope * y;
    return {std::min(a, b) + offset, std::max(a, b) + offset, slope};
  }

  CellIndex base_;
  Strip across_;
  Strip along_;
  double y_min_;
  double y_max_;
  double y_leftmost_;
  double y_rightmost_;
};

/// Poses whose cell numbers exceed int overlap no cell of any grid.
bool isUsable(const TurnedPose& pose, double cell_size) {
  const double reach = 1e9 * cell_size;
  return std::abs(pose.x) < reach && std::abs(pose.y) < reach && std::isfinite(pose.cos_yaw);
}

/// The next float above a length, for conservative comparisons.
float roundedUp(double length) {
  return std::nextafter(static_cast<float>(length), std::numeric_limits<float>::infinity());
}

float roundedDown(double length) {
  return std::nextafter(static_cast<float>(length), 0.0F);
}

/// Calls visit(cell) for the cells that the footprint overlaps, row by row.
template <class Visit>
void visitCells(const FootprintSize& size, const Pose2& T_map_body, double cell_size,
                const Visit& visit) {
  const RowSpans rows({-size.rear, size.front, size.half_width}, turned(T_map_body), cell_size);
  for (int y = rows.firstRow(); y <= rows.lastRow(); ++y) {
    const RowSpans::Span span = rows.span(y);
    for (int x = span.first; x <= span.last; ++x) visit(CellIndex{x, y});
  }
}

}  // namespace

Footprint::Footprint(const FootprintSize& size, double margin) : size_(size.widened(margin)) {
  const auto& [front, rear, half_width] = size_;
  const double length = size_.length();
  if (!(length > 0.0) || !(half_width > 0.0) || !std::isfinite(length + half_width))
    throw std::invalid_argument("footprint: length and width must be positive and finite");
  circumscribed_ = std::hypot(std::max(std::abs(front), std::abs(rear)), half_width);
  // With one disc per half width the discs protrude by 12 % of it; more would hardly help.
  const double count = std::min(8.0, std::max(1.0, std::ceil(length / half_width)));
  const double step = length / count;
  for (double i = 0.5; i < count; ++i) disc_x_.push_back(-rear + i * step);
  half_step_ = 0.5 * step;
  circumscribed_up_ = roundedUp(circumscribed_);
  disc_radius_ = roundedUp(std::hypot(0.5 * step, half_width));
  inscribed_ = roundedDown(std::max(0.0, std::min({front, rear, half_width})));
  inscribed_radius_ = roundedDown(std::min(0.5 * step, half_width));
}

Footprint::Unsure Footprint::judgeByDiscs(const ClearanceField& clearance,
                                          const TurnedPose& T_map_body) const {
  Unsure unsure;
  for (const double along : disc_x_) {
    const double x = T_map_body.x + T_map_body.cos_yaw * along;
    const double y = T_map_body.y + T_map_body.sin_yaw * along;
    const Verdict disc = clearance.compare(x, y, inscribed_radius_, disc_radius_);
    if (disc == Verdict::kAtLeast) continue;
    unsure.blocked = disc == Verdict::kLess;
    if (unsure.blocked) return unsure;
    unsure.rear = std::min(unsure.rear, along - half_step_);
    unsure.front = along + half_step_;
  }
  return unsure;
}

bool Footprint::isFree(const ClearanceField& clearance, const TurnedPose& T_map_body) const {
  if (!isUsable(T_map_body, clearance.cellSize())) return false;
  const Verdict whole =
      clearance.compare(T_map_body.x, T_map_body.y, inscribed_, circumscribed_up_);
  if (whole != Verdict::kUnsure) return whole == Verdict::kAtLeast;
  const Unsure unsure = judgeByDiscs(clearance, T_map_body);
  if (unsure.blocked || unsure.front < unsure.rear) return !unsure.blocked;
  const RowSpans rows({unsure.rear, unsure.front, size_.half_width}, T_map_body,
                      clearance.cellSize());
  for (int y = rows.firstRow(); y <= rows.lastRow(); ++y) {
    const RowSpans::Span span = rows.span(y);
    if (clearance.anyBlocked(y, span.first, span.last)) return false;
  }
  return true;
}

std::vector<CellIndex> Footprint::cells(const Grid& grid, const Pose2& T_map_body) const {
  std::vector<CellIndex> covered;
  if (!isUsable(turned(T_map_body), grid.cellSize())) return covered;
  visitCells(size_, T_map_body, grid.cellSize(), [&](CellIndex cell) { covered.push_back(cell); });
  return covered;
}

int Footprint::blockedCells(const Grid& grid, const Pose2& T_map_body, bool unknown_blocks) const {
  int count = 0;
  if (!isUsable(turned(T_map_body), grid.cellSize())) return count;
  visitCells(size_, T_map_body, grid.cellSize(),
             [&](CellIndex cell) { count += isBlocked(grid.at(cell), unknown_blocks) ? 1 : 0; });
  return count;
}

}  // namespace tread
