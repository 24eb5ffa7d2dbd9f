// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/experiment/tables.hpp"

namespace tread::experiment {

/// Number of surfaces that methods remember after an excitation run; empty if none has a memory.
std::string textOfRemembered(const Batch& batch);

/// Key figures of the variants.
std::string textOfVariants(const Batch& batch);

/// Width of the never executed pattern after 100, 200 and 300 executions on unchanged ground.
std::string textOfDrift(const Batch& batch);

/// Name of the pattern watched for drift; empty if there is none.
std::string watchedPattern(const Batch& batch);

/// Writes all files into a folder, which is created if needed.
void writeBatch(const std::string& folder, const Batch& batch);

}  // namespace tread::experiment
