// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/bus/robot_clock.hpp"
#include "common/seal/seal.hpp"

namespace tread {

/// The sealer of one end of a bus. If it was made without a session, as on another host, it follows
/// the robot's session and clock.
/** All times are those of this host [us]. */
class BusSealer {
 public:
  /// Messages sent before `now` are refused.
  BusSealer(Sealer sealer, int64_t now);

  bool seal(const std::string& channel, std::vector<uint8_t>& message, int64_t now) {
    return sealer_.seal(channel, message, sealTime(now));
  }
  OpenedSeal open(const std::string& channel, const uint8_t* bytes, size_t size, int64_t now);

  /// Without a session of its own it may receive two sessions: one of them is a recording, and it
  /// cannot distinguish them.
  bool hearsTwoSessions(int64_t now) const;

 private:
  /// The present time on the clock of the others' seals.
  int64_t sealTime(int64_t now) const { return now + clock_.offset().value_or(0); }

  Sealer sealer_;
  bool foreign_;               ///< made without a session
  RobotClock clock_;           ///< how far the others' seals are ahead of our clock, if foreign
  int64_t session_heard_ = 0;  ///< where foreign
  std::optional<int64_t> other_heard_;  ///< if foreign: last receipt from another session
};

}  // namespace tread
