// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "modules/simulator/simulator_files.hpp"

namespace tread::testing {

/// The time when the motors went to zero for at least `hold` [us]; nullopt if they have not yet.
std::optional<int64_t> zeroAfter(const std::vector<sim::TruthRow>& rows, int64_t utime,
                                 int64_t hold);

}  // namespace tread::testing
