// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

namespace tread::motor {

/// When the INS counts as lost.
struct InsLimits {
  int64_t period_us = 20'000;        ///< of the INS [us]
  int64_t max_latency_us = 200'000;  ///< from measurement to receipt [us]
  int64_t max_future_us = 50'000;    ///< clock difference allowed [us]

  /// Longest silence allowed [us]: three periods, at least 100 ms.
  int64_t maxAge() const { return std::max<int64_t>(3 * period_us, 100'000); }
};

/// One INS message as far as motion depends on it.
struct InsNotice {
  int64_t utime = 0;   ///< [us] of the measurement
  bool usable = true;  ///< position and heading are known
};

/// Watches that the INS goes on telling where the robot is.
/** A message counts only if its utime is newer than the last one's: a source that repeats its last
    measurement is as good as silent. */
class InsWatch {
 public:
  explicit InsWatch(const InsLimits& limits) : limits_(limits) {}

  /// A message received at now [us].
  void receive(const InsNotice& notice, int64_t now);
  /// What is wrong at now [us], in words; empty = nothing.
  std::string fault(int64_t now) const;

 private:
  InsLimits limits_;
  std::optional<int64_t> received_at_;
  int64_t utime_ = 0;
  bool usable_ = false;
};

/// A request to arm or disarm, as sent.
struct ArmRequest {
  int64_t utime = 0;  ///< [us] when the operator gave it
  bool armed = false;
  std::string by;
  std::string why;
};

/// An emergency stop or its clearing, as sent.
struct EstopRequest {
  int64_t utime = 0;  ///< [us]
  bool engaged = true;
  std::string by;
  std::string why;
};

/// Sorts the operator's requests: an old permission counts for nothing, a stop always counts.
class OperatorRequests {
 public:
  /// What a request to arm or disarm leads to.
  enum class Effect { kIgnored, kArm, kDisarm };
  /// Classifies a request received at now [us]; one to arm must have been given after disarmed_at
  /// [us].
  Effect classify(const ArmRequest& request, int64_t now, int64_t disarmed_at);
  /// A request to arm was served: its repetitions are worth nothing any more.
  void consume(const ArmRequest& request) { served_utime_ = request.utime; }

  /// An E-stop message received at now [us]. Returns false if it was ignored.
  bool receive(const EstopRequest& request, int64_t now);
  bool estop() const { return engaged_; }
  /// Who stopped and why; empty if not engaged.
  const std::string& estopReason() const { return reason_; }

 private:
  bool timely(int64_t utime, int64_t now) const;

  int64_t served_utime_ = -1;
  bool engaged_ = false;
  int64_t engaged_utime_ = 0;
  std::string reason_;
};

}  // namespace tread::motor
