// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/commissioning/core/wiring_faults.hpp"

#include "common/words/words.hpp"

namespace tread::commissioning {
namespace {

const char* sentenceOf(FaultKind kind) {
  switch (kind) {
    case FaultKind::kNoMotion:
      return "nothing moves, or the INS is frozen: release the emergency stop, look at fuses and "
             "the power stage; check that the INS's position changes when you move it";
    case FaultKind::kSwapped:
      return "the sides are swapped: the configured left channel drives the right track; change "
             "left_channel of robot.yaml, or the wires";
    case FaultKind::kReversed:
      return "the {} backwards; change {} of robot.yaml, or the motor's wires";
    case FaultKind::kDead:
      return "the {} track does not move when it is commanded ({} in the configuration): look at "
             "its motor, its fuse and its channel of the controller";
    case FaultKind::kWeak:
      return "the {} track gives {} % of the other one's speed ({} against {} m/s): look for a "
             "dragging brake, a slack chain or a limit of the controller";
    case FaultKind::kInsTurned:
      return "the INS is turned by {} ({} to {}) from its configured mounting; set ins: mounting "
             "of robot.yaml{}";
    case FaultKind::kInsMirrored:
      return "the INS is mirrored{}";
    case FaultKind::kInsElsewhere:
      return "the INS measures {} ahead and {} left of its configured position; set ins: antenna "
             "of robot.yaml";
    case FaultKind::kGauge:
      return "it turns as if it were {} wide ({} to {}), and {} is configured; set gauge of "
             "robot.yaml";
    case FaultKind::kSteeringReversed:
      return "the steering is reversed: left is right; change invert_steering of robot.yaml{}";
    case FaultKind::kSteeringDead:
      return "the steering does nothing: look at the servo, its supply and its output of the "
             "controller";
    case FaultKind::kSteeringAskew:
      return "with no steering its wheels stand {} to the left; move the servo's middle "
             "(servo_left, servo_right), or its lever";
  }
  return "";
}

}  // namespace

WiringFault wiringFault(FaultKind kind, std::optional<Side> side, double amount,
                        const std::vector<std::string>& values) {
  return {kind, side, amount, filledIn(sentenceOf(kind), values)};
}

}  // namespace tread::commissioning
