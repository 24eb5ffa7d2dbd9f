// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/failsafe.hpp"

namespace tread::motor {
namespace {

constexpr int64_t kHealthyBeforeArm = 1'000'000;  // [us] for which inputs must be good
constexpr int64_t kFastZero = 1'000'000;          // [us] of zero at the command rate after a stop

constexpr int64_t kRestart = 100'000;  // [us] for which a restart is a fault

struct Fault {
  BridgeState state = BridgeState::kDisarmed;
  Reason reason;
};

/// The most severe fault of the inputs, if any, ranked by StopReason.
std::optional<Fault> worstFault(const FailsafeInputs& in) {
  if (in.estop)
    return Fault{BridgeState::kEstop, {StopReason::kEstopEngaged, "E-stop: " + in.estop_reason}};
  const Reason* worst = nullptr;
  for (const Reason* fault :
       {&in.link_fault, &in.device_fault, &in.bridge_fault, &in.program_fault, &in.operator_fault,
        &in.lease_fault, &in.ins_fault, &in.tilt_fault, &in.fence_fault, &in.motion_fault})
    if (!fault->empty() && (worst == nullptr || fault->code < worst->code)) worst = fault;
  if (worst == nullptr) return std::nullopt;
  const bool of_bridge =
      worst == &in.link_fault || worst == &in.device_fault || worst == &in.bridge_fault;
  return Fault{of_bridge ? BridgeState::kFault : BridgeState::kDisarmed, *worst};
}

/// The most severe fault that stops the present kind of driving: under manual control a person sees
/// where the robot is and what it does. But nobody sees a fence, and it cannot be observed with a
/// wrong position.
std::optional<Fault> worstStop(const FailsafeInputs& in) {
  if (!in.hand) return worstFault(in);
  FailsafeInputs by_hand = in;
  for (Reason* seen : {&by_hand.program_fault, &by_hand.lease_fault, &by_hand.ins_fault})
    *seen = {};
  if (!in.fenced) by_hand.motion_fault = {};
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

Reason InsWatch::fault(int64_t now) const {
  if (!received_at_) return StopReason::kNoIns;
  if (restarted_at_ && now - *restarted_at_ < kRestart) return StopReason::kInsRestarted;
  if (now - *received_at_ > limits_.maxAge())
    return {StopReason::kInsStale,
            "INS is stale: nothing new within " + std::to_string(limits_.maxAge() / 1000) + " ms"};
  if (now - utime_ > limits_.maxAge() + limits_.max_latency_us)
    return {StopReason::kInsStale, "INS is stale: its newest measurement is too old"};
  return usable_ ? Reason() : Reason(StopReason::kInsBlind);
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
  const BridgeState state_before = state_;
  const Reason reason_before = reason_;
  const Refusal refusal_before = refusal_;
  if (!zero_since_) zero_since_ = disarmed_at_ = in.now;
  watchHealth(in);
  // Cleared does not mean armed; but people must see that it was cleared.
  if (state_ == BridgeState::kEstop && !in.estop)
    enter(BridgeState::kDisarmed, StopReason::kEstopCleared, in.now);
  // A fault or a request is final for this step: the next series waits for the next step, so that
  // at least one zero is sent in between.
  if (!stopOnFault(in) && !serveRequest(in) && !serveHand(in)) serveSeries(in);
  FailsafeOutputs out;
  out.state = state_;
  out.may_drive = state_ == BridgeState::kDriving;
  out.zero_fast = in.now - *zero_since_ < kFastZero;
  out.arm_refused = in.arm && !refusal_.words.empty();
  out.cause = reason_;
  if (const std::optional<Fault> fault = worstFault(in)) out.standing_fault = fault->reason;
  out.reason = words(in);
  out.standing_said = says(out.standing_fault);
  out.changed =
      state_ != state_before || reason_ != reason_before || refusal_.words != refusal_before.words;
  return out;
}

/// Whether words() already includes it.
bool Failsafe::says(const Reason& reason) const {
  return reason.empty() || reason == reason_ || (refused() && reason == refusal_.why);
}

/// All that people should read about the state: each reason once.
std::string Failsafe::words(const FailsafeInputs& in) const {
  std::string all = reason_.words;
  if (refused()) all += "; " + refusal_.words;
  if (!says(in.program_bar)) all += "; programs refused: " + in.program_bar.words;
  if (!in.hand_bar.empty() && !(refused() && refusal_.by_hand)) all += "; " + in.hand_bar;
  return all;
}

void Failsafe::enter(BridgeState state, const Reason& reason, int64_t now) {
  const bool moved = state_ == BridgeState::kDriving || state_ == BridgeState::kManual;
  if (moved || !isArmed(state)) zero_since_ = now;
  if (!isArmed(state)) disarmed_at_ = now;
  state_ = state;
  reason_ = reason;
  refusal_ = {};
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
  const bool worse = fault->state == BridgeState::kEstop && state_ != BridgeState::kEstop;
  if (isArmed(state_) || worse) enter(fault->state, fault->reason, in.now);
  if (in.arm) refusal_ = {"ARM refused: " + fault->reason.words, fault->reason, false};
  if (!in.arm && !in.refusal.empty()) refusal_ = {in.refusal, {}, false};
  return true;
}

Failsafe::Refusal Failsafe::whyNotArm(const FailsafeInputs& in) const {
  if (!in.leased) return {in.unleased.words, in.unleased, false};
  // A person who holds the button wants manual control: the robot must not be armed for programs
  // instead.
  if (!in.hand_bar.empty()) return {in.hand_bar, {}, true};
  const int64_t healthy = healthy_since_ ? in.now - *healthy_since_ : 0;
  if (healthy >= kHealthyBeforeArm) return {};
  return {"inputs good for " + std::to_string(healthy / 1000) + " ms, " +
              std::to_string(kHealthyBeforeArm / 1000) + " are needed",
          {},
          false};
}

bool Failsafe::serveRequest(const FailsafeInputs& in) {
  if (in.disarm) {
    if (isArmed(state_))
      enter(BridgeState::kDisarmed, {in.disarm_code, "disarmed by " + in.requested_by}, in.now);
    return true;
  }
  if (!in.refusal.empty() && !in.arm && !isArmed(state_)) refusal_ = {in.refusal, {}, false};
  if (!in.arm || isArmed(state_)) return false;
  refusal_ = whyNotArm(in);
  if (!refusal_.words.empty()) {
    refusal_.words = "ARM refused: " + refusal_.words;
    return true;
  }
  enter(in.hand ? BridgeState::kManual : BridgeState::kArmed,
        in.hand ? Reason(StopReason::kByHand, in.hand_words)
                : Reason(StopReason::kArmed, "armed by " + in.requested_by),
        in.now);
  return true;
}

bool Failsafe::serveHand(const FailsafeInputs& in) {
  if (in.hand && isArmed(state_)) {
    enter(BridgeState::kManual, {StopReason::kByHand, in.hand_words}, in.now);
    return true;
  }
  if (state_ != BridgeState::kManual) return false;
  enter(BridgeState::kStopping, in.unleased.empty() ? Reason(StopReason::kGivenBack) : in.unleased,
        in.now);
  return true;
}

void Failsafe::serveSeries(const FailsafeInputs& in) {
  const bool stands = state_ == BridgeState::kArmed || state_ == BridgeState::kStopping;
  if (state_ == BridgeState::kDriving && !in.playing) {
    enter(BridgeState::kStopping,
          in.series_end.empty() ? Reason(StopReason::kProgramEnded) : in.series_end, in.now);
  } else if (state_ == BridgeState::kDriving && !in.leased) {
    enter(BridgeState::kStopping, in.unleased, in.now);
  } else if (stands && in.unattended) {
    enter(BridgeState::kDisarmed, in.unleased, in.now);
  } else if (stands && in.start_wanted && in.leased && in.program_bar.empty()) {
    enter(BridgeState::kDriving, StopReason::kPlaying, in.now);
  } else if (state_ == BridgeState::kStopping && in.now - *zero_since_ >= kFastZero) {
    enter(BridgeState::kArmed, reason_, in.now);
  }
}

}  // namespace tread::motor
