// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tread::planner {

/// Nodes waiting to be expanded, in buckets of nearly equal estimate: constant time per node.
/** Within a bucket the newest comes first, which goes deep. What is taken may be stale: the caller
 * knows by the cost that was put in with it. */
class OpenList {
 public:
  struct Entry {
    int node;
    float cost;
    int next;
  };

  /// Empties it; from now on a bucket is `width` of estimate wide.
  void clear(float width) {
    std::fill(heads_.begin(), heads_.end(), -1);
    entries_.clear();
    free_ = -1;
    per_width_ = 1.0F / width;
    first_ = heads_.size();
  }
  bool empty() {
    while (first_ < heads_.size() && heads_[first_] < 0) ++first_;
    return first_ >= heads_.size();
  }
  void push(float estimate, int node, float cost) {
    // Everything beyond the last bucket shares it.
    const auto bucket =
        static_cast<size_t>(std::clamp(estimate * per_width_, 0.0F, static_cast<float>(kBuckets)));
    if (bucket >= heads_.size()) heads_.resize(bucket + 1, -1);
    int at = free_;
    if (at >= 0) {
      free_ = entries_[static_cast<size_t>(at)].next;
    } else {
      at = static_cast<int>(entries_.size());
      entries_.emplace_back();
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

  size_t bytes() const {
    return heads_.capacity() * sizeof(int) + entries_.capacity() * sizeof(Entry);
  }

 private:
  static constexpr size_t kBuckets = 1U << 16U;

  std::vector<int> heads_;
  std::vector<Entry> entries_;
  int free_ = -1;
  size_t first_ = 0;
  float per_width_ = 1.0F;
};

}  // namespace tread::planner
