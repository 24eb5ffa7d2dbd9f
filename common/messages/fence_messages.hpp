// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

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

/// Tells in HEALTH which fences are in force, so that tread-fence sees that they were taken. There
/// is no counter of what is not in force.
class FenceReport {
 public:
  void tell(const FenceBook& book, HealthReporter& health);

 private:
  int64_t revision_ = -1;
  std::set<std::string> told_;  ///< counters
};

}  // namespace tread
