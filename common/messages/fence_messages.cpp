// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/fence_messages.hpp"

#include <cstring>
#include <utility>

#include "common/messages/blank.hpp"

namespace tread {
namespace {

constexpr size_t kHashDigits = 8;
constexpr int64_t kLookEvery = 500'000;  // [us]

/// FNV-1a of kind and corners.
uint32_t hashOf(const Fence& fence) {
  uint32_t hash = 2166136261U;
  const auto mix = [&hash](double number) {
    number += 0.0;  // -0.0 is 0.0
    uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    for (int shift = 0; shift < 64; shift += 8) {
      hash ^= static_cast<uint32_t>((bits >> shift) & 0xFFU);
      hash *= 16777619U;
    }
  };
  mix(fence.keep_out ? 1.0 : 0.0);
  for (const Eigen::Vector2d& corner : fence.corners) {
    mix(corner.x());
    mix(corner.y());
  }
  return hash;
}

std::string counterPrefix(const std::string& name) {
  return "fence " + name + " ";
}

}  // namespace

std::string fenceCounter(const Fence& fence) {
  std::string counter = counterPrefix(fence.name);
  const uint32_t hash = hashOf(fence);
  for (size_t digit = kHashDigits; digit-- > 0;)
    counter += "0123456789abcdef"[(hash >> (4 * digit)) & 0xFU];
  return counter;
}

bool countsFence(const std::string& counter, const std::string& name) {
  const std::string prefix = counterPrefix(name);
  return counter.size() == prefix.size() + kHashDigits && counter.rfind(prefix, 0) == 0;
}

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

FenceExchange::FenceExchange(Bus& bus, std::string process, std::string other)
    : bus_(bus), process_(std::move(process)) {
  bus.overhear<health_t>(kHealth, [this, other = std::move(other)](const health_t& health) {
    if (health.process != other || bus_.now() < next_) return;
    next_ = bus_.now() + kLookEvery;
    others_counters_.emplace();
    for (const counter_t& counter : health.counters) others_counters_->insert(counter.counter_name);
  });
}

void FenceExchange::send(const Fence& fence) {
  fence_t message = toMessage({process_, false, fence});
  message.utime = bus_.now();
  message.seq = seq_++;
  bus_.publish(kFence, message);
}

void FenceExchange::step(const FenceBook& book, HealthReporter& health) {
  for (size_t i = book.own(); others_counters_ && i < book.fences().size(); ++i)
    if (others_counters_->count(fenceCounter(book.fences()[i])) == 0) send(book.fences()[i]);
  others_counters_.reset();
  if (book.revision() == revision_) return;
  revision_ = book.revision();
  for (const std::string& counter : told_) health.removeCounter(counter);
  told_.clear();
  for (const Fence& fence : book.fences()) told_.insert(fenceCounter(fence));
  for (const std::string& counter : told_) health.setCounter(counter, 1);
}

}  // namespace tread
