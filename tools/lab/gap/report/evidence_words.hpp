// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// Sentences on what wheel speeds, motor currents and battery voltage show about an effect, each
/// with a leading space; empty if none decides.
std::string evidenceSentences(const FoundEffect& effect);

}  // namespace tread::gap
