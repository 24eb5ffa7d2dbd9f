// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace tread {

/// Estimates the robot's time of each event of a log the same way as its processes do: the newest
/// utime received plus the time passed since (FollowedTime).
/** A recorder dates events with its own clock: in virtual time that of the robot, with lcm-logger
 * UTC; either may be set while it runs. A stamp is an event that contains the robot's time of
 * sending. The least lead of the recorder's clock over the stamps is subtracted from its times. An
 * event whose time fits neither the previous one nor this lead waits for the stamps after it: if
 * most of them agree with it, a clock was set or nothing was sent for a while; otherwise its time
 * is wrong, and it happened between its neighbours. If the robot's own clock restarted (with its
 * host), times continue. */
class DriveClock {
 public:
  /// When an event took place.
  struct Dated {
    int64_t utime = 0;    ///< [us] of the robot's clock; never decreases, never negative
    bool wrong = false;   ///< the time in the event is impossible
    size_t restarts = 0;  ///< how often the robot's clock had restarted before it
  };

  /// Adds the next event: when it was recorded, and the robot time in it, if any [us].
  void add(int64_t recorded, std::optional<int64_t> utime);
  /// No event follows.
  void close() { closed_ = true; }
  /// The time of the oldest event not yet returned; nullopt if more events are needed or none is
  /// left.
  std::optional<Dated> next();

  /// Problems of the clocks, one line each; complete after the last event.
  std::vector<std::string> notes() const;

 private:
  struct Tick {
    int64_t recorded = 0;
    std::optional<int64_t> utime;
  };
  /// The recorder's clock seems to have been set. Until more stamps come, the recorder may just
  /// have been delayed.
  struct Step {
    int64_t at = 0;      ///< [us] robot's time
    int64_t before = 0;  ///< [us] offset
  };
  struct Jump {
    int64_t at = 0;
    int64_t by = 0;  ///< [us]
  };

  bool knowsEnough() const;
  void begin();
  bool beginWithBurst(const std::vector<const Tick*>& agreeing);
  void beginWithoutStamps();
  static bool isThousandfold(int64_t recorded, int64_t passed);
  static bool isThousandfoldWithoutLargestStep(const std::vector<const Tick*>& stamps);
  void convertNanoseconds();
  int64_t offsetOf(const Tick& stamp) const { return stamp.recorded - *stamp.utime - shift_; }
  bool isOneClock() const;
  int64_t timeOf(const Tick& tick) const;
  bool isNear(const Tick& stamp) const;
  std::optional<int64_t> fitting(const Tick& tick);
  Dated judge(const Tick& tick);
  bool goesOn(const Tick& stamp) const;
  bool agreesWithNext(size_t index) const;
  std::optional<int64_t> between(const Tick& tick);
  std::optional<int64_t> byRecorder(const Tick& tick);
  void take(const Tick& stamp);
  void follow(int64_t offset);
  void step(int64_t offset);
  bool isCatchingUp() const;

  std::deque<Tick> ticks_;  ///< not asked for yet
  size_t stamps_ = 0;       ///< among them
  bool closed_ = false;
  bool begun_ = false;
  bool stamped_ = false;    ///< a stamp was believed
  bool slow_ = false;       ///< stamps are many seconds apart
  int64_t scale_ = 1;       ///< recorder units per microsecond
  int64_t first_ = 0;       ///< [us] time of the first event
  int64_t last_ = 0;        ///< [us] of the last event
  int64_t last_stamp_ = 0;  ///< [us] of the last accepted stamp
  int64_t offset_ = 0;      ///< [us] least lead of the recorder's clock over the robot's
  bool one_clock_ = false;  ///< the recorder's clock is the robot's
  int64_t shift_ = 0;       ///< [us] that the robot's clock lost at its restarts
  int64_t earliest_ = 0;    ///< [us] offset of the first one of the last stamps
  int64_t least_ = 0;       ///< [us] and of the fastest one
  int counted_ = 0;         ///< stamps of these
  std::optional<Step> step_;
  std::vector<Jump> jumps_;
  std::vector<int64_t> restarts_;  ///< [us]
};

}  // namespace tread
