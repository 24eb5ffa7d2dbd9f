// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace lcm {
class LCM;
struct ReceiveBuffer;
}  // namespace lcm

namespace tread {

/// Hears every message of an LCM bus as it is, sealed or not: for programs that only look.
class LcmListener {
 public:
  /// `now`: CLOCK_MONOTONIC of this host at the receipt [us].
  using Take = std::function<void(const std::string& channel, const uint8_t* bytes, size_t size,
                                  int64_t now)>;

  /// Throws std::runtime_error with one clear line if LCM cannot be used.
  LcmListener(const std::string& url, Take take);
  ~LcmListener();
  LcmListener(const LcmListener&) = delete;
  LcmListener& operator=(const LcmListener&) = delete;

  /// Waits for a message up to the timeout [ms] and takes it and those behind it.
  void handle(int timeout_ms);

 private:
  void hear(const lcm::ReceiveBuffer* buffer, const std::string& channel);

  Take take_;
  std::unique_ptr<lcm::LCM> lcm_;
};

}  // namespace tread
