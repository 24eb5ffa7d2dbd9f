// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

namespace tread::launch {

/// Measures how long the machine keeps a sleeping thread waiting, to judge real-time measurements
/// made meanwhile.
class StallWatch {
 public:
  StallWatch() : thread_([this] { watch(); }) {}
  ~StallWatch() {
    stop_ = true;
    thread_.join();
  }
  StallWatch(const StallWatch&) = delete;
  StallWatch& operator=(const StallWatch&) = delete;

  /// The longest so far [s].
  double longest() const { return longest_; }

 private:
  void watch() {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds kSleep{5};
    while (!stop_) {
      const auto before = Clock::now();
      std::this_thread::sleep_for(kSleep);
      const std::chrono::duration<double> over = Clock::now() - before - kSleep;
      longest_ = std::max(longest_.load(), over.count());
    }
  }

  std::atomic<bool> stop_{false};
  std::atomic<double> longest_{0.0};
  std::thread thread_;
};

}  // namespace tread::launch
