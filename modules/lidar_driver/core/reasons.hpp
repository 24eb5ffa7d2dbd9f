// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace tread::lidar {

/// Why no scan comes, by how much it tells.
enum class Rank {
  kNone,
  kStarting,    ///< the start-up is under way
  kSilent,      ///< nothing comes
  kUnreadable,  ///< bytes come that are no telegrams
  kRefused      ///< telegrams come that cannot be used
};

/// A reason as HEALTH gives it, with its count and what to do.
struct NotedReason {
  Rank rank = Rank::kNone;
  std::string words;
};

/// The reasons that were noted since the last good scan; the one that tells most is given.
/** Each is kept for 5 s after it was noted last, so that no later one that tells less replaces it:
 * a device that is refused, starts up again and is connected anew is still a device that is
 * refused. */
class Reasons {
 public:
  void note(Rank rank, const std::string& what, int64_t now, int64_t times = 1,
            const std::string& remedy = {});
  /// A good scan came: nothing is wrong any more.
  void clear() { noted_.clear(); }
  /// Of the highest rank; among those the one that was noted most often.
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
