// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/fence/fence_book.hpp"
#include "common/store/store.hpp"

namespace tread {

/// Operators' fences, as stored across restarts.
struct KeptFences {
  std::vector<Fence> holders;  ///< of operators who held the robot
  std::vector<Fence> others;
  bool lost = false;  ///< some were stored but cannot be read
};

/// Reads them from the store. Each of the two entries has a checksum, and a third entry states that
/// both must exist: if one is missing, empty or damaged, it counts as lost and none of it is used.
KeptFences readFences(const Store& store);
/// Returns one clear line if they could not be written.
std::optional<std::string> writeFences(Store& store, const KeptFences& fences);

}  // namespace tread
