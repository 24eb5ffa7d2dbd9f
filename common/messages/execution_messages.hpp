// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <tread/execution_t.hpp>
#include <tread/motor_t.hpp>
#include <tread/program_slot_t.hpp>

#include "common/execution/execution_tracker.hpp"

namespace tread {

BridgeReading readingFrom(const motor_t& message);
std::vector<ExecutionReading> readingsFrom(const execution_t& message);
program_slot_t toMessage(const ProgramSlot& slot);

}  // namespace tread
