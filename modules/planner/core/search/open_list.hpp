// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "modules/planner/core/search/block_list.hpp"

namespace tread::planner {

/// Nodes waiting to be expanded, in buckets of nearly equal estimate: constant time per node.
/** A bucket holds estimates that differ by less than a 2048th, whatever their unit. Within a bucket
 * the newest comes first, which goes deep. What is taken may be stale: the caller knows by the cost
 * that was put in with it. */
class OpenList {
 public:
  struct Entry {
    int node;
    float cost;
    int next;
  };

  /// Empties it; smaller estimates than `least` > 0 will share the first bucket.
  void clear(float least) {
    least_ = std::max(1e-6F, least);
    heads_.clear();
    entries_.clear();
    free_ = -1;
    first_ = 0;
  }
  bool empty() {
    while (first_ < heads_.size() && heads_[first_] < 0) ++first_;
    return first_ >= heads_.size();
  }
  /// `estimate` is not negative.
  void push(float estimate, int node, float cost) {
    const size_t bucket = bucketOf(estimate);
    if (bucket >= heads_.size()) heads_.resize(bucket + 1, -1);
    int at = free_;
    if (at >= 0) {
      free_ = entries_[static_cast<size_t>(at)].next;
    } else {
      at = static_cast<int>(entries_.size());
      entries_.push_back({});
    }
    entries_[static_cast<size_t>(at)] = {node, cost, heads_[bucket]};
    heads_[bucket] = at;
    first_ = std::min(first_, bucket);
  }
  /// The newest of the first bucket; only if it is not empty().
  Entry take() {
    const int at = heads_[first_];
    const Entry entry = entries_[static_cast<size_t>(at)];
    heads_[first_] = entry.next;
    entries_[static_cast<size_t>(at)].next = free_;
    free_ = at;
    return entry;
  }

  size_t bytes() const { return heads_.capacity() * sizeof(int) + entries_.bytes(); }

 private:
  /// Bits of a float that tell no buckets apart.
  static constexpr uint32_t kFineBits = 12;
  /// The bits of floats that are not negative rise as the floats do.
  static uint32_t bitsOf(float value) {
    uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    return bits >> kFineBits;
  }
  size_t bucketOf(float estimate) const {
    return bitsOf(std::max(least_, estimate)) - bitsOf(least_);
  }

  std::vector<int> heads_;
  BlockList<Entry> entries_;
  float least_ = 1e-3F;
  int free_ = -1;
  size_t first_ = 0;
};

}  // namespace tread::planner
