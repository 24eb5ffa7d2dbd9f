// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/lcm_listener.hpp"

#include <stdexcept>

#include <lcm/lcm-cpp.hpp>

#include "common/bus/host_clock.hpp"
#include "common/bus/multicast_only.hpp"

namespace tread {
namespace {

constexpr int kQueue = 500;       // messages, of up to 60 kB each
constexpr int kMostAtOnce = 500;  // then the owner gets its turn

/// Every LCM program sends it to itself at its start; it means nothing.
constexpr const char* kSelfTest = "LCM_SELF_TEST";

/// [bytes] of any message of Tread and its seal.
constexpr size_t kLargest = 65'000;

}  // namespace

LcmListener::LcmListener(BusAccess access, Take take)
    : take_(std::move(take)), lcm_(std::make_unique<lcm::LCM>(access.url)) {
  if (!openForMulticastOnly(*lcm_, access.url))
    throw std::runtime_error("LCM cannot be used at '" + access.url + "'");
  if (access.sealer) sealer_.emplace(std::move(*access.sealer), hostNow());
  lcm_->subscribe(".*", &LcmListener::hear, this)->setQueueCapacity(kQueue);
}

LcmListener::~LcmListener() = default;

void LcmListener::handle(int timeout_ms) {
  for (int i = 0, wait = timeout_ms; i < kMostAtOnce && lcm_->handleTimeout(wait) > 0; ++i)
    wait = 0;
}

void LcmListener::hear(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  const auto* const bytes = static_cast<const uint8_t*>(buffer->data);
  const int64_t now = hostNow();
  if (channel == kSelfTest) return;
  if (buffer->data_size > kLargest) return refuse("too large");
  size_t size = sizeWithoutSeal(bytes, buffer->data_size);
  if (sealer_) {
    const OpenedSeal opened = sealer_->open(channel, bytes, buffer->data_size, now);
    if (opened.verdict != SealVerdict::kGood) return refuse(toWords(opened.verdict));
    size = opened.size;
  } else {
    sealed_unread_ |= size != buffer->data_size;
  }
  take_(channel, bytes, size, now);
}

std::string LcmListener::doubt() const {
  if (sealed_unread_)
    return "the robot has a key and this program none, so nothing here is proven: --key FILE";
  if (sealer_ && sealer_->hearsTwoSessions(hostNow()))
    return "the robot's messages arrive twice; one of the two sources is a recording: stop it";
  std::string words;
  for (const auto& [why, count] : refused_)
    words += (words.empty() ? "" : ", ") + std::to_string(count) + " " + why;
  return words.empty() ? "" : "messages not shown: " + words;
}

}  // namespace tread
