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

/// Name of the HEALTH counter that says how many fences of a name are in force.
inline std::string fenceCounter(const std::string& name) {
  return "fence " + name;
}

/// Tells in HEALTH which fences are in force, so that tread-fence sees that they were taken.
class FenceReport {
 public:
  void tell(const FenceBook& book, HealthReporter& health);

 private:
  static constexpr size_t kMost = 64;  ///< names; HEALTH has its size

  int64_t revision_ = -1;
  std::set<std::string> told_;
};

}  // namespace tread
