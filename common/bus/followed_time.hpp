// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

namespace tread {

/// The time of a process without a device: the newest utime received plus the steady time since.
/** One wrong utime must not move it for ever. A message that is further ahead than the largest jump
 *  is refused, unless no other message contradicts it: time jumps (another log, a hole in it) when
 * three such messages, each newer than the last, agree within a second and none of the present time
 * came for 0.2 s. At the start three that agree are enough. */
class FollowedTime {
 public:
  /// `host` is the steady clock's time [us] of this and all later calls.
  FollowedTime(int64_t host, int64_t max_jump_us) : max_jump_us_(max_jump_us), host_(host) {}

  /// Present time [us]; before the first time is believed, the time since construction.
  int64_t now(int64_t host) const { return utime_ + (host - host_); }
  /// Whether a time is believed yet.
  bool started() const { return started_; }
  /// A message of this utime came in. False if it was refused.
  bool observe(int64_t utime, int64_t host);

 private:
  bool observeCandidate(int64_t utime, int64_t host);
  void set(int64_t utime, int64_t host);

  int64_t max_jump_us_;
  int64_t utime_ = 0;
  int64_t host_;
  bool started_ = false;
  int agreeing_ = 0;       ///< messages in a row that agree about another time
  int64_t candidate_ = 0;  ///< the newest of their times, received at candidate_host_
  int64_t candidate_host_ = 0;
  int64_t first_agreeing_ = 0;  ///< host time of the first of them
};

}  // namespace tread
