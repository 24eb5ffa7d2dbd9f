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

/// Hears every message of an LCM bus, without its seal: for programs that only look. With a key it
/// passes on only what is sealed by it, and counts the rest.
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

  /// Waits for a message up to the timeout [ms] and takes it and those behind it.
  void handle(int timeout_ms);

  /// Messages that were not passed on, by why: "unsealed", "replayed", "too large".
  const std::map<std::string, int64_t>& refused() const { return refused_; }
  /// What a person must know of how far to trust what is shown, in one line; empty = nothing.
  std::string doubt() const;

 private:
  void hear(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void refuse(const std::string& why) { ++refused_[why]; }

  Take take_;
  std::unique_ptr<lcm::LCM> lcm_;
  std::optional<BusSealer> sealer_;
  bool sealed_unread_ = false;  ///< without a key: others have one
  std::map<std::string, int64_t> refused_;
};

}  // namespace tread
