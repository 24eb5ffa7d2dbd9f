// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/fence/fence_book.hpp"

#include <algorithm>

namespace tread {

const char* describe(FenceReceipt receipt) {
  switch (receipt) {
    case FenceReceipt::kAdded:
      return "added";
    case FenceReceipt::kKnown:
      return "in force already";
    case FenceReceipt::kRemoved:
      return "removed";
    case FenceReceipt::kNotThere:
      return "nothing of that name that an operator has added";
    case FenceReceipt::kForbidden:
      return "only the operator who holds the robot may remove a fence";
    case FenceReceipt::kInvalid:
      return "not a polygon of 3 to 64 corners with a name";
    case FenceReceipt::kFull:
      return "too many fences";
  }
  return "unknown";
}

int64_t FenceBook::count(const std::string& name) const {
  return std::count_if(fences_.begin(), fences_.end(),
                       [&](const Fence& fence) { return fence.name == name; });
}

FenceReceipt FenceBook::take(const FenceRequest& request, bool holds) {
  if (!request.removes) {
    if (!faultOf(request.fence).empty()) return FenceReceipt::kInvalid;
    const bool known = std::find(fences_.begin(), fences_.end(), request.fence) != fences_.end();
    if (known) return FenceReceipt::kKnown;
    if (fences_.size() >= kMost) return FenceReceipt::kFull;
    fences_.push_back(request.fence);
    ++revision_;
    return FenceReceipt::kAdded;
  }
  if (!holds) return FenceReceipt::kForbidden;
  const auto gone =
      std::remove_if(fences_.begin() + static_cast<std::ptrdiff_t>(own_), fences_.end(),
                     [&](const Fence& fence) { return fence.name == request.fence.name; });
  if (gone == fences_.end()) return FenceReceipt::kNotThere;
  fences_.erase(gone, fences_.end());
  ++revision_;
  return FenceReceipt::kRemoved;
}

}  // namespace tread
