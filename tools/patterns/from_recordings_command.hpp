// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <CLI/CLI.hpp>

namespace tread::patterns {

/// Adds `from-recordings`: recorded drives become recordings of comparable patterns per surface.
CLI::App* addFromRecordings(CLI::App& app);

}  // namespace tread::patterns
