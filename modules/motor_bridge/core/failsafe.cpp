// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/failsafe.hpp"

namespace tread::motor {
namespace {

constexpr int64_t kHealthyBeforeArm = 1'000'000;  // [us] for which inputs must be good
constexpr int64_t kFastZero = 1'000'000;          // [us] of zero at the command rate after a stop

constexpr int64_t kRestart = 100'000;  // [us] for which a restart is a fault

struct Fault {
  State state = State::kDisarmed;
  std::string reason;
};

/// Worst fault of the inputs, if any: the order of the lines is the ranking.
std::optional<Fault> worstFault(const FailsafeInputs& in) {
  if (in.estop) return Fault{State::kEstopped, "E-stop: " + in.estop_reason};
  const Fault ranked[] = {
      {State::kFault, in.link_fault},        {State::kFault, in.device_fault},
      {State::kFault, in.bridge_fault},      {State::kDisarmed, in.program_fault},
      {State::kDisarmed, in.operator_fault}, {State::kDisarmed, in.lease_fault},
      {State::kDisarmed, in.ins_fault},      {State::kDisarmed, in.tilt_fault},
      {State::kDisarmed, in.fence_fault},    {State::kDisarmed, in.motion_fault}};
  for (const Fault& fault : ranked) {
    if (!fault.reason.empty()) return fault;
  }
  return std::nullopt;
}

/// Worst fault that stops what is driven now: a person sees where the robot is and what it does. A
/// fence nobody sees, and with a wrong position it is not kept.
std::optional<Fault> worstStop(const FailsafeInputs& in) {
  if (!in.hand) return worstFault(in);
  FailsafeInputs by_hand = in;
  for (std::string* seen : {&by_hand.program_fault, &by_hand.lease_fault, &by_hand.ins_fault})
    seen->clear();
  if (!in.fenced) by_hand.motion_fault.clear();
  return worstFault(by_hand);
}

}  // namespace

bool InsWatch::receive(const InsNotice& notice, int64_t now) {
  const bool future = notice.utime > now + limits_.max_future_us;
  const bool old = notice.utime < now - limits_.maxAge() - limits_.max_latency_us;
  const bool newer = !received_at_ || notice.utime > utime_;
  if (future || old || !newer) return false;
  if (received_at_ && notice.seq < seq_) restarted_at_ = now;
  received_at_ = now;
  seq_ = notice.seq;
  utime_ = notice.utime;
  usable_ = notice.usable;
  return true;
}

std::string InsWatch::fault(int64_t now) const {
  if (!received_at_) return "no INS yet";
  if (restarted_at_ && now - *restarted_at_ < kRestart) return "the INS driver has been restarted";
  if (now - *received_at_ > limits_.maxAge())
    return "INS is stale: nothing new within " + std::to_string(limits_.maxAge() / 1000) + " ms";
  if (now - utime_ > limits_.maxAge() + limits_.max_latency_us)
    return "INS is stale: its newest measurement is too old";
  return usable_ ? "" : "INS knows no position or no heading";
}

bool OperatorRequests::timely(int64_t utime, int64_t now) {
  constexpr int64_t kMaxAge = 1'500'000;  // [us]; requests are repeated for a second
  constexpr int64_t kMaxFuture = 50'000;  // [us]
  return utime <= now + kMaxFuture && utime >= now - kMaxAge;
}

OperatorRequests::Effect OperatorRequests::classify(const ArmRequest& request, int64_t now,
                                                    int64_t disarmed_at) {
  if (!request.armed) return Effect::kDisarm;
  if (!timely(request.utime, now)) return Effect::kUntimely;
  const bool served = request.utime <= served_utime_;
  const bool after_stop = request.utime > disarmed_at;
  return after_stop && !served ? Effect::kArm : Effect::kIgnored;
}

bool OperatorRequests::receive(const EstopRequest& request, int64_t now) {
  if (request.engaged) {
    engaged_ = true;
    engaged_utime_ = std::max(engaged_utime_, std::min(request.utime, now));
    reason_ = request.why + " (" + request.by + ")";
    return true;
  }
  if (!engaged_ || !timely(request.utime, now) || request.utime < engaged_utime_) return false;
  engaged_ = false;
  reason_.clear();
  return true;
}

FailsafeOutputs Failsafe::update(const FailsafeInputs& in) {
  const State state_before = state_;
  const std::string reason_before = reason_;
  const std::string refusal_before = refusal_;
  if (!zero_since_) zero_since_ = disarmed_at_ = in.now;
  watchHealth(in);
  // Cleared is not armed; but people must see that it is cleared.
  if (state_ == State::kEstopped && !in.estop) enter(State::kDisarmed, "E-stop cleared", in.now);
  // A fault or a request leaves nothing to decide: the next series waits for the next step, so that
  // at least one zero lies between.
  if (!stopOnFault(in) && !serveRequest(in) && !serveHand(in)) serveSeries(in);
  FailsafeOutputs out;
  out.state = state_;
  out.may_drive = state_ == State::kDriving;
  out.zero_fast = in.now - *zero_since_ < kFastZero;
  out.arm_refused = in.arm && !refusal_.empty();
  out.reason = refusal_.empty() || isArmed(state_) ? reason_ : reason_ + "; " + refusal_;
  const bool barred =
      !in.program_bar.empty() && out.reason.find(in.program_bar) == std::string::npos;
  if (barred) out.reason += "; programs refused: " + in.program_bar;
  if (out.reason.find(in.hand_bar) == std::string::npos) out.reason += "; " + in.hand_bar;
  if (const std::optional<Fault> fault = worstFault(in)) out.standing_fault = fault->reason;
  out.changed = state_ != state_before || reason_ != reason_before || refusal_ != refusal_before;
  return out;
}

void Failsafe::enter(State state, const std::string& reason, int64_t now) {
  const bool moved = state_ == State::kDriving || state_ == State::kManual;
  if (moved || !isArmed(state)) zero_since_ = now;
  if (!isArmed(state)) disarmed_at_ = now;
  state_ = state;
  reason_ = reason;
  refusal_.clear();
}

void Failsafe::watchHealth(const FailsafeInputs& in) {
  if (worstStop(in)) {
    healthy_since_.reset();
  } else if (!healthy_since_) {
    healthy_since_ = in.now;
  }
}

bool Failsafe::stopOnFault(const FailsafeInputs& in) {
  const std::optional<Fault> fault = worstStop(in);
  if (!fault) return false;
  const bool worse = fault->state == State::kEstopped && state_ != State::kEstopped;
  if (isArmed(state_) || worse) enter(fault->state, fault->reason, in.now);
  if (in.arm) refusal_ = "ARM refused: " + fault->reason;
  if (!in.arm && !in.refusal.empty()) refusal_ = in.refusal;
  return true;
}

std::string Failsafe::whyNotArm(const FailsafeInputs& in) const {
  if (!in.leased) return in.unleased;
  // Who holds the button means to drive by hand: it must not be armed for programs instead.
  if (!in.hand_bar.empty()) return in.hand_bar;
  const int64_t healthy = healthy_since_ ? in.now - *healthy_since_ : 0;
  if (healthy >= kHealthyBeforeArm) return "";
  return "inputs good for " + std::to_string(healthy / 1000) + " ms, " +
         std::to_string(kHealthyBeforeArm / 1000) + " are needed";
}

bool Failsafe::serveRequest(const FailsafeInputs& in) {
  if (in.disarm) {
    if (isArmed(state_)) enter(State::kDisarmed, "disarmed by " + in.requested_by, in.now);
    return true;
  }
  if (!in.refusal.empty() && !in.arm && !isArmed(state_)) refusal_ = in.refusal;
  if (!in.arm || isArmed(state_)) return false;
  const std::string why_not = whyNotArm(in);
  refusal_ = why_not.empty() ? "" : "ARM refused: " + why_not;
  if (!refusal_.empty()) return true;
  enter(in.hand ? State::kManual : State::kArmed,
        in.hand ? in.hand_words : "armed by " + in.requested_by, in.now);
  return true;
}

bool Failsafe::serveHand(const FailsafeInputs& in) {
  if (in.hand && isArmed(state_)) {
    enter(State::kManual, in.hand_words, in.now);
    return true;
  }
  if (state_ != State::kManual) return false;
  enter(State::kStopping, in.unleased.empty() ? "given back by hand" : in.unleased, in.now);
  return true;
}

void Failsafe::serveSeries(const FailsafeInputs& in) {
  const bool stands = state_ == State::kArmed || state_ == State::kStopping;
  if (state_ == State::kDriving && !in.playing) {
    enter(State::kStopping, in.series_end.empty() ? "series ended" : in.series_end, in.now);
  } else if (state_ == State::kDriving && !in.leased) {
    enter(State::kStopping, in.unleased, in.now);
  } else if (stands && in.unattended) {
    enter(State::kDisarmed, in.unleased, in.now);
  } else if (stands && in.start_wanted && in.leased && in.program_bar.empty()) {
    enter(State::kDriving, "playing", in.now);
  } else if (state_ == State::kStopping && in.now - *zero_since_ >= kFastZero) {
    enter(State::kArmed, reason_, in.now);
  }
}

}  // namespace tread::motor
