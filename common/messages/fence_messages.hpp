// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <set>
#include <string>

#include <tread/fence_t.hpp>

#include "common/bus/bus.hpp"
#include "common/fence/fence_book.hpp"

namespace tread {

/// A request from a message. What is no fence keeps too few corners: a FenceBook refuses it.
FenceRequest requestFrom(const fence_t& message);

/// Without utime and seq.
fence_t toMessage(const FenceRequest& request);

/// Name of the HEALTH counter of a fence: with a hash of its kind and corners, since several may
/// bear its name.
std::string fenceCounter(const Fence& fence);
/// Whether a HEALTH counter is that of a fence of this name.
bool countsFence(const std::string& counter, const std::string& name);

/// Tells in HEALTH which fences are in force, so that tread-fence sees that they were taken, and
/// brings those of operators to the other process that keeps fences.
/** There is no counter of what is not in force. Whoever was started again and lost the operators'
 * fences gets them back from the other, whose HEALTH and FENCE it hears. */
class FenceExchange {
 public:
  /// Process names as in HEALTH. The bus must outlive this.
  FenceExchange(Bus& bus, std::string process, std::string other);

  /// Call it at least twice a second.
  void step(const FenceBook& book, HealthReporter& health);

 private:
  void send(const Fence& fence);

  Bus& bus_;
  std::string process_;
  std::optional<std::set<std::string>> others_counters_;  ///< of the other's HEALTH, if new
  int64_t next_ = 0;  ///< [us] until then no HEALTH is looked at
  int64_t revision_ = -1;
  std::set<std::string> told_;  ///< counters
  int64_t seq_ = 0;
};

}  // namespace tread
