// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>

namespace tread::motor {

/// What was sent to a controller and not answered yet, in the order sent.
/** A controller answers in that order, so an answer shows which ones before it were lost. */
class PendingReplies {
 public:
  /// A command was sent at now [us]: an acknowledgement is due.
  void commandSent(int64_t now);
  /// A query was sent at now [us]; its reply is known by this key, which is not empty.
  void querySent(const std::string& key, int64_t now);
  /// What waits longer than this [us] is missing.
  void expire(int64_t now, int64_t timeout_us);
  void clear() { pending_.clear(); }

  /// An acknowledgement came. False if no command waits for one.
  bool acknowledged();
  /// The value of a query came. False if nobody asked.
  bool answered(const std::string& key);
  enum class Refused { kNothing, kCommand, kQuery };
  /// What the refusal that came was for.
  Refused refused();
  /// Whether a query that was sent less than this ago [us] is not answered yet.
  bool waitsForQuery(int64_t now, int64_t patience_us) const;

  /// By name: sent, missing, refused, unexpected.
  const std::map<std::string, int64_t>& counters() const { return counters_; }

 private:
  struct Pending {
    std::string key;  ///< empty for a command
    int64_t sent = 0;
  };
  bool take(const std::string& key);

  std::deque<Pending> pending_;
  std::map<std::string, int64_t> counters_;
};

}  // namespace tread::motor
