// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>

// What DriveClock takes for possible.
namespace tread::drive_clock {

inline constexpr int64_t kSecond = 1'000'000;          // [us]
inline constexpr int64_t kDay = 86'400 * kSecond;      // a pause that nothing confirms is shorter
inline constexpr int64_t kUnconfirmed = 10 * kSecond;  // the same beside the robot's own times
inline constexpr int64_t kSilence = kSecond;    // a running robot publishes at least this often
inline constexpr int64_t kDelay = kSecond;      // of a recorder that is held up
inline constexpr int64_t kStep = 250'000;       // [us] by which clocks differ before one was set
inline constexpr int64_t kAtOnce = 50'000;      // [us] in which a recorder writes what has waited
inline constexpr int64_t kMuchAtOnce = 20'000;  // [us] of the robot's time within no time
inline constexpr int64_t kAlone = 3600 * kSecond;  // over which the robot's clock is believed alone
inline constexpr int64_t kLongestPause = 7 * kDay;                // of a recording
inline constexpr int64_t kLargestUtime = 10'000'000'000'000'000;  // three centuries
inline constexpr int64_t kLargestRecorded = 4'000'000'000'000'000'000;
inline constexpr int64_t kSlowest = 5 * kSecond;  // between messages of a running robot
inline constexpr size_t kFollowers = 4;           // stamps that are asked about another one
inline constexpr size_t kStampsAhead = 8;         // with which doubts are settled
inline constexpr size_t kMostAhead = 4096;        // events
inline constexpr int kSettled = 100;              // stamps after which a recorder has caught up

inline bool isPossible(int64_t utime) {
  return utime >= 0 && utime < kLargestUtime;
}

inline bool isMost(size_t part, size_t whole) {
  return 3 * part >= 2 * whole;
}

}  // namespace tread::drive_clock
