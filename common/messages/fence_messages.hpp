// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/fence/fence_book.hpp"

namespace tread {

/// A request from a message. What is no fence keeps too few corners: a FenceBook refuses it.
FenceRequest requestFrom(const fence_t& message);

/// Without utime and seq.
fence_t toMessage(const FenceRequest& request);

/// The fences of a keeper, its own first.
std::vector<Fence> fencesFrom(const fences_t& message);

/// Publishes the fences that a process keeps, and takes over what operators have given to the other
/// keeper: whoever was started again has lost them.
class FenceExchange {
 public:
  using Taker = std::function<void(const FenceRequest&)>;

  /// Process names as in HEALTH; `take` is called with each fence that the other keeper has from an
  /// operator. The bus must outlive this.
  FenceExchange(Bus& bus, std::string process, const std::string& other, Taker take);

  /// Call it at least twice a second.
  void step(const FenceBook& book);

 private:
  /// [us] after a removal the other may not have heard of it yet.
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
