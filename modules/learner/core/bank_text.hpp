// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "modules/learner/core/rules/surface_bank.hpp"

namespace tread::learner {

/// The remembered surfaces of a shipped set as text that people can read; restores bit for bit.
/** Names the shipped set by its checksum: corrections are relative to its predictions. */
std::string formatBank(const SurfaceBank& bank, const PatternSet& shipped);

/// Puts the surfaces of a text into `bank`; one clear line if the text is damaged or of another
/// set, and then the bank is as before.
std::optional<std::string> parseBank(const std::string& text, const PatternSet& shipped,
                                     SurfaceBank& bank);

}  // namespace tread::learner
