// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

namespace tread::gap {

/// The track [m] with which an imported recording's commands were made: tread-import notes it in
/// CONFIG. Nothing for other logs.
/** Throws std::runtime_error with one line if the file cannot be read. */
std::optional<double> recordedBaseline(const std::string& log);

}  // namespace tread::gap
