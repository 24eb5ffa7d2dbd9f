// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/plan/plan_files.hpp"

namespace tread::plan {

/// Reads nav2's lattice primitives (.json), with the same requirements.
PrimitiveFile readLattice(const std::string& path);

}  // namespace tread::plan
