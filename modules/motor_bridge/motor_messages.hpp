// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <tread/execution_record_t.hpp>
#include <tread/ins_t.hpp>
#include <tread/motor_t.hpp>
#include <tread/program_t.hpp>

#include "modules/motor_bridge/core/bridge.hpp"

namespace tread::motor {

/// The core's words for a message. Nothing is checked here: that is the gate's work.
Program fromMessage(const program_t& message);
InsNotice fromMessage(const ins_t& message);

/// One record of EXECUTION.
execution_record_t toMessage(const ExecutionRecord& record);
/// MOTOR, without utime and seq.
motor_t toMessage(const BridgeOutput& output, const MotorTelemetry& telemetry);

}  // namespace tread::motor
