// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/set_publisher.hpp"

#include <algorithm>

#include "common/messages/blank.hpp"
#include "common/messages/pattern_messages.hpp"

namespace tread::learner {
namespace {

/// Bytes in a step of 20 ms; the rest of LCM's 100 kB is left to LEARNING and HEALTH.
constexpr int kPortion = 60'000;
constexpr size_t kStateBytes = 50'000;
constexpr size_t kWaitingStates = 2;

}  // namespace

void SetPublisher::putSet(const PatternSet& set) {
  const auto parts = toMessages(set);
  sets_.assign(parts.begin(), parts.end());
}

void SetPublisher::putState(const PatternSet& set, const std::string& rule,
                            const std::string& text) {
  const auto last_parts = std::count_if(states_.begin(), states_.end(), [](const auto& part) {
    return part.state_part + 1 == part.state_part_count;
  });
  if (static_cast<size_t>(last_parts) >= kWaitingStates) states_.clear();
  const auto count = static_cast<int32_t>((text.size() + kStateBytes - 1) / kStateBytes);
  for (int32_t part = 0; part < count; ++part) {
    auto message = blank<learner_state_t>();
    message.state_version = set.version();
    message.state_part = part;
    message.state_part_count = count;
    message.rule_name = rule;
    const std::string piece = text.substr(static_cast<size_t>(part) * kStateBytes, kStateBytes);
    message.num_bytes = static_cast<int32_t>(piece.size());
    message.state_bytes.assign(piece.begin(), piece.end());
    states_.push_back(std::move(message));
  }
}

void SetPublisher::step(int64_t utime) {
  int left = kPortion;
  const auto send = [&](const auto& channel, auto& waiting, int64_t& seq) {
    while (!waiting.empty()) {
      const int size = waiting.front().getEncodedSize();
      if (size > left && left < kPortion) return;
      waiting.front().seq = seq++;
      bus_.publish(channel, waiting.front());
      waiting.pop_front();
      left -= size;
    }
  };
  send(kPatternSet, sets_, seq_set_);
  if (!sets_.empty()) return;
  for (learner_state_t& state : states_) state.utime = utime;
  send(kLearnerState, states_, seq_state_);
}

}  // namespace tread::learner
