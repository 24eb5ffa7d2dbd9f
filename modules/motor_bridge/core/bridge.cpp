// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/bridge.hpp"

#include <algorithm>
#include <cmath>

#include "common/execution/execution_tracker.hpp"

namespace tread::motor {
namespace {

/// Time limit of a running pattern after the loss of the operator [us].
constexpr int64_t kLongestFinish = 15'000'000;

std::string tenths(int64_t microseconds) {
  const int64_t rounded = (microseconds + 50'000) / 100'000;
  return std::to_string(rounded / 10) + "." + std::to_string(rounded % 10) + " s";
}

/// For people whose machine has another clock.
std::string untimely(const std::string& what, int64_t utime, int64_t now) {
  if (utime > now)
    return what + " ignored: its time is ahead of the robot's clock; do the clocks differ?";
  return what + " ignored: its time is behind the robot's clock; do the clocks differ?";
}

}  // namespace

Bridge::Bridge(const BridgeConfig& config)
    : config_(config),
      gate_(config.gate),
      ins_(config.ins),
      motion_(config.motion),
      tilt_(config.tilt),
      fences_(config.fences, config.motion),
      stopping_(config.fences.stopping_time),
      operator_(config.operators.lease_us),
      manual_(config.manual) {}

void Bridge::receive(const Program& program, int64_t now) {
  const ProgramGate::Admission admission = gate_.admit(program, now, !isArmed(failsafe_.state()));
  if (admission.refusal == ProgramRefusal::kBadSlot) {
    since_.program_fault = {StopReason::kBadProgram,
                            std::string("PROGRAM with ") + describe(admission.slot_fault)};
    count(std::string("PROGRAM refused: ") + describe(admission.slot_fault));
    return;
  }
  if (admission.refusal != ProgramRefusal::kNone) {
    if (admission.refusal == ProgramRefusal::kRunChanged)
      since_.program_fault = {StopReason::kOtherPlanner, describe(admission.refusal)};
    count(std::string("PROGRAM refused: ") + describe(admission.refusal));
    return;
  }
  if (admission.new_run) {
    player_.beginRun(program.run_id);
    // Restarts the second of good inputs: with two planners running nobody can arm.
    since_.program_fault = StopReason::kOtherPlanner;
    count("planner runs");
  }
  take(program, now);
}

void Bridge::take(const Program& program, int64_t now) {
  if (failsafe_.state() == BridgeState::kManual) {
    if (!program.running.empty()) count("PROGRAM refused: the robot is driven by hand");
    return gate_.renew(program, now);
  }
  const Offer offer = player_.offer(program, now);
  if (!agrees(offer)) {
    count(std::string("PROGRAM refused: ") + describe(offer));
  } else if (offer == Offer::kPlannerAhead || offer == Offer::kPlannerBehind) {
    count(std::string("PROGRAM ") + describe(offer));
  }
  since_.planner_stop = offer == Offer::kStop && player_.playing();
  // A moving robot must not live on the lease of a planner that assumes another motion.
  if (agrees(offer) || !player_.playing()) gate_.renew(program, now);
}

void Bridge::receive(const ArmRequest& request, int64_t now) {
  switch (requests_.classify(request, now, failsafe_.disarmedAt())) {
    case OperatorRequests::Effect::kArm:
      if (operator_.valid(now) && !operator_.isHolder(request.by)) {
        since_.refusal = "ARM refused: the robot is held by " + operator_.holder();
        count("ARM refused: of another operator than the one who holds the robot");
        break;
      }
      since_.arm = true;
      since_.request = request;
      break;
    case OperatorRequests::Effect::kDisarm:
      since_.disarm = true;
      since_.request = request;
      break;
    case OperatorRequests::Effect::kUntimely:
      since_.refusal = untimely("ARM", request.utime, now);
      count("ARM ignored: too old or from the future");
      break;
    case OperatorRequests::Effect::kIgnored:
      count("ARM ignored: served or given before the stop");
      break;
  }
}

void Bridge::receive(const EstopRequest& request, int64_t now) {
  const bool taken = requests_.receive(request, now);
  if (taken) {
    since_.estop_cleared = !request.engaged;
  } else {
    if (requests_.estop() && !OperatorRequests::timely(request.utime, now))
      since_.refusal = untimely("the clearing of the E-stop", request.utime, now);
    count("ESTOP clearing ignored: nothing to clear, or too old");
  }
}

void Bridge::receive(const OperatorNotice& notice, int64_t now) {
  const OperatorLease::Receipt receipt = operator_.receive(notice, now);
  if (receipt != OperatorLease::Receipt::kTaken)
    count(std::string("OPERATOR ignored: ") + describe(receipt));
  const bool ends = receipt == OperatorLease::Receipt::kTaken && !notice.drives;
  if (!ends || !manual_.letGo(notice.station) || failsafe_.state() != BridgeState::kManual) return;
  // The robot was not handed back: it must not continue to a goal by itself.
  since_.disarm = true;
  since_.request = ArmRequest{now, false, notice.name + ", whose program has ended", ""};
}

void Bridge::receive(const ManualNotice& notice, int64_t now) {
  const bool holds = operator_.valid(now) && notice.name == operator_.holder();
  const std::string refusal =
      holds ? manual_.receive(notice, now) : "its sender does not hold the robot";
  if (!refusal.empty()) count("MANUAL ignored: " + refusal);
}

void Bridge::receive(const InsNotice& notice, int64_t now) {
  if (!ins_.receive(notice, now)) return;
  tilt_.receive(notice.tilt, now);
  if (!notice.usable) return;
  motion_.receive(notice.motion);
  fences_.receive(notice.motion);
  const InsMotion& motion = notice.motion;
  stopping_.measure(motion.utime, {motion.x, motion.y, motion.yaw},
                    std::hypot(motion.v_forward, motion.v_left));
  fences_.setStoppingTime(stopping_.seconds());
}

void Bridge::receive(const FenceRequest& request, int64_t now) {
  const bool holds = operator_.valid(now) && operator_.isHolder(request.by);
  const FenceReceipt receipt = fences_.book().take(request, holds);
  if (receipt == FenceReceipt::kAdded || receipt == FenceReceipt::kRemoved)
    count(std::string("FENCE ") + describe(receipt));
  else if (receipt != FenceReceipt::kKnown)
    count(std::string("FENCE refused: ") + describe(receipt));
}

/// An E-stop outlives the process that engaged it, because the controller holds it.
void Bridge::adoptLatchedStop(int64_t now, const DeviceReport& device) {
  if (controller_met_ || !device.link_fault.empty()) return;
  controller_met_ = true;
  if (!device.stop_latched || requests_.estop()) return;
  requests_.receive(
      {now, true, "motor_bridge", "the controller has held it since before the start"}, now);
}

BridgeOutput Bridge::step(int64_t now, const DeviceReport& device) {
  adoptLatchedStop(now, device);
  const FailsafeInputs in = look(now, device);
  BridgeOutput out;
  out.failsafe = failsafe_.update(in);
  if (in.arm && isArmed(out.failsafe.state)) requests_.consume(since_.request);
  if (out.failsafe.arm_refused) count("ARM refused");
  out.hold_device_stop = requests_.estop();
  out.release_device_stop =
      !requests_.estop() && (since_.estop_cleared || (in.arm && device.stop_latched));
  command(now, out);
  schedule(now, out);
  const Command motion = config_.motion.motion(out.command);
  motion_.command(motion, now);
  fences_.command(motion, now);
  stopping_.command(isZero(out.command), now);
  player_.dropCandidate();
  since_ = Since{};
  last_step_ = now;
  return out;
}

Reason Bridge::stallFault(int64_t now) const {
  if (last_step_ && now < *last_step_) return StopReason::kClockWentBack;
  if (!last_step_ || now - *last_step_ <= config_.max_stall_us) return {};
  return {StopReason::kBridgeHeldUp, "motor_bridge was held up for " +
                                         std::to_string((now - *last_step_) / 1000) +
                                         " ms: too much runs on this computer, or it was halted"};
}

/// Whether the robot may move although its operator has been silent for `silent` [us].
bool Bridge::mayGoOn(int64_t silent) const {
  switch (config_.operators.lost) {
    case OperatorLost::kFinish:
      return player_.playing() && silent < kLongestFinish;
    case OperatorLost::kGoBack:
      return isArmed(failsafe_.state()) && silent < config_.operators.return_us;
    case OperatorLost::kStop:
      break;
  }
  return false;
}

void Bridge::lookForOperator(int64_t now, FailsafeInputs& in) {
  operator_.update(now, isArmed(failsafe_.state()));
  const OperatorLease::State state = operator_.state(now);
  in.leased = state == OperatorLease::State::kValid;
  if (state != OperatorLease::State::kLost) operator_lost_.reset();
  if (in.leased) return;
  const std::string& who = operator_.holder();
  in.unattended = now - std::max(operator_.lastValid(), moved_at_) > config_.operators.wait_us;
  in.unleased = who.empty() ? Reason(StopReason::kNoOperator)
                            : Reason(StopReason::kOperatorLetGo, who + " has let go");
  if (state != OperatorLease::State::kLost) return;
  operator_lost_ = operator_lost_.value_or(now);
  in.unleased = {StopReason::kOperatorLost, "the operator is lost: " + who +
                                                " has not seen the robot for " +
                                                tenths(config_.operators.lease_us)};
  in.leased = mayGoOn(now - *operator_lost_);
  if (!in.leased) in.operator_fault = in.unleased;
}

void Bridge::lookForHand(int64_t now, FailsafeInputs& in) {
  const bool has = failsafe_.state() == BridgeState::kManual;
  manual_.update(now, has, isArmed(failsafe_.state()));
  const bool wants = isArmed(failsafe_.state()) ? manual_.takes() : manual_.ready();
  in.hand = operator_.valid(now) && (has ? !manual_.givenBack() : wants);
  in.hand_words = manual_.words();
  if (!has) in.hand_bar = manual_.bar();
}

Reason Bridge::leaseFault(int64_t now) const {
  if (gate_.leaseValid(now)) return {};
  return gate_.leaseAge(now) ? StopReason::kProgramLate : StopReason::kNoProgram;
}

Reason Bridge::moveSchedule(int64_t now, bool stalled) {
  if (!player_.playing() || stalled) return {};
  const SeriesPlayer::Advance advance = player_.advance(now);
  counters_["commands skipped"] += advance.skipped;
  if (advance.ended) return StopReason::kSeriesEnded;
  if (since_.planner_stop) {
    player_.abort(now, StopReason::kStoppedByPlanner);
    return StopReason::kStoppedByPlanner;
  }
  return {};
}

FailsafeInputs Bridge::look(int64_t now, const DeviceReport& device) {
  FailsafeInputs in;
  in.now = now;
  in.bridge_fault = stallFault(now);
  in.series_end = moveSchedule(now, !in.bridge_fault.empty());
  in.estop = requests_.estop();
  in.estop_reason = requests_.estopReason();
  in.link_fault = Reason::of(device.link_code, device.link_fault);
  in.device_fault = Reason::of(device.fault_code, device.device_fault);
  in.program_fault = since_.program_fault;
  lookForOperator(now, in);
  lookForHand(now, in);
  in.lease_fault = leaseFault(now);
  in.ins_fault = ins_.fault(now);
  in.tilt_fault = tilt_.fault(now);
  if (!isArmed(failsafe_.state())) fences_.restart();
  in.fenced = !fences_.book().fences().empty();
  in.fence_fault = fences_.fault(now);
  in.motion_fault = motion_.fault(now);
  in.playing = player_.playing();
  in.program_bar = tilt_.beyond();
  in.start_wanted = player_.startable();
  in.arm = since_.arm && !since_.disarm;
  in.disarm = since_.disarm;
  in.requested_by = since_.request.by;
  in.disarm_code = since_.request.code;
  in.refusal = since_.refusal;
  return in;
}

void Bridge::command(int64_t now, BridgeOutput& out) {
  if (!out.failsafe.may_drive) {
    player_.abort(now, out.failsafe.cause);
    if (out.failsafe.state != BridgeState::kManual) return;
    out.command = commandOf(manual_.command(now), config_.manual);
    out.kinds = kindsOf(config_.gate.slot.channels);
    return;
  }
  if (!player_.playing()) player_.start(now);
  out.command = player_.give();
  out.kinds = player_.current().kinds;
  out.run_id = player_.runId().value_or(0);
  out.execution_id = player_.current().execution_id;
  out.command_index = player_.index();
}

void Bridge::schedule(int64_t now, BridgeOutput& out) {
  const bool moves = out.failsafe.may_drive || out.failsafe.state == BridgeState::kManual;
  const bool fast = moves || out.failsafe.zero_fast;
  const int64_t interval = fast ? config_.command_interval_us : config_.idle_interval_us;
  out.send = !last_sent_ || out.command != sent_ || now - *last_sent_ >= interval;
  if (!isZero(out.command)) moved_at_ = now;
  if (out.send) {
    last_sent_ = now;
    sent_ = out.command;
  }
}

}  // namespace tread::motor
