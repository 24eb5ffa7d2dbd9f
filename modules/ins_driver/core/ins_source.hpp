// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "modules/ins_driver/core/ins_estimate.hpp"

namespace tread::ins {

/// What to look at when a device is silent or says too little; parts of HEALTH's lines.
struct InsAdvice {
  std::string silent;       ///< no bytes come
  std::string unreadable;   ///< what is missing among the bytes, for instance "no good sentence"
  std::string no_position;  ///< bytes are understood, but no position comes
  std::string no_heading;
};

/// An INS at the end of a byte stream: the door for the next one.
/** Pure: bytes and time [us] are arguments. Bytes in, with the time at which they were read; then
 * next() until it has nothing. */
class InsSource {
 public:
  virtual ~InsSource() = default;

  /// Takes bytes that were read at `arrival`.
  virtual void push(std::string_view bytes, int64_t arrival) = 0;
  /// The next finished estimate; `now` decides whether the line has been quiet.
  virtual std::optional<InsEstimate> next(int64_t now) = 0;
  /// The link was closed or the log is at its end: what is under way ends here.
  virtual void interrupt() = 0;

  /// The map's place on Earth once there is one: configured, or the first good fix.
  virtual std::optional<GeoOrigin> origin() const = 0;
  /// Host time of the last message that was understood; nothing before the first.
  virtual std::optional<int64_t> lastMessage() const = 0;
  /// Positions refused so far because they are too far from the origin, and the last one's distance
  /// [m].
  virtual std::pair<int64_t, double> tooFar() const = 0;
  /// Why bytes were not understood so far, in words.
  virtual std::string refusals() const = 0;
  virtual InsAdvice advice() const = 0;
  /// What was counted, by its name in words, in the order of HEALTH.
  virtual std::vector<std::pair<std::string, int64_t>> counters() const = 0;
};

}  // namespace tread::ins
