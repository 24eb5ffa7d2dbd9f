// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

namespace tread::planner {

/// Best cost found so far for each cell of the search space: an open-addressed hash table that is
/// emptied in no time.
class NodeTable {
 public:
  NodeTable() : slots_(1U << 12) {}

  void clear() {
    ++generation_;
    used_ = 0;
  }
  /// The cost kept for a key; nullptr if there is none. Valid until the next put().
  const float* find(uint64_t key) const {
    const Slot& slot = slots_[place(key)];
    return slot.generation == generation_ ? &slot.cost : nullptr;
  }
  void put(uint64_t key, float cost) {
    Slot& slot = slots_[place(key)];
    if (slot.generation != generation_) ++used_;
    slot = {key, generation_, cost};
    if (2 * used_ > slots_.size()) grow();
  }

 private:
  struct Slot {
    uint64_t key = 0;
    uint32_t generation = 0;
    float cost = 0.0F;
  };

  /// Where a key is, or where it would go.
  size_t place(uint64_t key) const {
    const size_t mask = slots_.size() - 1;
    uint64_t hash = key * 0x9E3779B97F4A7C15ULL;
    hash ^= hash >> 29;
    size_t at = static_cast<size_t>(hash) & mask;
    while (slots_[at].generation == generation_ && slots_[at].key != key) at = (at + 1) & mask;
    return at;
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.generation == generation_) slots_[place(slot.key)] = slot;
  }

  std::vector<Slot> slots_;
  uint32_t generation_ = 1;
  size_t used_ = 0;
};

}  // namespace tread::planner
