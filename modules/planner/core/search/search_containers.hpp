// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace tread::planner {

/// A list that grows without moving its elements: every push takes constant time, however long the
/// list is.
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

/// Nodes to be expanded, in buckets of nearly equal estimate: constant time per node.
/** A bucket holds estimates that differ by less than a 2048th, in any unit. Within a bucket the
 * newest comes first, which leads to depth-first search. An entry may be stale: the caller detects
 * this by its stored cost. */
class OpenList {
 public:
  struct Entry {
    int node;
    float cost;
    int next;
  };

  /// Empties it; estimates below `least` > 0 share the first bucket.
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
  /// Low bits of a float that do not distinguish buckets.
  static constexpr uint32_t kFineBits = 12;
  /// The bits of non-negative floats are ordered like the floats.
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

/// The node that holds each cell of the search space: an open-addressed hash table that is emptied
/// in constant time, and that moves to a larger array bit by bit, so that no call takes long.
class NodeTable {
 public:
  /// The value for a key of at most 56 bits.
  struct Entry {
    uint64_t key;  // with the generation in its upper bits
    float cost;
    int node;
  };

  void clear() {
    outgrown_ = Entries(0);
    if (++generation_ == 0) {
      entries_ = Entries(entries_.count);
      generation_ = 1;
    }
    used_ = 0;
  }
  /// The entry of a key; its node is -1 if the key is new. Valid until the next call.
  Entry& operator[](uint64_t key) {
    if (2 * used_ > entries_.count) grow();
    if (outgrown_.count > 0) moveSome();
    const uint64_t wanted = marked(key);
    Entry& entry = entries_.at[place(entries_, wanted)];
    if (entry.key == wanted) return entry;
    entry = {wanted, 0.0F, -1};
    if (outgrown_.count > 0) {
      const Entry& before = outgrown_.at[place(outgrown_, wanted)];
      if (before.key == wanted) {
        entry = before;
        return entry;
      }
    }
    ++used_;
    return entry;
  }
  /// Announces that a key will be looked up soon.
  void prefetch(uint64_t key) const {
#if defined(__GNUC__)
    __builtin_prefetch(&entries_.at[hashed(marked(key)) & (entries_.count - 1)]);
#endif
  }
  size_t bytes() const {
    return (entries_.count + outgrown_.count) * sizeof(Entry);
  }

 private:
  static constexpr size_t kLeast = 1U << 12;
  /// Entries moved at a time: all are moved before the table grows again.
  static constexpr size_t kMoved = 16;

  struct Release {
    void operator()(Entry* entries) const { std::free(entries); }
  };
  /// A power of two of empty entries; none is touched before it is used, because that is slow.
  struct Entries {
    explicit Entries(size_t wanted) : count(wanted) {
      if (count == 0) return;
      at.reset(static_cast<Entry*>(std::calloc(count, sizeof(Entry))));
      if (at == nullptr) throw std::bad_alloc();
    }
    size_t count;
    std::unique_ptr<Entry[], Release> at;
  };

  uint64_t marked(uint64_t key) const {
    return key | static_cast<uint64_t>(generation_) << 56U;
  }
  static size_t hashed(uint64_t marked) {
    const uint64_t hash = marked * 0x9E3779B97F4A7C15ULL;
    return static_cast<size_t>(hash ^ hash >> 29U);
  }
  /// The slot of a marked key, existing or free.
  size_t place(const Entries& entries, uint64_t marked) const {
    const size_t mask = entries.count - 1;
    size_t at = hashed(marked) & mask;
    while (entries.at[at].key >> 56U == generation_ && entries.at[at].key != marked)
      at = (at + 1) & mask;
    return at;
  }
  void grow() {
    const size_t wanted = 2 * entries_.count;
    outgrown_ = std::exchange(entries_, Entries(wanted));
    moved_ = 0;
  }
  void moveSome() {
    const size_t end = std::min(moved_ + kMoved, outgrown_.count);
    for (; moved_ < end; ++moved_) {
      const Entry& entry = outgrown_.at[moved_];
      if (entry.key >> 56U != generation_) continue;
      Entry& place_now = entries_.at[place(entries_, entry.key)];
      // Entries looked up since then have moved already, and may have changed.
      if (place_now.key != entry.key) place_now = entry;
    }
    if (moved_ == outgrown_.count) outgrown_ = Entries(0);
  }

  Entries entries_{kLeast};
  Entries outgrown_{0};
  size_t moved_ = 0;  // of the old array
  uint8_t generation_ = 1;
  size_t used_ = 0;
};

}  // namespace tread::planner
