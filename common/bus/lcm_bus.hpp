// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <atomic>
#include <memory>

#include "common/bus/bus.hpp"

namespace lcm {
class LCM;
}

namespace tread {

/// Where a process takes its time from.
enum class TimeSource {
  kHost,   ///< CLOCK_MONOTONIC: processes with a device, which stamp what they measure
  kFollow  ///< newest utime received plus steady time since: all others, so that replay works
};

/// Bus over real LCM.
/** Fails at once, with the commands to type, where there is no multicast route. UBSan: g++ 12 with
 *  -fsanitize=vptr crashes in lcm-cpp, so the sanitizer preset switches that check off. */
class LcmBus : public Bus {
 public:
  /// Throws std::runtime_error with one clear line if LCM cannot be used.
  LcmBus(const std::string& url, TimeSource time_source);
  ~LcmBus() override;

  int64_t now() const override;
  int64_t bootId() const override { return boot_id_; }
  int64_t utc() const override;
  CycleTimes takeCycleTimes() override;

  /// Runs the node until `stop` becomes true: messages as they come, step() at its period; then
  /// shutdown().
  void run(Node& node, const std::atomic<bool>& stop);
  /// Handles what comes within the timeout [ms]; for tools.
  void handle(int timeout_ms);

 protected:
  bool send(const char* channel, const uint8_t* bytes, size_t size) override;
  void listen(const char* channel, RawHandler handler) override;
  void onReceipt(int64_t utime) override;

 private:
  struct Subscription;
  void noteCycle(int64_t microseconds);

  std::unique_ptr<lcm::LCM> lcm_;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  TimeSource time_source_;
  int64_t newest_utime_ = 0;
  int64_t newest_host_ = 0;
  int64_t boot_id_;
  int64_t cycles_ = 0;
  int64_t cycle_sum_ = 0;
  int64_t cycle_max_ = 0;
};

}  // namespace tread
