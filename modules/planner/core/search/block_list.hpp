// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace tread::planner {

/// A list that grows without moving what is in it: no push takes long, however long the list is.
template <class T>
class BlockList {
 public:
  T& operator[](size_t i) { return blocks_[i >> kBits][i & (kBlock - 1)]; }
  const T& operator[](size_t i) const { return blocks_[i >> kBits][i & (kBlock - 1)]; }
  size_t size() const { return size_; }
  void push_back(const T& value) {
    if (size_ == blocks_.size() * kBlock) blocks_.push_back(std::make_unique<T[]>(kBlock));
    (*this)[size_++] = value;
  }
  /// The memory is kept.
  void clear() { size_ = 0; }
  size_t bytes() const { return blocks_.size() * kBlock * sizeof(T); }

 private:
  static constexpr size_t kBits = 10;
  static constexpr size_t kBlock = size_t{1} << kBits;

  std::vector<std::unique_ptr<T[]>> blocks_;
  size_t size_ = 0;
};

}  // namespace tread::planner
