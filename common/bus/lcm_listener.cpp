// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/lcm_listener.hpp"

#include <stdexcept>

#include <lcm/lcm-cpp.hpp>

#include "common/bus/host_clock.hpp"
#include "common/bus/multicast_only.hpp"

namespace tread {
namespace {

constexpr int kQueue = 2000;      // messages
constexpr int kMostAtOnce = 500;  // after which its owner has other things to do

}  // namespace

LcmListener::LcmListener(const std::string& url, Take take)
    : take_(std::move(take)), lcm_(std::make_unique<lcm::LCM>(url)) {
  if (!openForMulticastOnly(*lcm_, url))
    throw std::runtime_error("LCM cannot be used at '" + url + "'");
  lcm_->subscribe(".*", &LcmListener::hear, this)->setQueueCapacity(kQueue);
}

LcmListener::~LcmListener() = default;

void LcmListener::handle(int timeout_ms) {
  for (int i = 0, wait = timeout_ms; i < kMostAtOnce && lcm_->handleTimeout(wait) > 0; ++i)
    wait = 0;
}

void LcmListener::hear(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  take_(channel, static_cast<const uint8_t*>(buffer->data), buffer->data_size, hostNow());
}

}  // namespace tread
