// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tread::motor {

/// States by rank: a worse input always wins over a better one.
enum class State : int {
  kDriving = 0,   ///< armed, a series is played
  kArmed = 1,     ///< may drive, standing
  kStopping = 2,  ///< armed; a series ended normally, zero is repeated at the command rate
  kDisarmed = 3,  ///< needs ARM: not armed yet, disarmed, or stopped by the failsafe
  kFault = 4,     ///< needs ARM: stopped by a fault of the controller or of the link to it
  kEstopped = 5,  ///< until the E-stop is cleared; then disarmed
};

/// The state as a word.
const char* describe(State state);
/// True for the states in which a series may be started without ARM.
inline bool isArmed(State state) {
  return state <= State::kStopping;
}

/// What the failsafe looks at. Reasons are in words; empty = nothing wrong.
struct FailsafeInputs {
  int64_t now = 0;            ///< [us]
  bool estop = false;         ///< an emergency stop is engaged
  std::string estop_reason;   ///< by whom and why
  std::string link_fault;     ///< no controller that was started up and answers
  std::string device_fault;   ///< the controller reports a fault
  std::string bridge_fault;   ///< the bridge itself was held up
  std::string program_fault;  ///< a program broke its limits, or the planner changed
  std::string lease_fault;    ///< no program within the lease
  std::string ins_fault;      ///< no usable INS within its limit
  bool playing = false;       ///< a series is being played and goes on
  bool start_wanted = false;  ///< a series is offered to a standing robot
  std::string series_end;     ///< why the series ended, if it did in this step
  bool arm = false;           ///< a new request to arm arrived in this step
  bool disarm = false;        ///< a request to disarm arrived in this step
  std::string requested_by;   ///< who sent the request
};

/// What the bridge has to do.
struct FailsafeOutputs {
  State state = State::kDisarmed;
  bool may_drive = false;  ///< false: the command is zero, whatever is played
  bool zero_fast = true;   ///< zero is to be repeated at the command rate, else at the idle rate
  bool changed = false;    ///< the state or its reason changed in this step
  bool arm_refused = false;
  std::string reason;          ///< why it is in this state
  std::string standing_fault;  ///< worst fault of this step; empty = inputs are good
};

/// The ranked state machine that decides whether the motors may turn. Pure: time is an input.
/** Ranks, worst first: E-stop, link, device, bridge, program, lease, INS. A series can only start
    from a state that gave zero in the step before. Everything but the normal end of a series
    needs ARM, and ARM needs inputs that were good for a second. */
class Failsafe {
 public:
  FailsafeOutputs update(const FailsafeInputs& in);

  State state() const { return state_; }
  const std::string& reason() const { return reason_; }
  /// When it last left the armed states, or was first updated [us]; a request given before counts
  /// for nothing.
  int64_t disarmedAt() const { return disarmed_at_; }

 private:
  void enter(State state, const std::string& reason, int64_t now);
  void watchHealth(const FailsafeInputs& in);
  bool stopOnFault(const FailsafeInputs& in);
  bool serveRequest(const FailsafeInputs& in);
  void serveSeries(const FailsafeInputs& in);
  std::string whyNotArm(const FailsafeInputs& in) const;

  State state_ = State::kDisarmed;
  std::string reason_ = "not armed yet";
  std::optional<int64_t> healthy_since_;
  std::optional<int64_t> zero_since_;
  int64_t disarmed_at_ = 0;
  std::string refusal_;  ///< why the last request to arm was refused
};

}  // namespace tread::motor
