// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"
#include "modules/simulator/core/instruments.hpp"
#include "tests/study/hide/hidden_drive.hpp"

namespace tread::blind {

/// The log of a drive as recorded by a robot's logger: CONFIG, MARK, MOTOR 20 Hz, INS 50 Hz,
/// EXECUTION 5 Hz and on change, ordered by time. It contains no hint at the hidden effects.
std::vector<LogEvent> makeLog(const HiddenDrive& drive,
                              const std::vector<sim::InsMeasurement>& measured,
                              const std::string& name, uint64_t seed);

/// utime of the beginning of the log of a seed [us]: the robot has been on for some time.
int64_t startUtime(uint64_t seed);

}  // namespace tread::blind
