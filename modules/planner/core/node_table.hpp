// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

namespace tread::planner {

/// The node that holds each cell of the search space: an open-addressed hash table that is emptied
/// in no time.
class NodeTable {
 public:
  /// What is kept for a key of at most 56 bits.
  struct Slot {
    uint64_t key = 0;  // with the generation above it
    float cost = 0.0F;
    int node = -1;
  };

  NodeTable() : slots_(1U << 12) {}

  void clear() {
    if (++generation_ == 0) {
      slots_.assign(slots_.size(), Slot{});
      generation_ = 1;
    }
    used_ = 0;
  }
  /// The slot of a key; its node is -1 if the key is new. Valid until the next call.
  Slot& operator[](uint64_t key) {
    if (2 * used_ > slots_.size()) grow();
    const uint64_t wanted = marked(key);
    Slot& slot = slots_[place(wanted)];
    if (slot.key != wanted) {
      slot = {wanted, 0.0F, -1};
      ++used_;
    }
    return slot;
  }
  /// Says that a key will be asked for soon.
  void prefetch(uint64_t key) const {
#if defined(__GNUC__)
    __builtin_prefetch(&slots_[hashed(marked(key)) & (slots_.size() - 1)]);
#endif
  }
  size_t bytes() const {
    return slots_.size() * sizeof(Slot);
  }

 private:
  uint64_t marked(uint64_t key) const {
    return key | static_cast<uint64_t>(generation_) << 56U;
  }
  static size_t hashed(uint64_t marked) {
    const uint64_t hash = marked * 0x9E3779B97F4A7C15ULL;
    return static_cast<size_t>(hash ^ hash >> 29U);
  }
  /// Where a marked key is, or where it would go.
  size_t place(uint64_t marked) const {
    const size_t mask = slots_.size() - 1;
    size_t at = hashed(marked) & mask;
    while (slots_[at].key >> 56U == generation_ && slots_[at].key != marked) at = (at + 1) & mask;
    return at;
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.key >> 56U == generation_) slots_[place(slot.key)] = slot;
  }

  std::vector<Slot> slots_;
  uint8_t generation_ = 1;
  size_t used_ = 0;
};

}  // namespace tread::planner
