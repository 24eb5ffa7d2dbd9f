// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/pattern/pattern_checksum.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace tread {
namespace {

// After Fowler-Noll-Vo 1a, 64 bit (offset basis and prime as published by its authors), but word by
// word: an eighth of the time. Folding lets high bits reach low ones, which the product alone does
// not.
class Hash {
 public:
  void add(uint64_t value) {
    value_ = (value_ ^ value) * 0x100000001b3U;
    value_ ^= value_ >> 29;
  }
  void add(int64_t value) { add(static_cast<uint64_t>(value)); }
  void add(double value) {
    uint64_t bits = 0x7ff8000000000000U;  // the one NaN
    if (!std::isnan(value)) std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  void add(const std::string& text) {
    add(static_cast<uint64_t>(text.size()));
    for (const char c : text) add(static_cast<uint64_t>(static_cast<unsigned char>(c)));
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xcbf29ce484222325U;
};

void addClass(Hash& hash, const MotionClass& motion) {
  hash.add(motion.name);
  for (const double value : {motion.twist.v_x, motion.twist.v_y, motion.twist.omega,
                             motion.steady.left, motion.steady.right})
    hash.add(value);
}

void addPattern(Hash& hash, const MotionPattern& pattern) {
  hash.add(static_cast<int64_t>(pattern.id));
  hash.add(pattern.name);
  hash.add(pattern.entry_class);
  hash.add(pattern.exit_class);
  hash.add(static_cast<uint64_t>(pattern.commands.size()));
  for (const TrackCommand& command : pattern.commands) {
    hash.add(command.left);
    hash.add(command.right);
  }
  hash.add(static_cast<uint64_t>(pattern.trajectory.size()));
  for (const Pose2& pose : pattern.trajectory) {
    hash.add(pose.x);
    hash.add(pose.y);
    hash.add(pose.yaw);
  }
  for (const double value : pattern.end_covariance) hash.add(value);
  hash.add(static_cast<int64_t>(pattern.times_learned));
}

}  // namespace

int64_t checksumOf(const PatternSetContent& content) {
  Hash hash;
  hash.add(content.name);
  hash.add(content.version);
  hash.add(content.parent_version);
  hash.add(static_cast<int64_t>(content.kind));
  hash.add(content.period_us);
  std::vector<const MotionClass*> classes;
  for (const MotionClass& motion : content.classes) classes.push_back(&motion);
  std::sort(classes.begin(), classes.end(),
            [](const MotionClass* a, const MotionClass* b) { return a->name < b->name; });
  hash.add(static_cast<uint64_t>(classes.size()));
  for (const MotionClass* motion : classes) addClass(hash, *motion);
  hash.add(static_cast<uint64_t>(content.patterns.size()));
  for (const MotionPattern& pattern : content.patterns) addPattern(hash, pattern);
  return static_cast<int64_t>(hash.value() & 0x7fffffffffffffffU);
}

}  // namespace tread
