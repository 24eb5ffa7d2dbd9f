// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/fence_messages.hpp"

#include <algorithm>
#include <utility>

#include "common/messages/blank.hpp"

namespace tread {
namespace {

constexpr int64_t kPeriod = 1'000'000;  // [us]

}  // namespace

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

std::vector<Fence> fencesFrom(const fences_t& message) {
  std::vector<Fence> fences;
  for (const fence_t& fence : message.fences) fences.push_back(requestFrom(fence).fence);
  return fences;
}

FenceExchange::FenceExchange(Bus& bus, std::string process, const std::string& other, Taker take)
    : bus_(bus), process_(std::move(process)) {
  bus.overhear<fences_t>(kFences, [this, other, take = std::move(take)](const fences_t& message) {
    if (message.keeper != other || bus_.now() - removed_at_ < kForget) return;
    const std::vector<Fence> fences = fencesFrom(message);
    const auto own = static_cast<size_t>(std::max(0, message.num_own));
    for (size_t i = own; i < fences.size(); ++i) take({other, false, fences[i]});
  });
}

void FenceExchange::step(const FenceBook& book) {
  if (book.revision() == revision_ && bus_.now() < next_) return;
  if (book.fences().size() < kept_) removed_at_ = bus_.now();
  kept_ = book.fences().size();
  revision_ = book.revision();
  next_ = bus_.now() + kPeriod;
  auto message = blank<fences_t>();
  message.utime = bus_.now();
  message.seq = seq_++;
  message.keeper = process_;
  message.num_own = static_cast<int32_t>(book.own());
  for (const Fence& fence : book.fences()) message.fences.push_back(toMessage({"", false, fence}));
  message.num_fences = static_cast<int32_t>(message.fences.size());
  bus_.publish(kFences, message);
}

}  // namespace tread
