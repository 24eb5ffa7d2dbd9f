// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/learner.hpp"

namespace tread::learner {

/// The state as text, a line each; restores bit for bit. Names the rule for people who read it.
/** Commands, classes and names are not in it: they are those of the shipped set, which it names by
 * checksum. */
std::string formatState(const LearnerState& state, const PatternSet& shipped,
                        const RuleConfig& config);

/// The state from its text; nothing and one clear line in `why` if it is damaged or of another
/// shipped set.
std::optional<LearnerState> parseState(const std::string& text, const PatternSet& shipped,
                                       std::string& why);

}  // namespace tread::learner
