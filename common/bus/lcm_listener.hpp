// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "common/bus/lcm_bus.hpp"

namespace lcm {
struct ReceiveBuffer;
}

namespace tread {

/// Receives every message of an LCM bus, without its seal: for programs that only observe. With a
/// key it passes on only messages sealed with it, and counts the others.
class LcmListener {
 public:
  /// `now`: CLOCK_MONOTONIC of this host at the receipt [us].
  using Take = std::function<void(const std::string& channel, const uint8_t* bytes, size_t size,
                                  int64_t now)>;

  /// Throws std::runtime_error with one clear line if LCM cannot be used.
  LcmListener(BusAccess access, Take take);
  ~LcmListener();
  LcmListener(const LcmListener&) = delete;
  LcmListener& operator=(const LcmListener&) = delete;

  /// Waits up to the timeout [ms] for a message and takes it and those queued behind it.
  void handle(int timeout_ms);

  /// Messages refused, by reason: "unsealed", "replayed", "too large".
  const std::map<std::string, int64_t>& refused() const { return refused_; }
  /// A one-line warning if the received data cannot be trusted; else empty.
  std::string doubt() const;

 private:
  void hear(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void refuse(const std::string& why) { ++refused_[why]; }

  Take take_;
  std::unique_ptr<lcm::LCM> lcm_;
  std::optional<BusSealer> sealer_;
  bool sealed_unread_ = false;  ///< this process has no key, but others have
  std::map<std::string, int64_t> refused_;
};

}  // namespace tread
