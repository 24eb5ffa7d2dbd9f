// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/bridge.hpp"

namespace tread::motor {

Bridge::Bridge(const BridgeConfig& config)
    : config_(config), gate_(config.gate), ins_(config.ins) {}

void Bridge::receive(const Program& program, int64_t now) {
  const ProgramGate::Admission admission = gate_.admit(program, now, !isArmed(failsafe_.state()));
  if (admission.refusal == ProgramRefusal::kBadSlot) {
    since_.program_fault = std::string("PROGRAM with ") + describe(admission.slot_fault);
    count(std::string("PROGRAM refused: ") + describe(admission.slot_fault));
    return;
  }
  if (admission.refusal != ProgramRefusal::kNone) {
    if (admission.refusal == ProgramRefusal::kRunChanged)
      since_.program_fault = describe(admission.refusal);
    count(std::string("PROGRAM refused: ") + describe(admission.refusal));
    return;
  }
  if (admission.new_run) {
    player_.beginRun(program.run_id);
    // Starts the second of good inputs anew: with two planners alive nobody can arm.
    since_.program_fault = "another run of the planner";
    count("planner runs");
  }
  take(program, now);
}

void Bridge::take(const Program& program, int64_t now) {
  const Offer offer = player_.offer(program, now);
  if (!agrees(offer)) {
    count(std::string("PROGRAM refused: ") + describe(offer));
  } else if (offer == Offer::kPlannerAhead || offer == Offer::kPlannerBehind) {
    count(std::string("PROGRAM ") + describe(offer));
  }
  since_.planner_stop = offer == Offer::kStop && player_.playing();
  // Whoever moves must not live on the lease of a planner that believes in another motion.
  if (agrees(offer) || !player_.playing()) gate_.renew(program, now);
}

void Bridge::receive(const ArmRequest& request, int64_t now) {
  switch (requests_.classify(request, now, failsafe_.disarmedAt())) {
    case OperatorRequests::Effect::kArm:
      since_.arm = true;
      since_.request = request;
      break;
    case OperatorRequests::Effect::kDisarm:
      since_.disarm = true;
      since_.request = request;
      break;
    case OperatorRequests::Effect::kIgnored:
      count("ARM ignored: too old, from the future, served or given before the stop");
      break;
  }
}

void Bridge::receive(const EstopRequest& request, int64_t now) {
  const bool taken = requests_.receive(request, now);
  if (taken) {
    since_.estop_cleared = !request.engaged;
  } else {
    count("ESTOP clearing ignored: nothing to clear, or too old");
  }
}

void Bridge::receive(const InsNotice& notice, int64_t now) {
  ins_.receive(notice, now);
}

BridgeOutput Bridge::step(int64_t now, const DeviceReport& device) {
  const FailsafeInputs in = look(now, device);
  BridgeOutput out;
  out.failsafe = failsafe_.update(in);
  if (in.arm && out.failsafe.state == State::kArmed) requests_.consume(since_.request);
  if (out.failsafe.arm_refused) count("ARM refused");
  out.hold_device_stop = requests_.estop();
  out.release_device_stop =
      !requests_.estop() && (since_.estop_cleared || (in.arm && device.stop_latched));
  command(now, out);
  schedule(now, out);
  player_.dropCandidate();
  since_ = Since{};
  last_step_ = now;
  return out;
}

std::string Bridge::stallFault(int64_t now) const {
  if (!last_step_ || (now >= *last_step_ && now - *last_step_ <= config_.max_stall_us)) return "";
  return "motor_bridge was held up for " + std::to_string((now - *last_step_) / 1000) + " ms";
}

std::string Bridge::leaseFault(int64_t now) const {
  if (gate_.leaseValid(now)) return "";
  return gate_.leaseAge(now) ? "no good PROGRAM within its lease" : "no PROGRAM yet";
}

std::string Bridge::moveSchedule(int64_t now, bool stalled) {
  if (!player_.playing() || stalled) return "";
  const SeriesPlayer::Advance advance = player_.advance(now);
  counters_["commands skipped"] += advance.skipped;
  if (advance.ended) return "series ended without a next";
  if (since_.planner_stop) {
    player_.abort(now, "stopped by the planner");
    return "stopped by the planner";
  }
  return "";
}

FailsafeInputs Bridge::look(int64_t now, const DeviceReport& device) {
  FailsafeInputs in;
  in.now = now;
  in.bridge_fault = stallFault(now);
  in.series_end = moveSchedule(now, !in.bridge_fault.empty());
  in.estop = requests_.estop();
  in.estop_reason = requests_.estopReason();
  in.link_fault = device.link_fault;
  in.device_fault = device.device_fault;
  in.program_fault = since_.program_fault;
  in.lease_fault = leaseFault(now);
  in.ins_fault = ins_.fault(now);
  in.playing = player_.playing();
  in.start_wanted = player_.startable();
  in.arm = since_.arm && !since_.disarm;
  in.disarm = since_.disarm;
  in.requested_by = since_.request.by;
  return in;
}

void Bridge::command(int64_t now, BridgeOutput& out) {
  if (!out.failsafe.may_drive) {
    player_.abort(now, out.failsafe.reason);
    return;
  }
  if (!player_.playing()) player_.start(now);
  out.command = player_.give();
  out.kind = player_.current().kind;
  out.run_id = player_.runId().value_or(0);
  out.execution_id = player_.current().execution_id;
  out.command_index = player_.index();
}

void Bridge::schedule(int64_t now, BridgeOutput& out) {
  const bool fast = out.failsafe.may_drive || out.failsafe.zero_fast;
  const int64_t interval = fast ? config_.command_interval_us : config_.idle_interval_us;
  out.send = !last_sent_ || out.command != sent_ || now - *last_sent_ >= interval;
  if (out.send) {
    last_sent_ = now;
    sent_ = out.command;
  }
}

}  // namespace tread::motor
