// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>

// Limits of what DriveClock considers possible.
namespace tread::drive_clock {

inline constexpr int64_t kSecond = 1'000'000;      // [us]
inline constexpr int64_t kDay = 86'400 * kSecond;  // upper limit of a pause that nothing confirms
inline constexpr int64_t kUnconfirmed = 10 * kSecond;  // the same, with robot times available
inline constexpr int64_t kSilence = kSecond;  // a running robot publishes at least this often
inline constexpr int64_t kDelay = kSecond;    // of a delayed recorder
inline constexpr int64_t kStep = 250'000;     // [us] of clock difference that counts as a set clock
inline constexpr int64_t kAtOnce = 50'000;    // [us] in which a recorder writes its backlog
inline constexpr int64_t kMuchAtOnce = 20'000;      // [us] of robot time that counts as a backlog
inline constexpr int64_t kAlone = 3600 * kSecond;   // over which the robot's clock is trusted alone
inline constexpr int64_t kLongestPause = 7 * kDay;  // of a recording
inline constexpr int64_t kLargestUtime = 10'000'000'000'000'000;  // three centuries
inline constexpr int64_t kLargestRecorded = 4'000'000'000'000'000'000;
inline constexpr int64_t kSlowest = 5 * kSecond;  // between messages of a running robot
inline constexpr size_t kFollowers = 4;           // later stamps that confirm or refute one
inline constexpr size_t kStampsAhead = 8;         // stamps that settle a doubt
inline constexpr size_t kMostAhead = 4096;        // events
inline constexpr int kSettled = 100;              // stamps after which a recorder has caught up

inline bool isPossible(int64_t utime) {
  return utime >= 0 && utime < kLargestUtime;
}

inline bool isMost(size_t part, size_t whole) {
  return 3 * part >= 2 * whole;
}

}  // namespace tread::drive_clock
