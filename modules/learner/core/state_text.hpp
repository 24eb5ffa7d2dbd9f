// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/execution/execution_tracker.hpp"
#include "modules/learner/core/learner.hpp"
#include "modules/learner/core/rules/surface_bank.hpp"

// The text files of the learner: words and numbers that read back to the bit, and a last line that
// tells a damaged text from a whole one.
namespace tread::learner {

/// Everything that the learner needs to go on after a restart, apart from the shipped set.
struct LearnerState {
  PatternSet set;                     ///< newest version
  ResidualTable residuals;            ///< by pattern id
  std::vector<double> memory;         ///< of the rule, beside the set
  Rule rule = "off";                  ///< whose memory it is
  std::vector<ExecutionKey> handled;  ///< the executions handled last, oldest first
};

/// The state as text, a line each; restores bit for bit. Names the rule for people who read it.
/** Commands, classes and names are not in it: they are those of the shipped set, which it names by
 * checksum. */
std::string formatState(const LearnerState& state, const PatternSet& shipped,
                        const RuleConfig& config);

/// The state from its text; nothing and one clear line in `why` if it is damaged or of another
/// shipped set.
std::optional<LearnerState> parseState(const std::string& text, const PatternSet& shipped,
                                       std::string& why);

/// The remembered surfaces of a shipped set as text that people can read; restores bit for bit.
/** Names the shipped set by its checksum: corrections are relative to its predictions. */
std::string formatBank(const SurfaceBank& bank, const PatternSet& shipped);

/// Puts the surfaces of a text into `bank`; one clear line if the text is damaged or of another
/// set, and then the bank is as before.
std::optional<std::string> parseBank(const std::string& text, const PatternSet& shipped,
                                     SurfaceBank& bank);

}  // namespace tread::learner
