// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/bus/channels.hpp"
#include "lcmtypes/enums.hpp"

namespace tread {

TEST_CASE("the enumerations of cores have the numbers of the messages' constants") {
  CHECK(static_cast<int16_t>(BridgeState::kDisarmed) == motor_t::STATE_DISARMED);
  CHECK(static_cast<int16_t>(BridgeState::kManual) == motor_t::STATE_MANUAL);
  CHECK(static_cast<int16_t>(PlanStatus::kStopped) == plan_t::PLAN_STOPPED);
  CHECK(static_cast<int16_t>(ExecutionOutcome::kAborted) == execution_record_t::OUTCOME_ABORTED);
  CHECK(static_cast<int16_t>(CommandKind::kSteeringAngle) == program_slot_t::KIND_STEERING_ANGLE);
  CHECK((InsStatus::kFilledIn | InsStatus::kGap) == (ins_t::STATUS_FILLED_IN | ins_t::STATUS_GAP));
}

TEST_CASE("a number without a constant is no enumerator") {
  CHECK(knownBridgeState(motor_t::STATE_ESTOP) == BridgeState::kEstop);
  CHECK_FALSE(knownBridgeState(7).has_value());
  CHECK_FALSE(knownBridgeState(-1).has_value());
  CHECK_FALSE(knownCommandKind(0).has_value());
}

}  // namespace tread
