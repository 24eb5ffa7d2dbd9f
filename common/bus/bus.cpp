// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/bus.hpp"

#include <sstream>

namespace tread {
namespace {

/// Nobody publishes this often; a higher seq is that of a broken message.
constexpr int64_t kLargestSeq = 1'000'000'000'000;

}  // namespace

void Bus::deliver(const RawHandler& handler, const char* channel, const uint8_t* bytes,
                  size_t size) {
  try {
    handler(bytes, size);
  } catch (const std::exception& error) {
    ++statistics_.failed;
    statistics_.last_refusal = std::string(channel) + ": handler failed: " + error.what();
  }
}

void Bus::noteReceipt(const ChannelSpec& spec, int64_t utime, int64_t seq) {
  ++statistics_.received;
  statistics_.newest = {spec.name, utime, seq};
  // What may be old by its nature (a tile of the map) does not tell the time.
  if (spec.max_age_ms > 0 && !onReceipt(utime)) {
    ++statistics_.jumps;
    statistics_.last_refusal = std::string(spec.name) + ": utime " + std::to_string(utime) +
                               " is not of the present; is its publisher's clock CLOCK_MONOTONIC?";
  }
  // Differences are taken so that the numbers of a broken message cannot overflow.
  if (spec.max_age_ms > 0 && utime < now() - spec.max_age_ms * int64_t{1000}) ++statistics_.late;
  // Several publishers share HEALTH, CONFIG, ESTOP and MARK, so a gap says nothing there.
  const bool one_publisher = std::string(spec.publisher).find("every") == std::string::npos &&
                             std::string(spec.publisher) != "anyone";
  if (one_publisher && seq >= 0 && seq <= kLargestSeq) noteLoss(spec, utime, seq);
}

void Bus::noteLoss(const ChannelSpec& spec, int64_t utime, int64_t seq) {
  const auto [known, first] = newest_.try_emplace(spec.name, Newest{seq, utime});
  Newest& newest = known->second;
  if (first || seq == newest.seq) return;
  // What may be old by its nature does not tell a late message from a publisher's new beginning.
  if (spec.max_age_ms > 0 && seq < newest.seq && utime < newest.utime) {
    // It was overtaken on its way, and counted as lost then.
    if (statistics_.lost > 0) --statistics_.lost;
    return;
  }
  // A publisher that starts again counts from its beginning: no loss.
  if (seq > newest.seq + 1) statistics_.lost += seq - newest.seq - 1;
  newest = {seq, utime};
}

void Bus::noteUndecodable(const ChannelSpec& spec, size_t size) {
  ++statistics_.undecodable;
  std::ostringstream line;
  line << spec.name << ": a message of " << size << " bytes is not a " << spec.type
       << "; another program publishes on this channel, or was built with other message types";
  statistics_.last_refusal = line.str();
}

bool Bus::refuseOversized(const ChannelSpec& spec, int size) {
  ++statistics_.oversized;
  std::ostringstream line;
  line << spec.name << ": a message of " << size << " bytes was not sent; allowed "
       << spec.max_bytes;
  statistics_.last_refusal = line.str();
  return false;
}

}  // namespace tread
