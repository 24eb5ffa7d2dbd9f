// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/fence/fence_book.hpp"
#include "common/store/store.hpp"

namespace tread {

/// Operators' fences, as they outlive a process.
struct KeptFences {
  std::vector<Fence> holders;  ///< of those who held the robot
  std::vector<Fence> others;
  bool lost = false;  ///< there were some that cannot be read any more
};

/// Of the store. Each entry has a checksum, and a third one says that the two must be there: what
/// is missing, empty or damaged is lost, and nothing of it is believed.
KeptFences readFences(const Store& store);
/// Returns one clear line if they could not be written.
std::optional<std::string> writeFences(Store& store, const KeptFences& fences);

}  // namespace tread
