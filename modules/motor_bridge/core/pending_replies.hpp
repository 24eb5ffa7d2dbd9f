// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>

namespace tread::motor {

/// Messages to a controller that are not answered yet, in the order sent.
/** A controller answers in that order, so an answer shows which earlier ones were lost. */
class PendingReplies {
 public:
  /// A command was sent at now [us]: an acknowledgement is due.
  void commandSent(int64_t now);
  /// A query was sent at now [us]; its reply is identified by this non-empty key.
  void querySent(const std::string& key, int64_t now);
  /// Messages that wait longer than this [us] count as missing.
  void expire(int64_t now, int64_t timeout_us);
  void clear() { pending_.clear(); }

  /// An acknowledgement arrived. False if no command waits for one.
  bool acknowledged();
  /// The value of a query arrived. False if there was no such query.
  bool answered(const std::string& key);
  enum class Refused { kNothing, kCommand, kQuery };
  /// The message to which an incoming refusal belongs.
  Refused refused();
  /// Whether a query sent less than this ago [us] is still unanswered.
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
