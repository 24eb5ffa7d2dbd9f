// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/grid/grid.hpp"

namespace tread::mapping {

/// A square of elements with indices fixed in map; what moves out is forgotten, what comes in is
/// new.
template <class Element>
class Window {
 public:
  explicit Window(int side)
      : side_(side), elements_(static_cast<size_t>(side) * static_cast<size_t>(side)) {}

  int side() const { return side_; }
  CellIndex lower() const { return lower_; }
  size_t size() const { return elements_.size(); }
  bool contains(CellIndex index) const {
    return index.x >= lower_.x && index.y >= lower_.y && index.x < lower_.x + side_ &&
           index.y < lower_.y + side_;
  }
  size_t offset(CellIndex index) const {
    return static_cast<size_t>(index.y - lower_.y) * static_cast<size_t>(side_) +
           static_cast<size_t>(index.x - lower_.x);
  }
  CellIndex indexOf(size_t offset) const {
    const auto side = static_cast<size_t>(side_);
    return {lower_.x + static_cast<int>(offset % side), lower_.y + static_cast<int>(offset / side)};
  }
  Element& operator[](size_t offset) { return elements_[offset]; }
  const Element& operator[](size_t offset) const { return elements_[offset]; }
  Element& at(CellIndex index) { return elements_[offset(index)]; }
  const Element& at(CellIndex index) const { return elements_[offset(index)]; }

  /// Keeps the elements that old and new window share.
  void moveTo(CellIndex lower) {
    Window moved(side_);
    moved.lower_ = lower;
    const int x_from = std::max(lower.x, lower_.x);
    const int x_to = std::min(lower.x, lower_.x) + side_;
    const int y_to = std::min(lower.y, lower_.y) + side_;
    for (int y = std::max(lower.y, lower_.y); y < y_to && x_from < x_to; ++y)
      std::copy_n(elements_.begin() + static_cast<std::ptrdiff_t>(offset({x_from, y})),
                  x_to - x_from,
                  moved.elements_.begin() + static_cast<std::ptrdiff_t>(moved.offset({x_from, y})));
    *this = std::move(moved);
  }

 private:
  int side_;
  CellIndex lower_;
  std::vector<Element> elements_;
};

}  // namespace tread::mapping
