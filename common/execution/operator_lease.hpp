// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace tread {

/// The fields of an OPERATOR message that the lease uses.
struct OperatorNotice {
  int64_t station = 0;       ///< one start of an operator program
  std::string name;          ///< operator's name; programs of one name share the lease
  bool drives = true;        ///< false: the program releases the lease
  int64_t seen_utime = 0;    ///< [us] of the newest MOTOR that the operator's program has received
  int64_t goal_id = 0;       ///< goal that the program vouches for; 0 = none
  std::string hand_over_to;  ///< empty = nobody
};

/// Whether an operator is present, and which one.
/** The lease depends on the newest state of the robot that the operator has demonstrably seen: an
 * operator who is gone, frozen or cut off in either direction loses it, and so does a message
 * replayed from a log. Clocks of other machines are never compared. The first operator gets it;
 * another one gets it when the holder hands it over, or releases it while the robot is not armed.
 * Pure: time is an argument. */
class OperatorLease {
 public:
  /// State of the holder's programs.
  enum class State {
    kNone,   ///< no holder, or the holder has released it
    kValid,  ///< the holder has seen the robot within the lease
    kLost    ///< the holder is silent and has not released it
  };
  enum class Receipt { kTaken, kOfAnother, kStale, kFromFuture, kTooMany };

  /// `lease_us` [us]: how long a sighting of the robot counts.
  explicit OperatorLease(int64_t lease_us) : lease_us_(lease_us) {}

  /// A message received at now [us].
  Receipt receive(const OperatorNotice& notice, int64_t now);
  /// Gives the lease to the operator with this signature, if one of their programs is running.
  void holdBy(const std::string& signature, int64_t now);
  /// Call in each step. A holder who has released it or was lost excludes others only while
  /// `armed`.
  void update(int64_t now, bool armed);

  State state(int64_t now) const;
  bool valid(int64_t now) const { return state(now) == State::kValid; }
  /// [us] newest robot state that a program of the holder has seen; nullopt if there is none.
  std::optional<int64_t> newestSeen() const;
  /// Whether a live program of the holder vouches for this goal.
  bool standsFor(int64_t goal_id, int64_t now) const;
  /// Whether a request was signed by the holder: "ada@station" or "ADA (ada@station)".
  bool isHolder(const std::string& signature) const { return isOf(signature, holder_); }
  /// Empty = nobody.
  const std::string& holder() const { return holder_; }
  /// [us] when the holder was last confirmed present; 0 = never.
  int64_t lastValid() const { return last_valid_; }
  int64_t leaseUs() const { return lease_us_; }

 private:
  struct Program {
    std::string name;
    int64_t seen_utime = 0;
    int64_t goal_id = 0;
  };
  /// [us] of clock difference between processes of this robot
  static constexpr int64_t kMaxFuture = 100'000;
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
