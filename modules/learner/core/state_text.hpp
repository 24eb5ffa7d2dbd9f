// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/learner.hpp"

namespace tread::learner {

/// The state as text, a line each; restores bit for bit. Includes the rule's name for human
/// readers.
/** Commands, classes and names are not included: they are those of the shipped set, which is
 * identified by checksum. */
std::string formatState(const LearnerState& state, const PatternSet& shipped,
                        const RuleConfig& config);

/// The state from its text; nullopt and one clear line in `why` if it is damaged or of another
/// shipped set.
std::optional<LearnerState> parseState(const std::string& text, const PatternSet& shipped,
                                       std::string& why);

}  // namespace tread::learner
