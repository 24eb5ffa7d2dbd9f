// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>

namespace tread::planner {

/// The node that holds each cell of the search space: an open-addressed hash table that is emptied
/// in no time, and that moves to a larger place bit by bit, so that no call takes long.
class NodeTable {
 public:
  /// What is kept for a key of at most 56 bits.
  struct Slot {
    uint64_t key;  // with the generation above it
    float cost;
    int node;
  };

  void clear() {
    outgrown_ = Slots(0);
    if (++generation_ == 0) {
      slots_ = Slots(slots_.count);
      generation_ = 1;
    }
    used_ = 0;
  }
  /// The slot of a key; its node is -1 if the key is new. Valid until the next call.
  Slot& operator[](uint64_t key) {
    if (2 * used_ > slots_.count) grow();
    if (outgrown_.count > 0) moveSome();
    const uint64_t wanted = marked(key);
    Slot& slot = slots_.at[place(slots_, wanted)];
    if (slot.key == wanted) return slot;
    slot = {wanted, 0.0F, -1};
    if (outgrown_.count > 0) {
      const Slot& before = outgrown_.at[place(outgrown_, wanted)];
      if (before.key == wanted) {
        slot = before;
        return slot;
      }
    }
    ++used_;
    return slot;
  }
  /// Says that a key will be asked for soon.
  void prefetch(uint64_t key) const {
#if defined(__GNUC__)
    __builtin_prefetch(&slots_.at[hashed(marked(key)) & (slots_.count - 1)]);
#endif
  }
  size_t bytes() const {
    return (slots_.count + outgrown_.count) * sizeof(Slot);
  }

 private:
  static constexpr size_t kLeast = 1U << 12;
  /// Slots that are moved at a time: all are before the table has to grow again.
  static constexpr size_t kMoved = 16;

  struct Release {
    void operator()(Slot* slots) const { std::free(slots); }
  };
  /// A power of two of empty slots; none is touched before it is used, as that takes long.
  struct Slots {
    explicit Slots(size_t wanted) : count(wanted) {
      if (count == 0) return;
      at.reset(static_cast<Slot*>(std::calloc(count, sizeof(Slot))));
      if (at == nullptr) throw std::bad_alloc();
    }
    size_t count;
    std::unique_ptr<Slot[], Release> at;
  };

  uint64_t marked(uint64_t key) const {
    return key | static_cast<uint64_t>(generation_) << 56U;
  }
  static size_t hashed(uint64_t marked) {
    const uint64_t hash = marked * 0x9E3779B97F4A7C15ULL;
    return static_cast<size_t>(hash ^ hash >> 29U);
  }
  /// Where a marked key is, or where it would go.
  size_t place(const Slots& slots, uint64_t marked) const {
    const size_t mask = slots.count - 1;
    size_t at = hashed(marked) & mask;
    while (slots.at[at].key >> 56U == generation_ && slots.at[at].key != marked)
      at = (at + 1) & mask;
    return at;
  }
  void grow() {
    const size_t wanted = 2 * slots_.count;
    outgrown_ = std::exchange(slots_, Slots(wanted));
    moved_ = 0;
  }
  void moveSome() {
    const size_t end = std::min(moved_ + kMoved, outgrown_.count);
    for (; moved_ < end; ++moved_) {
      const Slot& slot = outgrown_.at[moved_];
      if (slot.key >> 56U != generation_) continue;
      Slot& place_now = slots_.at[place(slots_, slot.key)];
      // What was asked for since then has moved already, and may have changed.
      if (place_now.key != slot.key) place_now = slot;
    }
    if (moved_ == outgrown_.count) outgrown_ = Slots(0);
  }

  Slots slots_{kLeast};
  Slots outgrown_{0};
  size_t moved_ = 0;  // of the outgrown ones
  uint8_t generation_ = 1;
  size_t used_ = 0;
};

}  // namespace tread::planner
