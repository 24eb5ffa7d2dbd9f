// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "common/execution/bridge_state.hpp"
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

/// The fields of an INS message that driving depends on.
struct InsNotice {
  int64_t utime = 0;   ///< [us] of the measurement
  bool usable = true;  ///< position and heading are known
  InsMotion motion{};  ///< NaN if unknown
  int64_t seq = 0;     ///< increases from the start of the INS driver
  InsTilt tilt{};
};

/// Checks that the INS keeps reporting the position.
/** A message counts only if its utime is newer than the previous one's: a source that repeats its
 * last measurement is as good as silent. */
class InsWatch {
 public:
  explicit InsWatch(const InsLimits& limits) : limits_(limits) {}

  /// A message received at now [us]. Returns whether it counts.
  bool receive(const InsNotice& notice, int64_t now);
  /// What is wrong at now [us]; no reason = nothing.
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

/// Sorts the operator's requests: an old permission does not count, a stop always counts.
class OperatorRequests {
 public:
  /// Effect of a request to arm or disarm.
  enum class Effect { kIgnored, kUntimely, kArm, kDisarm };
  /// Classifies a request received at now [us]; a request to arm must have been given after
  /// disarmed_at [us].
  Effect classify(const ArmRequest& request, int64_t now, int64_t disarmed_at);
  /// A request to arm was served: its repetitions no longer count.
  void consume(const ArmRequest& request) { served_utime_ = request.utime; }

  /// An E-stop message received at now [us]. Returns false if it was ignored.
  bool receive(const EstopRequest& request, int64_t now);
  /// Whether a permission of this time is young enough at now [us].
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

/// Inputs of the failsafe. No reason = nothing wrong.
struct FailsafeInputs {
  int64_t now = 0;           ///< [us]
  bool estop = false;        ///< an emergency stop is engaged
  std::string estop_reason;  ///< its sender and reason
  Reason link_fault;         ///< no controller that was started up and answers
  Reason device_fault;       ///< the controller reports a fault
  Reason bridge_fault;       ///< the bridge itself was delayed
  Reason program_fault;      ///< a program violated its limits, or the planner changed
  Reason operator_fault;     ///< the operator is lost
  Reason lease_fault;        ///< no program within the lease
  Reason ins_fault;          ///< no usable INS within its limit
  Reason tilt_fault;         ///< a limit of roll, pitch or their rates was exceeded
  Reason fence_fault;        ///< only zero, given now, keeps the outline inside the fences
  Reason motion_fault;       ///< the commands do not explain the robot's motion
  bool fenced = false;       ///< there are fences to observe
  bool hand = false;  ///< a person takes or keeps manual control, or wants the robot armed for it
  std::string hand_words;     ///< who, and why the robot stands, if it does
  std::string hand_bar;       ///< why manual control does not start although the button is held
  bool playing = false;       ///< a series is being played and continues
  bool start_wanted = false;  ///< a series is offered while the robot stands
  Reason program_bar;         ///< why no series may start, although manual control may
  Reason series_end;          ///< why the series ended, if it did in this step
  bool leased = false;        ///< an operator is present; without one nothing moves
  Reason unleased;            ///< why not
  bool unattended = false;    ///< no operator was present for longer than an armed robot may wait
  bool arm = false;           ///< a new request to arm arrived in this step
  bool disarm = false;        ///< a request to disarm arrived in this step
  std::string requested_by;   ///< sender of the request
  StopReason disarm_code = StopReason::kDisarmed;  ///< of a request to disarm
  std::string refusal;  ///< why a request does not count, if people must know
};

/// What the bridge must do.
struct FailsafeOutputs {
  BridgeState state = BridgeState::kDisarmed;
  bool may_drive = false;  ///< false: the command is zero, whatever is being played
  bool zero_fast = true;   ///< repeat zero at the command rate, not at the idle rate
  bool changed = false;    ///< the state or its reason changed in this step
  bool arm_refused = false;
  Reason cause;               ///< why the failsafe is in this state
  std::string reason;         ///< for people: the same, with refusals
  Reason standing_fault;      ///< most severe fault of this step; no reason = inputs are good
  bool standing_said = true;  ///< `reason` states that fault
};

/// The ranked state machine that decides whether the motors may turn. Pure: time is an input.
/** Of simultaneous faults the first in StopReason counts. A series can start only from a state that
 * gave zero in the previous step, and only while an operator is present and nothing bars programs.
 * Everything but the normal end of a series requires ARM, and ARM requires an operator and inputs
 * that were good for a second. */
class Failsafe {
 public:
  FailsafeOutputs update(const FailsafeInputs& in);

  BridgeState state() const { return state_; }
  const Reason& reason() const { return reason_; }
  /// When it last left the armed states, or was first updated [us]; an earlier request does not
  /// count.
  int64_t disarmedAt() const { return disarmed_at_; }

 private:
  /// Why a request does not count.
  struct Refusal {
    std::string words;     ///< empty = none
    Reason why;            ///< if a fault or the operator is the cause
    bool by_hand = false;  ///< the button of manual control is held
  };
  void enter(BridgeState state, const Reason& reason, int64_t now);
  bool refused() const { return !refusal_.words.empty() && !isArmed(state_); }
  bool says(const Reason& reason) const;
  std::string words(const FailsafeInputs& in) const;
  void watchHealth(const FailsafeInputs& in);
  bool stopOnFault(const FailsafeInputs& in);
  bool serveRequest(const FailsafeInputs& in);
  bool serveHand(const FailsafeInputs& in);
  void serveSeries(const FailsafeInputs& in);
  Refusal whyNotArm(const FailsafeInputs& in) const;

  BridgeState state_ = BridgeState::kDisarmed;
  Reason reason_ = StopReason::kNotArmedYet;
  std::optional<int64_t> healthy_since_;
  std::optional<int64_t> zero_since_;
  int64_t disarmed_at_ = 0;
  Refusal refusal_;  ///< of the last request to arm
};

}  // namespace tread::motor
