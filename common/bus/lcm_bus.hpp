// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <atomic>
#include <memory>

#include "common/bus/bus.hpp"
#include "common/bus/life_sign.hpp"

namespace lcm {
class LCM;
}

namespace tread {

/// The time of a process without a device: the newest utime received plus the steady time since.
/** One wrong utime must not move it forever. A message that is further ahead than the largest jump
 * is refused, unless no other message contradicts it: time jumps (another log, a gap in it) when
 * three such messages, each newer than the last, agree within a second and none of the present
 * time came for 0.2 s. At the start three agreeing messages are enough. */
class FollowedTime {
 public:
  /// `host` is the steady clock's time [us] of this and all later calls.
  FollowedTime(int64_t host, int64_t max_jump_us) : max_jump_us_(max_jump_us), host_(host) {}

  /// Present time [us]; before the first accepted time, the time since construction.
  int64_t now(int64_t host) const { return utime_ + (host - host_); }
  /// Whether a time has been accepted yet.
  bool started() const { return started_; }
  /// A message with this utime was received. False if it was refused.
  bool observe(int64_t utime, int64_t host);

 private:
  bool observeCandidate(int64_t utime, int64_t host);
  void set(int64_t utime, int64_t host);

  int64_t max_jump_us_;
  int64_t utime_ = 0;
  int64_t host_;
  bool started_ = false;
  int agreeing_ = 0;       ///< consecutive messages that agree on another time
  int64_t candidate_ = 0;  ///< the newest of their times, received at candidate_host_
  int64_t candidate_host_ = 0;
  int64_t first_agreeing_ = 0;  ///< host time of the first of them
};

/// Where a process takes its time from.
enum class TimeSource {
  kHost,   ///< CLOCK_MONOTONIC: for processes with a device, which stamp their own measurements
  kFollow  ///< newest utime received plus steady time since, so that replay works: for all others;
           ///< see FollowedTime
};

/// How a process reaches the bus.
struct BusAccess {
  std::string url;               ///< LCM provider; empty = LCM_DEFAULT_URL or LCM's own default
  std::optional<Sealer> sealer;  ///< see hostSealer() and stationSealer()
};

/// Bus over real LCM.
/** Fails at once, with the commands to type, if there is no multicast route. UBSan: g++ 12 with
 * -fsanitize=vptr crashes in lcm-cpp, so the sanitizer preset disables that check. */
class LcmBus : public Bus {
 public:
  /// A message whose utime is further ahead does not move the followed time by itself [us]; nodes
  /// accept messages up to this far ahead.
  static constexpr int64_t kMaxJump = 100'000;

  /// Throws std::runtime_error with one clear line if LCM cannot be used.
  LcmBus(BusAccess access, TimeSource time_source, int64_t max_jump_us = kMaxJump);
  LcmBus(const std::string& url, TimeSource time_source)
      : LcmBus(BusAccess{url, std::nullopt}, time_source) {}
  ~LcmBus() override;

  int64_t now() const override;
  int64_t bootId() const override { return boot_id_; }
  int64_t utc() const override;
  CycleTimes takeCycleTimes() override;
  void tellStarter(const std::string& line) override { life_.tell(line); }

  /// Runs the node until `stop` becomes true: handles messages as they arrive, calls step() at its
  /// period, then shutdown(). If a step throws, shutdown() is called and the exception is rethrown.
  void run(Node& node, const std::atomic<bool>& stop);
  /// Waits up to the timeout [ms] for a message and handles it and those queued behind it; for
  /// tools.
  void handle(int timeout_ms);
  /// Used by run(); for processes with a loop of their own.
  LifeSign& lifeSign() { return life_; }

 protected:
  bool send(const char* channel, const uint8_t* bytes, size_t size) override;
  void listen(const char* channel) override;
  /// The host's clock, even where now() follows the messages: a replayed log does not change the
  /// seals' clock.
  int64_t sealClock() const override;
  bool onReceipt(int64_t utime) override;

 private:
  struct Subscription;
  void runSteps(Node& node, const std::atomic<bool>& stop);
  void noteCycle(int64_t microseconds);

  std::unique_ptr<lcm::LCM> lcm_;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  TimeSource time_source_;
  int64_t boot_id_;
  FollowedTime followed_;
  LifeSign life_;
  int64_t cycles_ = 0;
  int64_t cycle_sum_ = 0;
  int64_t cycle_max_ = 0;
};

}  // namespace tread
