// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/fence/fence_book.hpp"

namespace tread {

/// A request from a message. An invalid fence gets too few corners, so that a FenceBook refuses it.
FenceRequest requestFrom(const fence_t& message);

/// Without utime and seq.
fence_t toMessage(const FenceRequest& request);

/// The fences of a FENCES message, the process's own first.
std::vector<Fence> fencesFrom(const fences_t& message);

/// Publishes the fences that a process stores, and copies operators' fences from the other process
/// that stores them: a restarted one has lost its own.
class FenceExchange {
 public:
  using Taker = std::function<void(const FenceRequest&)>;

  /// Process names as in HEALTH; `take` is called with each operator's fence of the other process.
  /// The bus must outlive this.
  FenceExchange(Bus& bus, std::string process, const std::string& other, Taker take);

  /// Call it at least twice a second.
  void step(const FenceBook& book);

 private:
  /// [us] after a removal in which the other may not know of it yet
  static constexpr int64_t kForget = 1'000'000;

  Bus& bus_;
  std::string process_;
  int64_t next_ = 0;  ///< [us]
  int64_t revision_ = -1;
  size_t kept_ = 0;
  int64_t removed_at_ = -kForget;  ///< [us]
  int64_t seq_ = 0;
};

}  // namespace tread
