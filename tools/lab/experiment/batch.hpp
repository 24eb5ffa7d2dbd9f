// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/experiment/tables.hpp"

namespace tread::experiment {

/// Runs everything; throws an exception with one line on failure. progress(done share, 0..1).
Batch runBatch(const Request& request, const std::function<void(double)>& progress);

}  // namespace tread::experiment
