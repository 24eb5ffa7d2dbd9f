// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace tread::lidar {

/// Why there is no scan, in increasing order of significance.
enum class Rank {
  kNone,
  kStarting,    ///< the start-up is running
  kSilent,      ///< nothing comes
  kUnreadable,  ///< bytes arrive that are no telegrams
  kRefused      ///< telegrams arrive that are unusable
};

/// A reason for HEALTH, with its count and the remedy.
struct NotedReason {
  Rank rank = Rank::kNone;
  std::string words;
};

/// The reasons since the last good scan; the most significant one is reported.
/** Each is kept for 5 s after its last occurrence, so that a later, less significant one does not
 * replace it: a refused device that restarts and reconnects is still a refused device. */
class Reasons {
 public:
  void note(Rank rank, const std::string& what, int64_t now, int64_t times = 1,
            const std::string& remedy = {});
  /// A good scan arrived: no fault remains.
  void clear() { noted_.clear(); }
  /// Of the highest rank; among those the most frequent one.
  NotedReason best(int64_t now) const;

 private:
  struct Noted {
    Rank rank = Rank::kNone;
    int64_t times = 0;
    int64_t last = 0;  ///< [us]
    std::string remedy;
  };

  std::map<std::string, Noted> noted_;
};

}  // namespace tread::lidar
