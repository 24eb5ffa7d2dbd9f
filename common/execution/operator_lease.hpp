// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace tread {

/// One OPERATOR message, as far as the lease depends on it.
struct OperatorNotice {
  int64_t station = 0;       ///< one start of an operator program
  std::string name;          ///< who; programs of one name share the lease
  bool drives = true;        ///< false: the program lets go
  int64_t seen_utime = 0;    ///< [us] of the newest MOTOR that the operator's program has heard
  int64_t goal_id = 0;       ///< that the program stands for; 0 = none
  std::string hand_over_to;  ///< empty = nobody
};

/// Whether an operator is there, and which one.
/** It counts from the newest state of the robot that the operator has demonstrably seen: who is
 * gone, frozen or cut off in either direction loses it, and so does a message played from a log. No
 * clock of another machine is compared. The first operator holds it; another one gets it when the
 * holder hands it over, or lets go and nothing is armed. Pure: time is an argument. */
class OperatorLease {
 public:
  /// How the holder's programs are.
  enum class State {
    kNone,   ///< nobody holds it, or the holder has let go
    kValid,  ///< the holder has seen the robot within the lease
    kLost    ///< the holder is silent, and has not let go
  };
  enum class Receipt { kTaken, kOfAnother, kStale, kFromFuture, kTooMany };

  /// `lease_us` [us] for which what was seen counts.
  explicit OperatorLease(int64_t lease_us) : lease_us_(lease_us) {}

  /// A message received at now [us].
  Receipt receive(const OperatorNotice& notice, int64_t now);
  /// Whoever signed this holds the robot from now on, if a program of his is there.
  void holdBy(const std::string& signature, int64_t now);
  /// Call in each step. A holder who let go or was lost keeps others out only while `armed`.
  void update(int64_t now, bool armed);

  State state(int64_t now) const;
  bool valid(int64_t now) const { return state(now) == State::kValid; }
  /// [us] the newest that a program of the holder has seen of the robot; nothing if there is none.
  std::optional<int64_t> newestSeen() const;
  /// Whether a live program of the holder stands for this goal.
  bool standsFor(int64_t goal_id, int64_t now) const;
  /// Whether a request was signed by the holder: "ada@station" or "ADA (ada@station)".
  bool isHolder(const std::string& signature) const { return isOf(signature, holder_); }
  /// Empty = nobody.
  const std::string& holder() const { return holder_; }
  /// [us] when the holder was last seen to be there; 0 = never.
  int64_t lastValid() const { return last_valid_; }
  int64_t leaseUs() const { return lease_us_; }

 private:
  struct Program {
    std::string name;
    int64_t seen_utime = 0;
    int64_t goal_id = 0;
  };
  static constexpr int64_t kMaxFuture = 100'000;  ///< [us] clocks of processes of this robot differ
  static constexpr size_t kMaxPrograms = 16;

  bool fresh(const Program& program, int64_t now) const {
    return now - program.seen_utime <= lease_us_;
  }
  bool anyFresh(const std::string& name, int64_t now) const;
  static bool isOf(const std::string& signature, const std::string& name);
  void dropStale(int64_t now);

  int64_t lease_us_;
  std::map<int64_t, Program> programs_;  ///< by station
  std::string holder_;
  int64_t last_valid_ = 0;
};

/// A receipt in words, e.g. "of another operator".
const char* describe(OperatorLease::Receipt receipt);

}  // namespace tread
