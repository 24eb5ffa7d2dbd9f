// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/pending_replies.hpp"

#include <algorithm>

namespace tread::motor {

void PendingReplies::commandSent(int64_t now) {
  pending_.push_back({"", now});
  ++counters_["commands sent"];
}

void PendingReplies::querySent(const std::string& key, int64_t now) {
  pending_.push_back({key, now});
  ++counters_["queries sent"];
}

void PendingReplies::expire(int64_t now, int64_t timeout_us) {
  while (!pending_.empty() && now - pending_.front().sent > timeout_us) {
    pending_.pop_front();
    ++counters_["replies missing"];
  }
}

bool PendingReplies::take(const std::string& key) {
  const auto found = std::find_if(pending_.begin(), pending_.end(),
                                  [&key](const Pending& asked) { return asked.key == key; });
  if (found == pending_.end()) {
    ++counters_["unexpected replies"];
    return false;
  }
  counters_["replies missing"] += found - pending_.begin();
  pending_.erase(pending_.begin(), found + 1);
  return true;
}

bool PendingReplies::acknowledged() {
  return take("");
}

bool PendingReplies::answered(const std::string& key) {
  return take(key);
}

PendingReplies::Refused PendingReplies::refused() {
  if (pending_.empty()) {
    ++counters_["unexpected replies"];
    return Refused::kNothing;
  }
  const bool command = pending_.front().key.empty();
  pending_.pop_front();
  ++counters_[command ? "commands refused" : "queries refused"];
  return command ? Refused::kCommand : Refused::kQuery;
}

bool PendingReplies::waitsForQuery(int64_t now, int64_t patience_us) const {
  return std::any_of(pending_.begin(), pending_.end(), [&](const Pending& asked) {
    return !asked.key.empty() && now - asked.sent < patience_us;
  });
}

}  // namespace tread::motor
