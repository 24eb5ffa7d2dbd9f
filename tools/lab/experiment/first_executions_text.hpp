// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::experiment {

/// By method: shares of ends inside the 90 % regions, errors over all patterns, and the loss on
/// unchanged ground.
std::string textOfFirstExecutions(const Tables& tables, const Setting& setting);

}  // namespace tread::experiment
