// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "common/execution/stop_reason.hpp"
#include "modules/motor_bridge/core/motion_track.hpp"
#include "modules/motor_bridge/core/tilt_watch.hpp"

namespace tread::motor {

/// When the INS counts as lost.
struct InsLimits {
  int64_t period_us = 20'000;        ///< of the INS [us]
  int64_t max_latency_us = 200'000;  ///< from measurement to receipt [us]
  int64_t max_future_us = 50'000;    ///< clock difference allowed [us]

  /// Longest silence allowed [us]: three periods, at least 100 ms.
  int64_t maxAge() const { return std::max<int64_t>(3 * period_us, 100'000); }
};

/// One INS message as far as motion depends on it.
struct InsNotice {
  int64_t utime = 0;   ///< [us] of the measurement
  bool usable = true;  ///< position and heading are known
  InsMotion motion{};  ///< NaN where it is not known
  int64_t seq = 0;     ///< counts up from the start of the INS driver
  InsTilt tilt{};
};

/// Watches that the INS goes on telling where the robot is.
/** A message counts only if its utime is newer than the last one's: a source that repeats its last
    measurement is as good as silent. */
class InsWatch {
 public:
  explicit InsWatch(const InsLimits& limits) : limits_(limits) {}

  /// A message received at now [us]. Returns whether it counts.
  bool receive(const InsNotice& notice, int64_t now);
  /// What is wrong at now [us]; none = nothing.
  Reason fault(int64_t now) const;

 private:
  InsLimits limits_;
  std::optional<int64_t> received_at_;
  int64_t utime_ = 0;
  int64_t seq_ = 0;
  std::optional<int64_t> restarted_at_;
  bool usable_ = false;
};

/// A request to arm or disarm, as sent.
struct ArmRequest {
  int64_t utime = 0;  ///< [us] when the operator gave it
  bool armed = false;
  std::string by;
  std::string why;
  StopReason code = StopReason::kDisarmed;  ///< of a request to disarm
};

/// An emergency stop or its clearing, as sent.
struct EstopRequest {
  int64_t utime = 0;  ///< [us]
  bool engaged = true;
  std::string by;
  std::string why;
};

/// Sorts the operator's requests: an old permission counts for nothing, a stop always counts.
class OperatorRequests {
 public:
  /// What a request to arm or disarm leads to.
  enum class Effect { kIgnored, kUntimely, kArm, kDisarm };
  /// Classifies a request received at now [us]; one to arm must have been given after disarmed_at
  /// [us].
  Effect classify(const ArmRequest& request, int64_t now, int64_t disarmed_at);
  /// A request to arm was served: its repetitions are worth nothing any more.
  void consume(const ArmRequest& request) { served_utime_ = request.utime; }

  /// An E-stop message received at now [us]. Returns false if it was ignored.
  bool receive(const EstopRequest& request, int64_t now);
  /// Whether a permission of this time counts for its age at now [us].
  static bool timely(int64_t utime, int64_t now);
  bool estop() const { return engaged_; }
  /// Who stopped and why; empty if not engaged.
  const std::string& estopReason() const { return reason_; }

 private:
  int64_t served_utime_ = -1;
  bool engaged_ = false;
  int64_t engaged_utime_ = 0;
  std::string reason_;
};

/// States by rank: a worse input always wins over a better one.
enum class State : int {
  kDriving = 0,   ///< armed, a series is played
  kManual = 1,    ///< armed, in a person's hand: no series is played
  kArmed = 2,     ///< may drive, standing
  kStopping = 3,  ///< armed; a series ended normally, zero is repeated at the command rate
  kDisarmed = 4,  ///< needs ARM: not armed yet, disarmed, or stopped by the failsafe
  kFault = 5,     ///< needs ARM: stopped by a fault of the controller or of the link to it
  kEstopped = 6,  ///< until the E-stop is cleared; then disarmed
};

/// True for the states in which a series may be started without ARM.
inline bool isArmed(State state) {
  return state <= State::kStopping;
}

/// What the failsafe looks at. No reason: nothing is wrong.
struct FailsafeInputs {
  int64_t now = 0;            ///< [us]
  bool estop = false;         ///< an emergency stop is engaged
  std::string estop_reason;   ///< by whom and why
  Reason link_fault;          ///< no controller that was started up and answers
  Reason device_fault;        ///< the controller reports a fault
  Reason bridge_fault;        ///< the bridge itself was held up
  Reason program_fault;       ///< a program broke its limits, or the planner changed
  Reason operator_fault;      ///< the operator is lost
  Reason lease_fault;         ///< no program within the lease
  Reason ins_fault;           ///< no usable INS within its limit
  Reason tilt_fault;          ///< a limit of roll, pitch or their rates was passed
  Reason fence_fault;         ///< only a zero now keeps the outline within a fence
  Reason motion_fault;        ///< the robot moves otherwise than its commands explain
  bool fenced = false;        ///< there are fences to keep
  bool hand = false;          ///< a person takes or keeps the robot, or wants it armed for the hand
  std::string hand_words;     ///< who does, and why it stands, if it does
  std::string hand_bar;       ///< why a hand that holds the button does not take the robot
  bool playing = false;       ///< a series is being played and goes on
  bool start_wanted = false;  ///< a series is offered to a standing robot
  Reason program_bar;         ///< why no series may start, though a person may drive by hand
  Reason series_end;          ///< why the series ended, if it did in this step
  bool leased = false;        ///< an operator is there; without one nothing moves
  Reason unleased;            ///< why not
  bool unattended = false;    ///< no operator was there for longer than an armed robot waits
  bool arm = false;           ///< a new request to arm arrived in this step
  bool disarm = false;        ///< a request to disarm arrived in this step
  std::string requested_by;   ///< who sent the request
  StopReason disarm_code = StopReason::kDisarmed;  ///< of a request to disarm
  std::string refusal;  ///< why a request counts for nothing, where people must know it
};

/// What the bridge has to do.
struct FailsafeOutputs {
  State state = State::kDisarmed;
  bool may_drive = false;  ///< false: the command is zero, whatever is played
  bool zero_fast = true;   ///< zero is to be repeated at the command rate, else at the idle rate
  bool changed = false;    ///< the state or its reason changed in this step
  bool arm_refused = false;
  Reason cause;               ///< why it is in this state
  std::string reason;         ///< for people: the same, and what was refused
  Reason standing_fault;      ///< worst fault of this step; none = inputs are good
  bool standing_said = true;  ///< `reason` says that fault
};

/// The ranked state machine that decides whether the motors may turn. Pure: time is an input.
/** Of faults that stand together the first in StopReason counts. A series can only start from a
   state that gave zero in the step before, and only while an operator is there and nothing bars
   programs. Everything but the normal end of a series needs ARM, and ARM needs an operator and
   inputs that were good for a second. */
class Failsafe {
 public:
  FailsafeOutputs update(const FailsafeInputs& in);

  State state() const { return state_; }
  const Reason& reason() const { return reason_; }
  /// When it last left the armed states, or was first updated [us]; a request given before counts
  /// for nothing.
  int64_t disarmedAt() const { return disarmed_at_; }

 private:
  /// Why a request counts for nothing.
  struct Refusal {
    std::string words;     ///< empty = none
    Reason why;            ///< where a fault or the operator is why
    bool by_hand = false;  ///< a hand holds the button
  };
  void enter(State state, const Reason& reason, int64_t now);
  bool refused() const { return !refusal_.words.empty() && !isArmed(state_); }
  bool says(const Reason& reason) const;
  std::string words(const FailsafeInputs& in) const;
  void watchHealth(const FailsafeInputs& in);
  bool stopOnFault(const FailsafeInputs& in);
  bool serveRequest(const FailsafeInputs& in);
  bool serveHand(const FailsafeInputs& in);
  void serveSeries(const FailsafeInputs& in);
  Refusal whyNotArm(const FailsafeInputs& in) const;

  State state_ = State::kDisarmed;
  Reason reason_ = StopReason::kNotArmedYet;
  std::optional<int64_t> healthy_since_;
  std::optional<int64_t> zero_since_;
  int64_t disarmed_at_ = 0;
  Refusal refusal_;  ///< of the last request to arm
};

}  // namespace tread::motor
