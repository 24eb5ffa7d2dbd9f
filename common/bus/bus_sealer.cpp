// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/bus_sealer.hpp"

namespace tread {
namespace {

/// [us] of silence after which another session may replace one
constexpr int64_t kSessionSilence = 1'000'000;

}  // namespace

BusSealer::BusSealer(Sealer sealer, int64_t now)
    : sealer_(std::move(sealer)), foreign_(!sealer_.session()) {
  if (!foreign_) sealer_.refuseBefore(now);
}

OpenedSeal BusSealer::open(const std::string& channel, const uint8_t* bytes, size_t size,
                           int64_t now) {
  OpenedSeal opened = sealer_.open(channel, bytes, size, sealTime(now));
  if (!foreign_ || opened.sent == 0) return opened;
  if (opened.verdict == SealVerdict::kOtherSession) {
    other_heard_ = now;
    if (now - session_heard_ < kSessionSilence) return opened;
    // The robot was restarted, or the first messages were a recording that has ended.
    sealer_.forgetSession();
    clock_ = RobotClock();
    other_heard_.reset();
    opened = sealer_.open(channel, bytes, size, now);
  }
  session_heard_ = now;
  // Repeated old seals of a session cannot move its clock: the newest time counts.
  clock_.observe(opened.sent, now);
  return opened;
}

bool BusSealer::hearsTwoSessions(int64_t now) const {
  return other_heard_ && now - *other_heard_ < kSessionSilence;
}

}  // namespace tread
