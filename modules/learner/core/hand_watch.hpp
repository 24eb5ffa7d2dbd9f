// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/pattern/pattern.hpp"

namespace tread::learner {

/// A command to the motors, with its start time and its source.
struct GivenCommand : TimedCommand {
  bool by_hand = false;
};

/// A part of manual driving that equals an execution of a pattern, or the beginning of one.
struct HandDrivenPattern {
  int pattern_id = 0;
  int64_t started = 0;  ///< [us] when its first command took effect
  int64_t ended = 0;    ///< [us] end of its last command's period
  bool completed = false;
};

/// Finds patterns in manual driving.
/** A rule learns only from patterns, so manual driving is used where its commands equal a
 * pattern's, one for one, after half a second of the steady command of the pattern's entry class.
 * The longest pattern counts; if none was completed, the longest beginning of one from which the
 * driver departed. Parts do not overlap. Whether the motion also matched the entry class is
 * checked by the gates. Pure: time comes with the commands. */
class HandWatch {
 public:
  /// Takes the commands in order of time. `lost`: some before this one are missing.
  void add(const GivenCommand& given, bool lost);
  /// Whether a command, from any source, was held without interruption for half a second before a
  /// time.
  bool steadyBefore(const Command& command, int64_t utime, int64_t period_us) const;
  /// The patterns of a set that have ended since the last call, in order of time, with or without
  /// beginnings.
  std::vector<HandDrivenPattern> take(const PatternSet& set, bool beginnings);

 private:
  /// How many of a pattern's commands were driven manually from a time on; nullopt while it may
  /// still continue; 0 if the bridge, not the driver, ended it.
  std::optional<size_t> driven(const PatternSet& set, const MotionPattern& pattern,
                               int64_t start) const;
  std::optional<HandDrivenPattern> longestFrom(int64_t start, const PatternSet& set,
                                               bool beginnings, bool& not_yet) const;
  bool given(const Command& command, int64_t utime) const;
  const GivenCommand* at(int64_t utime) const;
  int64_t nextStart(int64_t start, int64_t period_us) const;

  std::deque<GivenCommand> given_;  ///< changes only, oldest first
  int64_t newest_ = 0;              ///< [us] the last command taken
  int64_t start_ = 0;               ///< [us] where the next pattern may begin
};

}  // namespace tread::learner
