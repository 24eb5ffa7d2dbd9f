// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/fence_messages.hpp"

#include "common/messages/blank.hpp"

namespace tread {

FenceRequest requestFrom(const fence_t& message) {
  FenceRequest request;
  request.by = message.fence_by;
  request.removes = message.fence_kind == fence_t::FENCE_REMOVED;
  request.fence.name = message.fence_name;
  request.fence.keep_out = message.fence_kind == fence_t::FENCE_KEEP_OUT;
  const bool known = request.fence.keep_out || message.fence_kind == fence_t::FENCE_STAY_IN;
  for (size_t i = 0; known && i < message.corners.size(); ++i)
    if (message.corners[i].size() == 2)
      request.fence.corners.emplace_back(message.corners[i][0], message.corners[i][1]);
  return request;
}

fence_t toMessage(const FenceRequest& request) {
  auto message = blank<fence_t>();
  message.fence_by = request.by;
  message.fence_name = request.fence.name;
  const int16_t kind = request.fence.keep_out ? fence_t::FENCE_KEEP_OUT : fence_t::FENCE_STAY_IN;
  message.fence_kind = request.removes ? fence_t::FENCE_REMOVED : kind;
  for (const Eigen::Vector2d& corner : request.fence.corners)
    message.corners.push_back({corner.x(), corner.y()});
  message.num_corners = static_cast<int32_t>(message.corners.size());
  return message;
}

void FenceReport::tell(const FenceBook& book, HealthReporter& health) {
  if (book.revision() == revision_) return;
  revision_ = book.revision();
  for (const Fence& fence : book.fences())
    if (told_.size() < kMost) told_.insert(fence.name);
  for (const std::string& name : told_) health.setCounter(fenceCounter(name), book.count(name));
}

}  // namespace tread
